"""Changing the models of a running server, without losing a session.

A bundle is loaded and checked, hashes and golden output, beside the one that runs, and takes its
place between two batches only when all is well. Each session writes down from which window on
the new one has decided.
"""

import asyncio
import logging
from collections.abc import Mapping
from pathlib import Path

from agent_server.errors import BundleError
from agent_server.service.hub import Hub
from agent_server.service.loading import Swappable, exchanged

log = logging.getLogger(__name__)


class Swapper:
    """Takes bundles into use.

    Args:
        hub: The sessions, whose models are changed.
        folders: Where the models in use were read from.
        allowed: Folder within which bundles may be named from outside; None allows nothing.
    """

    def __init__(self, hub: Hub, folders: Mapping[Swappable, Path], allowed: Path | None) -> None:
        self._hub = hub
        self._folders = dict(folders)
        self._allowed = None if allowed is None else allowed.resolve()
        self._turn = asyncio.Lock()

    async def take(self, which: Swappable, path: str) -> dict[str, str]:
        """Take the bundle in a folder, named relative to the allowed one.

        Returns:
            The hashes of all models in use, by name.

        Raises:
            BundleError: If the bundle is not good, or may not be taken from there; all stays as it
                was.
        """
        if self._allowed is None:
            raise BundleError(
                "this server changes no models: name the folder from which it may take them, "
                "folder in [models]"
            )
        try:
            folder = (self._allowed / path).resolve()
        except (OSError, ValueError) as error:
            raise BundleError(f"{path!r} is no folder: {error}") from None
        if not folder.is_relative_to(self._allowed):
            raise BundleError(
                f"{path} lies outside the folder that models may be taken from: name one within it"
            )
        async with self._turn:
            await self._change({which: folder})
        return self._hub.models.hashes

    async def reread(self) -> None:
        """Read all these bundles again from where they are, all or none.

        Raises:
            BundleError: If one is not good; all stays as it was.
        """
        async with self._turn:
            await self._change(self._folders)

    async def _change(self, folders: Mapping[Swappable, Path]) -> None:
        before = self._hub.models
        after = await asyncio.to_thread(exchanged, before, folders)
        labels, others = before.classifier.labels, after.classifier.labels
        if labels != others:
            raise BundleError(
                f"{folders['classifier']} names the gestures {', '.join(others)}, and sessions "
                f"were told {', '.join(labels)}: start the server with it"
            )
        self._folders.update(folders)
        if after.hashes == before.hashes:
            log.info("the models are the same")
            return
        self._hub.use_models(after)
        log.warning("models changed: %s", after.hashes)
