"""The folder of a training run: log, last checkpoint to resume from, best checkpoint."""

import json
import os
import platform
from dataclasses import asdict
from pathlib import Path
from typing import Any

import torch

from agent_server.errors import ConfigError, InvalidInput

LAST = "last.pt"
BEST = "best.pt"
INFO = "run.json"
LOG = "log.jsonl"


def hardware() -> str:
    """What this machine is, for the card of a model."""
    if torch.cuda.is_available():
        return torch.cuda.get_device_name()
    return f"{platform.machine()} CPU, {torch.get_num_threads()} thread(s)"


class Run:
    """A training run on disk.

    Args:
        folder: Where it lives; made if needed.
        config: The frozen dataclass of the configuration; a resumed run must have the same.
        seed: Of everything random.
        command: What the user typed, for the card.
        resume: Whether to go on from the last checkpoint.

    Raises:
        ConfigError: If the folder holds a run and ``resume`` is off, or holds another one.
    """

    def __init__(self, folder: Path, config: Any, seed: int, command: str, resume: bool) -> None:
        self.folder = folder
        self.info: dict[str, Any] = {
            "config": asdict(config),
            "seed": seed,
            "command": command,
            "hardware": hardware(),
            "wall_s": 0.0,
        }
        if (folder / LAST).exists():
            if not resume:
                raise ConfigError(
                    f"--out {folder} already holds a run: add --resume to go on, or name another"
                )
            before = read_info(folder)
            if before["config"] != self.info["config"] or before["seed"] != seed:
                raise ConfigError(
                    f"--out {folder} holds a run with another configuration or seed: "
                    "resume it as it was started, or name another folder"
                )
            self.info = before
        folder.mkdir(parents=True, exist_ok=True)

    def resume(self) -> dict[str, Any] | None:
        """The last checkpoint, or None at the start."""
        path = self.folder / LAST
        return torch.load(path, weights_only=True) if path.exists() else None

    def save(self, state: dict[str, Any], wall_s: float) -> None:
        """Write the checkpoint to resume from, all or nothing."""
        self.info["wall_s"] = round(wall_s, 1)
        (self.folder / INFO).write_text(json.dumps(self.info, indent=2) + "\n")
        part = self.folder / f"{LAST}.part"
        torch.save(state, part)
        os.replace(part, self.folder / LAST)  # noqa: PTH105 - atomic on every platform

    def save_best(self, state: dict[str, Any]) -> None:
        """Write the checkpoint that validation likes best."""
        torch.save(state, self.folder / BEST)

    def log(self, row: dict[str, float]) -> None:
        """Append one row of measured values."""
        with (self.folder / LOG).open("a") as file:
            file.write(json.dumps(row) + "\n")


def read_info(folder: Path) -> dict[str, Any]:
    """Configuration, seed, command, hardware and time of a run.

    Raises:
        InvalidInput: If the folder holds no run.
    """
    path = folder / INFO
    if not path.exists():
        raise InvalidInput(
            f"{folder} holds no training run: train one with `python -m models train`"
        )
    info: dict[str, Any] = json.loads(path.read_text())
    return info


def read_best(folder: Path) -> dict[str, Any]:
    """The checkpoint that validation liked best.

    Raises:
        InvalidInput: If there is none yet.
    """
    path = folder / BEST
    if not path.exists():
        raise InvalidInput(f"{path} is missing: the run has not reached its first validation")
    state: dict[str, Any] = torch.load(path, weights_only=True)
    return state
