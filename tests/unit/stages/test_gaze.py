"""The gaze gate: a ray that rests on the agent."""

from math import cos, radians, sin

import pytest

from agent_server.config import GateSettings, GazeSettings
from agent_server.domain.decision import FacePairing
from agent_server.domain.face import GazeSample
from agent_server.errors import InvalidInput
from agent_server.stages.gate import AffectGate

MS = 1_000_000
EYES = (0.1, 0.3, 2.0)
AGENT = (0.1, 0.3, 0.0)


def towards(degrees, stamp_ms):
    """A gaze past the agent by an angle."""
    angle = radians(degrees)
    return GazeSample(stamp_ms * MS, EYES, (sin(angle), 0.0, -cos(angle)))


def gate_after(*angles, step_ms=100, **gaze):
    gate = AffectGate(GateSettings(), GazeSettings(agent=AGENT, **gaze))
    gate.set_face("gaze")
    for index, angle in enumerate(angles):
        gate.push_gaze(towards(angle, index * step_ms))
    return gate.verdict((len(angles) - 1) * step_ms * MS)


def test_a_gaze_must_rest_on_the_agent():
    assert not gate_after(3, 3, 3, 3, dwell_ms=400).is_open
    verdict = gate_after(3, 3, 3, 3, 3, dwell_ms=400)
    assert (verdict.is_open, verdict.mode, verdict.gaze_deg) == (True, "gaze", 3.0)
    assert verdict.face is FacePairing.NOT_NEEDED
    assert verdict.reason == "the person looks at the agent"


def test_a_gaze_that_leaves_the_cone_begins_anew():
    assert not gate_after(3, 3, 30, 3, 3, dwell_ms=300).is_open
    assert "elsewhere" in gate_after(40, 40).reason


def test_the_cone_is_wider_for_a_gaze_that_is_within():
    assert gate_after(3, 15, 15, 15, 15, enter_deg=12, leave_deg=18).is_open
    assert not gate_after(15, 15, 15, 15, 15, enter_deg=12, leave_deg=18).is_open


def test_a_pause_of_the_eye_tracker_breaks_the_dwell():
    assert not gate_after(3, 3, step_ms=600, max_age_ms=500).is_open


def test_no_gaze_and_a_stale_gaze_keep_the_gate_closed():
    gate = AffectGate(GateSettings(mode="gaze"), GazeSettings(agent=AGENT, dwell_ms=0))
    assert (gate.verdict(0).is_open, gate.verdict(0).reason) == (False, "no gaze was seen")
    gate.push_gaze(towards(0, 0))
    assert gate.verdict(0).is_open
    stale = gate.verdict(501 * MS)
    assert (stale.is_open, stale.reason, stale.age_ms) == (False, "the gaze is stale", 501.0)


def test_gazes_come_in_the_order_of_capture():
    gate = AffectGate(GateSettings())
    gate.push_gaze(towards(0, 5))
    with pytest.raises(InvalidInput, match="order of capture"):
        gate.push_gaze(towards(0, 5))


def test_someone_who_stands_where_the_agent_is_looks_at_it():
    gate = AffectGate(GateSettings(mode="gaze"), GazeSettings(agent=EYES, dwell_ms=0))
    gate.push_gaze(towards(77, 0))
    assert gate.verdict(0).gaze_deg == 0.0
