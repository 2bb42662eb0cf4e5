"""The affect gate: thresholds, hysteresis, stale faces, modes."""

import pytest

from agent_server.config import GateSettings
from agent_server.domain.affect import AffectSample
from agent_server.stages.gate import AffectGate

S = 1_000_000_000


def gate_after(*levels, mode="required", step_ns=100_000_000):
    gate = AffectGate(GateSettings(mode=mode))
    for index, (valence, arousal) in enumerate(levels):
        gate.push(AffectSample(index * step_ns, valence, arousal))
    return gate, (len(levels) - 1) * step_ns


def opens(gate_and_now):
    gate, now = gate_and_now
    return gate.verdict(now).is_open


@pytest.mark.parametrize(
    ("valence", "arousal", "is_open"),
    [
        (-6.0, 5.0, True),
        (-6.0, -5.0, True),
        (-3.0, 5.0, False),  # the threshold itself does not pass
        (-3.1, 3.0, False),
        (-3.1, 3.1, True),
        (-2.5, 9.0, False),
        (4.0, 9.0, False),
    ],
)
def test_thresholds_of_the_thesis(valence, arousal, is_open):
    gate, now = gate_after((valence, arousal))
    verdict = gate.verdict(now)
    assert verdict.is_open is is_open
    assert (verdict.valence, verdict.arousal) == (valence, arousal)


def test_an_open_gate_stays_open_until_the_leaving_thresholds():
    assert opens(gate_after((-6, 5), (-2.5, 2.5)))
    assert not opens(gate_after((-6, 5), (-1.9, 5)))
    assert not opens(gate_after((-6, 5), (-6, 1.9)))


def test_the_thesis_mode_has_no_hysteresis():
    assert not opens(gate_after((-6, 5), (-2.5, 2.5), mode="thesis"))


@pytest.mark.parametrize("mode", ["required", "optional", "thesis"])
def test_a_pleased_face_closes_the_gate_at_once(mode):
    gate, now = gate_after((-6, 5), (0.1, 9), mode=mode)
    verdict = gate.verdict(now)
    assert not verdict.is_open
    assert "pleased" in verdict.reason


def test_no_face_and_a_stale_face_close_a_required_gate():
    gate = AffectGate(GateSettings())
    assert gate.verdict(0).reason == "no face was seen"
    assert not gate.verdict(0).is_open
    gate, now = gate_after((-6, 5))
    assert gate.verdict(now + S).is_open
    stale = gate.verdict(now + S + 1_000_000)
    assert (stale.is_open, stale.reason, stale.valence) == (False, "the face is stale", None)
    assert stale.age_ms == 1001.0


def test_a_face_from_the_future_is_not_used():
    gate = AffectGate(GateSettings())
    gate.push(AffectSample(10 * S, -6.0, 5.0))
    assert gate.verdict(9 * S).is_open
    assert not gate.verdict(8 * S).is_open


def test_an_optional_gate_opens_without_a_face_but_heeds_one():
    gate = AffectGate(GateSettings(mode="optional"))
    assert gate.verdict(0).is_open
    gate.push(AffectSample(0, -1.0, 5.0))
    assert not gate.verdict(0).is_open


def test_a_sensor_without_a_face_switches_the_gate_off_and_back_on():
    gate, now = gate_after((5, 5))
    gate.set_face("none")
    assert (gate.verdict(now).is_open, gate.verdict(now).mode) == (True, "off")
    gate.set_face("expected")
    assert (gate.verdict(now).is_open, gate.verdict(now).mode) == (False, "required")


def test_each_closed_verdict_says_which_threshold_was_missed():
    assert "valence" in gate_after((-1, 9))[0].verdict(0).reason
    assert "arousal" in gate_after((-9, 1))[0].verdict(0).reason
    assert "uncomfortable" in gate_after((-9, 9))[0].verdict(0).reason


def test_a_window_goes_with_the_face_that_was_captured_nearest_to_its_end():
    gate, now = gate_after((-6, 5), (-6, 5), (5, 5), (5, 5))
    # A body that arrives late, against a face that has moved on.
    late = gate.verdict(now - 300_000_000)
    assert (late.is_open, late.valence, late.age_ms) == (True, -6, 0.0)
    assert not gate.verdict(now).is_open


@pytest.mark.parametrize(
    ("off_ms", "face"), [(0, "paired"), (250, "paired"), (251, "skewed"), (1000, "skewed")]
)
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_face_beyond_the_tolerance_is_used_and_the_verdict_says_so(off_ms, sign, face):
    gate = AffectGate(GateSettings())
    gate.push(AffectSample(10 * S, -6.0, 5.0, source="mesh"))
    verdict = gate.verdict(10 * S + sign * off_ms * 1_000_000)
    assert (verdict.face, verdict.is_open, verdict.source) == (face, True, "mesh")
    assert verdict.age_ms == sign * off_ms


def test_missing_and_stale_faces_are_told_apart():
    gate = AffectGate(GateSettings(mode="optional"))
    assert gate.verdict(0).face == "missing"
    gate.push(AffectSample(0, 6.0, 5.0))
    assert (gate.verdict(2 * S).face, gate.verdict(2 * S).is_open) == ("stale", True)
    gate.set_face("none")
    assert gate.verdict(2 * S).face == "not_needed"
