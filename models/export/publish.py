"""The end of every export: a draft that was checked becomes the bundle."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from agent_server.inference.manifest import (
    CARD_FILE,
    DataSource,
    KindOfManifest,
    Training,
    read_manifest,
    write_manifest,
)


def training_of(info: Mapping[str, Any], data: Iterable[DataSource]) -> Training:
    """How a model was made, from what its run has noted."""
    return Training(
        command=info["command"],
        seed=info["seed"],
        data=list(data),
        wall_s=info["wall_s"],
        hardware=info["hardware"],
    )


def publish(draft: Path, folder: Path, manifest: KindOfManifest, card: str) -> KindOfManifest:
    """Write manifest and card beside a draft's files, check them, and copy all to their place.

    Args:
        draft: Folder with the model and its goldens.
        folder: Folder of the bundle; replaced file by file.
        manifest: Without the files' hashes.
        card: Markdown.

    Returns:
        The manifest, with hashes.

    Raises:
        BundleError: If what was written is no bundle.
    """
    (draft / CARD_FILE).write_text(card, "utf-8")
    write_manifest(draft, manifest)
    checked = read_manifest(draft, type(manifest))
    folder.mkdir(parents=True, exist_ok=True)
    for file in draft.iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    return checked
