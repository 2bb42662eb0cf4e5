"""Rows on one budget, and streams against their tags."""

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.config import DecideSettings  # noqa: E402
from agent_server.domain.gesture import GESTURES  # noqa: E402
from models.data.msrc12 import STREAM_CLASSES  # noqa: E402
from models.data.windows import WindowSet  # noqa: E402
from models.evaluation.msrc12_stream import Tally, Watched, settings_grid, tally  # noqa: E402
from models.evaluation.rows import (  # noqa: E402
    Held,
    RowResult,
    Split,
    compared,
    paired_p_value,
    recall_by_class,
    row_configs,
    train_rows,
)
from models.interformer.config import NetworkConfig, TrainConfig  # noqa: E402

SMALL = TrainConfig(
    network=NetworkConfig(layers=1, dropout=0.0), steps=2, batch=8, validate_every=2
)
ONE = DecideSettings(enter=0.5, enter_ungated=0.5, enter_windows=1, leave_windows=1, cooldown_s=0)


def windows() -> WindowSet:
    labels = torch.arange(len(GESTURES)).repeat(2)
    frames = torch.randn(len(labels) * 75, 9, 3, generator=torch.Generator().manual_seed(0))
    starts = torch.arange(len(labels)) * 75
    return WindowSet(frames, frames, starts, labels, labels, GESTURES)


def test_rows_differ_in_what_they_get_and_in_nothing_else() -> None:
    rows = row_configs(SMALL, ("ma_wgan", "simlpe"))
    assert list(rows) == ["3s", "1s", "1s+ma_wgan", "1s+simlpe", "1s+last"]
    assert rows["1s"].network.frames == 25
    assert [row.futures for row in rows.values()] == [
        "true", "held", "predicted", "predicted", "held",
    ]  # fmt: skip
    assert {(row.steps, row.batch, row.network.layers) for row in rows.values()} == {(2, 8, 1)}


def test_each_row_is_trained_once_and_then_only_measured(tmp_path: Path) -> None:
    split = Split(windows(), windows(), windows())
    rows = row_configs(SMALL, ("held",))
    first = train_rows(rows, {"held": Held()}, split, tmp_path, 0)
    stamps = [path.stat().st_mtime_ns for path in sorted(tmp_path.glob("*/best.pt"))]
    second = train_rows(rows, {"held": Held()}, split, tmp_path, 0)
    assert len(stamps) == 4
    assert stamps == [path.stat().st_mtime_ns for path in sorted(tmp_path.glob("*/best.pt"))]
    for name, result in first.items():
        np.testing.assert_array_equal(result.probabilities, second[name].probabilities)


def test_a_paired_test_counts_only_what_differs() -> None:
    both = np.ones(100, np.bool_)
    worse = both.copy()
    assert paired_p_value(both, both) == 1.0
    worse[:1] = False
    assert paired_p_value(both, worse) == 1.0
    worse[:10] = False
    assert paired_p_value(both, worse) == pytest.approx(2 / 2**10)


def test_rows_are_compared_window_by_window() -> None:
    first, second = np.array([True, True, False, True]), np.array([False, True, True, False])
    assert compared(first, second) == {"gained": 2, "lost": 1, "p_value": 1.0}
    sure = RowResult(np.array([[0.5, 0.5], [1.0, 0.0]], np.float32), np.array([0, 0]))
    assert sure.nll == pytest.approx(np.log(2) / 2, abs=1e-6)


def test_recall_is_over_all_rotations() -> None:
    one = RowResult(np.eye(2, dtype=np.float32), np.array([0, 0]))
    two = RowResult(np.eye(2, dtype=np.float32)[:1], np.array([0]))
    assert recall_by_class([one, two], ("a", "b")) == {"a": 0.6667}


def watched(frames: list[int], gesture: str, tag: tuple[int, str]) -> Watched:
    rows = np.zeros((40, len(STREAM_CLASSES)), np.float32)
    rows[:, -1] = 1.0
    last = np.arange(40) * 5 + 24
    for frame in frames:
        rows[(frame - 24) // 5] = np.eye(len(STREAM_CLASSES))[STREAM_CLASSES.index(gesture)]
    return Watched(rows, last, (tag,))


@pytest.mark.parametrize(
    ("decided", "found"),
    [(104, True), (74, True), (109, False), (69, False)],
)
def test_a_decision_answers_a_tag_in_time(decided: int, found: bool) -> None:
    result = tally([watched([decided], "G3", (99, "G3"))], ONE)
    assert (len(result.delays_ms) == 1) is found
    assert result.false == (0 if found else 1)
    assert result.tags == 1


def test_a_second_decision_on_a_tag_and_one_on_another_gesture_are_false() -> None:
    assert tally([watched([89, 99], "G3", (99, "G3"))], ONE).false == 1
    other = tally([watched([99], "G4", (99, "G3"))], ONE)
    assert (other.false, other.delays_ms) == (1, ())


def test_figures_of_a_tally() -> None:
    figures = Tally(4, 1, (-200, 0, 200)).figures()
    assert figures == {"precision": 0.75, "recall": 0.75, "f1": 0.75, "delay_ms_p50": 0}
    assert Tally(4, 0, ()).figures()["delay_ms_p50"] is None


def test_all_settings_of_the_grid_are_allowed_and_differ() -> None:
    grid = list(settings_grid())
    assert len({(each.enter, each.enter_windows) for each in grid}) == len(grid)
