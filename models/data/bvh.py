"""BVH motion files: the hierarchy with its channels, and the frames.

The format: each joint has an OFFSET in its parent's axes and CHANNELS that the rows of the
MOTION part fill in the order of the hierarchy, angles in degrees. A joint's rotation is the
product of its rotation channels from left to right, for column vectors.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np
import torch

from agent_server.domain.arrays import Float64
from agent_server.errors import InvalidInput
from models.data.kinematics import forward_kinematics, rotation_matrices

AXES = "xyz"
CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in AXES)


@dataclass(frozen=True, slots=True)
class Bvh:
    """The content of a file, with J joints (End Sites among them) and C channels.

    Attributes:
        names: Name of each joint; an End Site is called as its parent with ``_end`` behind it.
        parents: Index of each joint's parent, -1 for the root, which comes first.
        offsets: Shape (J, 3), in the file's unit.
        channels: For each joint the names of its channels, in the file's order, in lower case.
        values: Shape (T, C), the rows of the MOTION part.
        rate_hz: Frames a second.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: Float64
    channels: tuple[tuple[str, ...], ...]
    values: Float64
    rate_hz: float

    def positions(self, *, still_root: bool = False) -> Float64:
        """Positions of all joints, shape (T, J, 3), in the file's unit and axes.

        A root's position channels are added to its OFFSET. Those of another joint take the
        OFFSET's place, as the programs that write them mean it.

        Args:
            still_root: Leave out the root's translation and rotation.
        """
        frames, joints = len(self.values), len(self.names)
        offsets = np.tile(self.offsets, (frames, 1, 1))
        rotations = torch.eye(3, dtype=torch.float64).repeat(frames, joints, 1, 1)
        column = 0
        for joint, channels in enumerate(self.channels):
            for channel in channels:
                axis, values = AXES.index(channel[0]), self.values[:, column]
                column += 1
                if joint == 0 and still_root:
                    continue
                if channel.endswith("rotation"):
                    turn = torch.zeros(frames, 3, dtype=torch.float64)
                    turn[:, axis] = torch.from_numpy(np.deg2rad(values))
                    rotations[:, joint] = rotations[:, joint] @ rotation_matrices(turn)
                else:
                    offsets[:, joint, axis] = values + (self.offsets[0, axis] if joint == 0 else 0)
        if still_root:
            offsets[:, 0] = 0.0
        positions: Float64 = forward_kinematics(
            rotations, self.parents, torch.from_numpy(offsets)
        ).numpy()
        return positions


def read_bvh(path: Path) -> tuple[tuple[str, ...], Float64, float]:
    """Joint names, positions and rate of a file.

    Returns:
        The names of the joints with End Sites as ``PARENT_end``; positions, shape (T, J, 3), in
        the file's unit and axes, the root's motion included; frames a second.

    Raises:
        InvalidInput: If the file does not fit the format; names the line.
    """
    bvh = parse_bvh(path)
    return bvh.names, bvh.positions(), bvh.rate_hz


