"""Recordings through the live stages: hits near a tag, and reactions where there is none."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.skeleton import CORE_JOINT_NAMES
from agent_server.errors import InvalidInput
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.skeleton.formats import get_format
from agent_server.skeleton.readers.msrc12 import read_msrc12
from models.evaluation.real_streams import shipped_report
from tests.support.bodies import core_joints
from tests.support.models import covers_ears

TICK_US = 33_333
NAVEL = CORE_JOINT_NAMES.index("navel")


def write(folder, name, tag, tag_s, hands_up, seconds=8):
    """A recording in the set's layout: all joints at the nearest core joint."""
    table = get_format("kinect_v1")
    sources = {shares[0][0]: index for index, shares in enumerate(table.core)}
    rows = []
    for index in range(seconds * 30):
        core = core_joints(hands_up=hands_up(index / 30))
        joints = [
            core[sources.get(joint, CORE_JOINT_NAMES.index("navel"))] for joint in table.names
        ]
        values = [f"{value:.4f}" for joint in joints for value in (*joint[:3], 1)]
        rows.append(" ".join([str(1_000_000 + index * TICK_US), *values]))
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.csv").write_text("\n".join(rows) + "\n")
    ticks = (((1_000_000 + tag_s * 1e6) * 49875) - 24937.5) / 1000
    (folder / f"{name}.tagstream").write_text(f"XQPCTick;Tag\n{round(ticks)};{tag}\n")


def test_a_gesture_near_its_tag_counts_and_others_are_false(tmp_path):
    data = tmp_path / "msrc12"
    write(data, "P1_1_9_p01", "G9", 4.0, lambda t: 3 <= t < 5)
    write(data, "P1_1_9_p02", "G9", 7.5, lambda t: 2 <= t < 4)
    write(data, "P1_1_7_p01", "G7", 4.0, lambda t: False)
    write(data, "P1_1_2_p01", "G2", 4.0, lambda t: 2 <= t < 4)
    write(data, "P1_1_1_p01", "G1", 4.0, lambda t: 2 <= t < 4)  # resembles a gesture: left out
    report = shipped_report(
        RuleClassifier(covers_ears).classify, LastFramePredictor().predict, tmp_path
    )
    assert list(report["rows"]) == ["loud"]
    row = report["rows"]["loud"]
    assert (row["marks"], row["recall"]) == (2, 0.5)
    # Hands at 3 s, seen at once, three windows in a row: decided before the tag at 4 s.
    assert -1.0 < row["delay_s_p50"] < 0.0
    assert report["idle"]["false_reactions"] == 1
    assert report["idle"]["gestures"] == {"loud": 1}
    assert report["idle"]["minutes"] == pytest.approx(2 * 8 / 60, abs=0.05)


def test_a_folder_without_the_set_is_named(tmp_path):
    with pytest.raises(InvalidInput, match="msrc12"):
        shipped_report(RuleClassifier(covers_ears).classify, LastFramePredictor().predict, tmp_path)


def test_the_layout_is_the_readers(tmp_path):
    write(tmp_path / "msrc12", "P1_1_9_p01", "G9", 4.0, lambda t: False)
    recording = read_msrc12(tmp_path / "msrc12" / "P1_1_9_p01.csv")
    assert recording.marks[0].stamp_ns == pytest.approx(4e9, abs=5e7)
    assert np.isclose(recording.frames[0].joints[3, 1], 0.6)
