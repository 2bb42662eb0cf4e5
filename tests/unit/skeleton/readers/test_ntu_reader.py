from pathlib import Path

import numpy as np
import pytest

from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.ntu import read_ntu
from agent_server.skeleton.readers.source import Mark

NAME = "S001C002P003R001A023.skeleton"
FIRST_ID = 72057594037931101
SECOND_ID = 72057594037931368


def body(identity: int, x: float, states: tuple[int, ...] = (2,) * 25) -> list[str]:
    """The lines of one body, whose joints stand above each other at ``x``."""
    joints = [
        f"{x} {index / 10} 3.25 210.5 190.25 NaN -1.#IND 0.1 0.2 0.3 0.4 {state}"
        for index, state in enumerate(states)
    ]
    return [f"{identity} 0 1 1 1 0 0 0.02 -0.05 2", "25", *joints]


def write(folder: Path, frames: list[list[list[str]]], name: str = NAME) -> Path:
    lines = [str(len(frames))]
    for bodies in frames:
        lines += [str(len(bodies)), *(line for one in bodies for line in one)]
    path = folder / name
    path.write_text("\r\n".join(lines) + "\r\n")
    return path


def test_bodies_keep_their_ids_whatever_their_order(tmp_path: Path) -> None:
    frames = [
        [],
        [body(FIRST_ID, 0.5)],
        [body(SECOND_ID, -0.5), body(FIRST_ID, 0.75)],
        [],
        [body(SECOND_ID, -0.25)],
    ]
    recording = read_ntu(write(tmp_path, frames))
    assert [(f.originating_ns, f.body_id, f.joints[0, 0].item()) for f in recording.frames] == [
        (0, FIRST_ID % 2**53, 0.5),
        (33_333_333, SECOND_ID % 2**53, -0.5),
        (33_333_333, FIRST_ID % 2**53, 0.75),
        (100_000_000, SECOND_ID % 2**53, -0.25),
    ]
    assert recording.dropped == {"empty": 2}
    assert recording.subject == "ntu_p003"
    assert recording.marks == (Mark(0, "A023"),)


def test_joints_and_tracking_states(tmp_path: Path) -> None:
    states = (0, 1, 2) + (2,) * 22
    (frame,) = read_ntu(write(tmp_path, [[body(7, 0.5, states)]])).frames
    assert frame.format == "ntu"
    assert frame.joints[:3, 3].tolist() == [0.0, 0.5, 1.0]
    np.testing.assert_array_equal(frame.joints[4, :3], np.float32([0.5, 0.4, 3.25]))
    assert not frame.joints.flags.writeable


def edited(folder: Path, line: int, text: str) -> Path:
    """A good file in which one line (counted from 1) is another."""
    path = write(folder, [[body(7, 0.5)], [body(7, 0.5)]])
    lines = path.read_text().splitlines()
    lines[line - 1] = text
    path.write_text("\n".join(lines))
    return path


@pytest.mark.parametrize(
    ("line", "text", "what"),
    [
        (1, "many", "line 1, frame count: expected a whole number, got 'many'"),
        (1, "3", "line 57, body count: the file ends here"),
        (2, "-1", "line 2, body count: expected a whole number"),
        (3, "7 0 1", "line 3, body: expected 10 numbers, got 3"),
        (3, "x 0 1 1 1 0 0 0.02 -0.05 2", "line 3, body id: expected a whole number, got 'x'"),
        (4, "20", "line 4, joint count: expected 25, got 20"),
        (5, "1 2 3", r"line 5, joints\[0\]: expected 12 numbers, got 3"),
        (6, "1 y 3 0 0 0 0 0 0 0 0 2", r"line 6, joints\[1\]: x, y, z are"),
        (7, "1 nan 3 0 0 0 0 0 0 0 0 2", r"line 7, joints\[2\]: .*not finite"),
        (7, "1 1e39 3 0 0 0 0 0 0 0 0 2", r"line 7, joints\[2\]: .*far too large"),
        (8, "1 2 3 0 0 0 0 0 0 0 0 5", r"line 8, joints\[3\]: tracking state '5'"),
    ],
)
def test_wrong_content_is_named(tmp_path: Path, line: int, text: str, what: str) -> None:
    with pytest.raises(InvalidInput, match=what) as caught:
        read_ntu(edited(tmp_path, line, text))
    assert NAME in str(caught.value)


def test_one_body_twice_in_a_frame_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="72057594037931101 comes twice in one frame"):
        read_ntu(write(tmp_path, [[body(FIRST_ID, 0.5), body(FIRST_ID, 0.6)]]))


def test_another_name_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="not named SsssCcccPpppRrrrAaaa"):
        read_ntu(write(tmp_path, [], "walk.skeleton"))