def parse_bvh(path: Path) -> Bvh:
    """Read a file as it is.

    Raises:
        InvalidInput: If it does not fit the format; names the line, what it has, and what to do.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path} cannot be read as text: {error}", code="unreadable") from error
    start = next((at for at, line in enumerate(lines) if line.strip().upper() == "MOTION"), None)
    if start is None:
        raise InvalidInput(f"{path} has no line MOTION: give a whole BVH file", code="malformed")
    tree = _Tree(_Words(path, lines[:start]))
    columns = sum(map(len, tree.channels))
    values, rate_hz = _read_motion(path, lines, start + 1, columns)
    return Bvh(
        tuple(tree.names),
        tuple(tree.parents),
        np.array(tree.offsets),
        tuple(tree.channels),
        values,
        rate_hz,
    )


class _Words:
    """The words of some lines, one after the other, with complaints that name the line."""

    def __init__(self, path: Path, lines: list[str]) -> None:
        self._path = path
        self._line = 0
        self._words = self._split(lines)

    def _split(self, lines: list[str]) -> Iterator[str]:
        for self._line, line in enumerate(lines, start=1):
            yield from line.replace("{", " { ").replace("}", " } ").split()

    def next(self) -> str | None:
        """The next word, or None at the end."""
        return next(self._words, None)

    def expect(self, what: str) -> str:
        """The next word; ``what`` it should be is named if there is none."""
        word = self.next()
        if word is None:
            self.refuse(f"the hierarchy ends where {what} should follow")
        return word

    def number(self) -> float:
        word = self.expect("a number")
        value = _number(word)
        if not math.isfinite(value):
            self.refuse(f"'{word}' is no finite number")
        return value

    def refuse(self, why: str) -> NoReturn:
        raise InvalidInput(
            f"{self._path}, line {self._line}: {why}: export the file again", code="malformed"
        )


class _Tree:
    """The hierarchy, built word by word."""

    def __init__(self, words: _Words) -> None:
        self._words = words
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[list[float]] = []
        self.channels: list[tuple[str, ...]] = []
        if words.expect("HIERARCHY") != "HIERARCHY":
            words.refuse("expected HIERARCHY")
        if words.expect("ROOT") != "ROOT":
            words.refuse("expected ROOT")
        open_joints = [self._add(-1, self._name())]
        while open_joints:
            joint = open_joints[-1]
            word = words.expect("'}'")
            if word == "}":
                if not self.offsets[joint]:
                    words.refuse(f"{self.names[joint]} has no OFFSET")
                open_joints.pop()
            elif word == "OFFSET":
                self.offsets[joint] = [words.number() for _ in range(3)]
            elif word == "CHANNELS":
                self.channels[joint] = self._channels()
            elif word == "JOINT":
                open_joints.append(self._add(joint, self._name()))
            elif word == "End":
                self._name()
                open_joints.append(self._add(joint, f"{self.names[joint]}_end"))
            else:
                words.refuse(f"'{word}' is none of OFFSET, CHANNELS, JOINT, End Site and '}}'")
        extra = words.next()
        if extra is not None:
            words.refuse(f"'{extra}' follows the end of the root, expected one tree and MOTION")

    def _add(self, parent: int, name: str) -> int:
        if name in self.names:
            self._words.refuse(f"a second joint is called '{name}'")
        self.names.append(name)
        self.parents.append(parent)
        self.offsets.append([])
        self.channels.append(())
        return len(self.names) - 1

    def _name(self) -> str:
        """What stands before the brace; names may have spaces."""
        parts = []
        while (word := self._words.expect("'{'")) != "{":
            parts.append(word)
        return " ".join(parts)

    def _channels(self) -> tuple[str, ...]:
        count = self._words.number()
        channels = tuple(self._words.expect("a channel").lower() for _ in range(int(count)))
        for channel in channels:
            if channel not in CHANNELS:
                self._words.refuse(f"'{channel}' is no channel, expected {', '.join(CHANNELS)}")
        return channels


def _read_motion(path: Path, lines: list[str], start: int, columns: int) -> tuple[Float64, float]:
    """The MOTION part from the line behind its name on: rows (T, columns), frames a second."""
    filled = [(at + 1, lines[at]) for at in range(start, len(lines)) if lines[at].strip()]
    if len(filled) < 3:
        raise InvalidInput(
            f"{path}: MOTION has {len(filled)} lines, expected 'Frames:', 'Frame Time:' and at "
            "least one frame",
            code="malformed",
        )
    count = _setting(path, *filled[0], "Frames:")
    step_s = _setting(path, *filled[1], "Frame Time:")
    rows = filled[2:]
    if len(rows) != count:
        raise InvalidInput(
            f"{path}, line {filled[0][0]}: Frames is {count:g}, and {len(rows)} rows follow: "
            "export the file again, or correct the number",
            field="Frames",
            code="truncated",
        )
    values = np.empty((len(rows), columns))
    for row, (number, line) in zip(values, rows, strict=True):
        words = line.split()
        if len(words) != columns:
            raise InvalidInput(
                f"{path}, line {number} has {len(words)} numbers, and the joints have {columns} "
                "channels: export the file again",
                code="malformed",
            )
        row[:] = [_number(word) for word in words]
        if not np.isfinite(row).all():
            raise InvalidInput(
                f"{path}, line {number}: '{words[int(np.isfinite(row).argmin())]}' is no finite "
                "number: export the file again",
                code="not_finite",
            )
    return values, 1.0 / step_s


def _setting(path: Path, number: int, line: str, name: str) -> float:
    """The positive number behind ``name``."""
    *key, value = line.split()
    parsed = _number(value)
    if " ".join(key).casefold() != name.casefold() or not 0 < parsed < math.inf:
        raise InvalidInput(
            f"{path}, line {number} is '{line.strip()}', expected '{name}' and a positive number: "
            "correct it",
            field=name.rstrip(":"),
            code="malformed",
        )
    return parsed


def _number(word: str) -> float:
    """The number that a word means; not a number if it means none."""
    try:
        return float(word)
    except ValueError:
        return math.nan
