"""Human3.6M: the splits, and two protocols that give the literature's baseline figures."""

import os
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import InvalidInput
from models.data.h36m import complete_actions, read_h36m
from models.evaluation.forecasters import Forecaster, zero_velocity
from models.evaluation.prediction import evaluate
from models.evaluation.protocols import protocol_named

DATA = Path(os.environ.get("AGENT_SERVER_DATA", "nowhere"))
needs_data = pytest.mark.skipif(
    not (DATA / "h36m").is_dir(), reason="AGENT_SERVER_DATA has no h36m"
)

PUBLISHED = {
    "h36m-256": [24.3, 45.3, 77.5, 89.7, 108.7, 122.7, 132.5, 137.1],
    "h36m-rms": [20.9, 34.6, 57.5, 66.9, 109.3],
}
"""Repeating the last frame, average of the eleven complete actions of S5, mm."""


def errors_of(model, name, data):
    protocol = protocol_named(name)
    return evaluate(model, protocol, protocol.windows(data, data))


def write(folder, **sequences):
    (folder / "h36m").mkdir()
    np.savez(folder / "h36m" / "h36m_25fps.npz", **sequences)


def moving(frames, step):
    """Every joint moves by ``step`` tenths of a millimetre a frame along x."""
    positions = np.zeros((frames, 32, 3), np.int16)
    positions[:, :, 0] = step * np.arange(frames)[:, None]
    return positions


@needs_data
@pytest.mark.parametrize("protocol", ["h36m-256", "h36m-rms"])
def test_repeating_the_last_frame_gives_the_reference_figures(protocol):
    result = errors_of(zero_velocity(protocol_named(protocol)), protocol, DATA)
    assert len(result["actions"]) == 11
    figures = list(result["average"]["mpjpe"].values())
    np.testing.assert_allclose(figures, PUBLISHED[protocol], atol=0.1)


@needs_data
def test_the_splits_share_nobody_and_hold_every_sequence():
    splits = {name: read_h36m(DATA, name) for name in ("train", "validation", "test")}
    subjects = {name: {key.partition("__")[0] for key in split} for name, split in splits.items()}
    assert subjects["test"] == {"S5"}
    assert subjects["validation"] == {"S11"}
    assert not subjects["train"] & {"S5", "S11"}
    assert sum(map(len, splits.values())) == 189


def test_positions_come_as_millimetres_of_the_split_that_was_asked_for(tmp_path):
    write(tmp_path, S5__walking_1=moving(3, 25), S1__walking_1=moving(4, 1))
    sequences = read_h36m(tmp_path, "test")
    assert list(sequences) == ["S5__walking_1"]
    np.testing.assert_allclose(sequences["S5__walking_1"][:, 0, 0], [0, 2.5, 5.0])


def test_an_action_of_which_a_take_is_missing_is_left_out(tmp_path):
    write(
        tmp_path,
        S5__walking_1=moving(3, 1),
        S5__walking_2=moving(4, 1),
        S5__sitting_down_2=moving(3, 1),
        S5__posing_1=moving(3, 1),
    )
    actions = complete_actions(read_h36m(tmp_path, "test"))
    assert list(actions) == ["walking"]
    assert [len(take) for take in actions["walking"]] == [3, 4]


def test_a_missing_set_and_a_wrong_shape_are_named(tmp_path):
    with pytest.raises(InvalidInput, match="h36m_25fps"):
        read_h36m(tmp_path, "test")
    write(tmp_path, S5__walking_1=np.zeros((3, 17, 3), np.int16))
    with pytest.raises(InvalidInput, match="S5__walking_1"):
        read_h36m(tmp_path, "test")


@pytest.fixture
def constant_speed(tmp_path):
    """Two takes of one action in which every joint moves 1 mm a frame."""
    write(tmp_path, S5__walking_1=moving(400, 10), S5__walking_2=moving(500, 10))
    return tmp_path


def test_the_mean_error_counts_the_joints_that_a_model_answers_for(constant_speed):
    result = errors_of(zero_velocity(protocol_named("h36m-256")), "h36m-256", constant_speed)
    # 22 predicted and 6 copied joints of 32 are off by 1 mm a frame.
    assert result["average"]["mpjpe"]["80"] == pytest.approx(2 * 28 / 32, abs=0.01)
    assert result["average"]["mpjpe"]["1000"] == pytest.approx(25 * 28 / 32, abs=0.01)


def test_the_root_mean_square_runs_over_all_frames_up_to_the_horizon(constant_speed):
    result = errors_of(zero_velocity(protocol_named("h36m-rms")), "h36m-rms", constant_speed)
    # 14 of the 17 joints are predicted; the root and the hips never move.
    expected = np.sqrt(14 / 17 * np.mean(np.arange(1, 26) ** 2))
    assert result["average"]["mpjpe"]["1000"] == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize("protocol", ["h36m-256", "h36m-rms"])
def test_who_knows_the_future_makes_no_error(constant_speed, protocol):
    def knows(seen):
        step = seen[:, -1:] - seen[:, -2:-1]
        return seen[:, -1:] + step * np.arange(1, 26)[None, :, None, None]

    result = errors_of(Forecaster("knows", knows, 50, 22, 0), protocol, constant_speed)
    assert max(result["average"]["mpjpe"].values()) < 0.01
