"""The gate: whether a person looks as if they want something done.

A discomfort gesture passes when valence < -3 and the size of arousal > 3 on [-10, 10]
(Chopin's thesis, chapter 5), with hysteresis, and never when valence > 0.

Body and face are paired by the time of their capture: a window goes with the face that was
captured nearest to its end. Where that is farther off than the tolerance, they are skewed: the
face is used, and the verdict says so. A stale face is not used, and a mode says what then.
"""

from collections import deque

from agent_server.config import GateSettings, GazeSettings
from agent_server.domain.affect import AffectSample
from agent_server.domain.decision import FacePairing, GateVerdict
from agent_server.domain.face import GazeSample
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import InvalidInput
from agent_server.stages.gaze import GazeCone

_REMEMBERED = 64
"""Faces that a late window may go with: two seconds at 30 Hz."""


def require_later(stamp_ns: int, latest_ns: int) -> None:
    """Refuse a face that is not later than the latest.

    Raises:
        InvalidInput: If it is not.
    """
    if stamp_ns <= latest_ns:
        raise InvalidInput(
            f"originating_ns is {stamp_ns}, and {latest_ns} has been seen: send each face "
            "once, in the order of capture",
            field="originating_ns",
            code="out_of_order",
        )


class AffectGate:
    """Follows the affect, or the gaze, of one person.

    Args:
        settings: Thresholds and mode.
        gaze: When a person counts as looking at the agent.
    """

    def __init__(self, settings: GateSettings, gaze: GazeSettings | None = None) -> None:
        self._settings = settings
        self._gaze = GazeCone(gaze or GazeSettings())
        self._face = "expected"
        self._faces: deque[tuple[AffectSample, bool]] = deque(maxlen=_REMEMBERED)

    def set_face(self, face: str) -> None:
        """Say what the sensors see of the face: ``expected``, ``none`` or ``gaze``."""
        self._face = face

    @property
    def mode(self) -> str:
        """The mode in force: ``off`` without a face to see, ``gaze`` where the eyes stand in."""
        if self._settings.mode == "off" or self._face == "none":
            return "off"
        return "gaze" if self._face == "gaze" else self._settings.mode

    def push(self, sample: AffectSample) -> None:
        """Take the next sample.

        Raises:
            InvalidInput: If it is not later than the last one; nothing has changed then.
        """
        self.require_later(sample.originating_ns)
        was_open = bool(self._faces) and self._faces[-1][1]
        is_open = self._next(was_open, sample.valence, abs(sample.arousal))
        self._faces.append((sample, is_open))

    def require_later(self, stamp_ns: int) -> None:
        """Refuse a face that is not later than the last one.

        Raises:
            InvalidInput: If it is not.
        """
        if self._faces:
            require_later(stamp_ns, self._faces[-1][0].originating_ns)

    def push_gaze(self, sample: GazeSample) -> None:
        """Take the next gaze.

        Raises:
            InvalidInput: If it is not later than the last one; nothing has changed then.
        """
        self._gaze.push(sample)

    def verdict(self, now_ns: int) -> GateVerdict:
        """Say whether a discomfort gesture whose window ends at ``now_ns`` may pass."""
        mode = self.mode
        if mode == "gaze":
            return self._gaze_verdict(now_ns)
        if not self._faces:
            return self._without_face(mode, FacePairing.MISSING, None)
        sample, is_open = self._nearest(now_ns)
        age_ms = (now_ns - sample.originating_ns) / NS_PER_MS
        # A face from the future is as little this moment's as one from the past.
        if abs(age_ms) > self._settings.max_age_ms:
            return self._without_face(mode, FacePairing.STALE, age_ms)
        if mode == "off":
            pairing, is_open, reason = FacePairing.NOT_NEEDED, True, "the gate is off"
        else:
            is_paired = abs(age_ms) <= self._settings.pair_tolerance_ms
            pairing = FacePairing.PAIRED if is_paired else FacePairing.SKEWED
            reason = self._reason(sample, is_open)
        return GateVerdict(
            mode,
            is_open,
            reason,
            pairing,
            sample.valence,
            sample.arousal,
            round(age_ms, 1),
            sample.source,
        )

    def _nearest(self, now_ns: int) -> tuple[AffectSample, bool]:
        """The face that was captured nearest to ``now_ns``; they are in order of capture."""
        nearest = self._faces[-1]
        least_ns = abs(now_ns - nearest[0].originating_ns)
        for face in reversed(self._faces):
            away_ns = abs(now_ns - face[0].originating_ns)
            if away_ns > least_ns:
                break
            nearest, least_ns = face, away_ns
        return nearest

    def _without_face(self, mode: str, pairing: FacePairing, age_ms: float | None) -> GateVerdict:
        if mode == "off":
            is_open, reason, pairing = True, "the gate is off", FacePairing.NOT_NEEDED
        else:
            is_open = mode == "optional"
            is_missing = pairing is FacePairing.MISSING
            reason = "no face was seen" if is_missing else "the face is stale"
        return GateVerdict(mode, is_open, reason, pairing, age_ms=_rounded(age_ms))

    def _gaze_verdict(self, now_ns: int) -> GateVerdict:
        angle = self._gaze.angle_deg(now_ns)
        is_open = angle is not None and self._gaze.dwells()
        if angle is not None:
            reason = "the person looks at the agent" if is_open else "the person looks elsewhere"
        elif self._gaze.age_ms(now_ns) is None:
            reason = "no gaze was seen"
        else:
            reason = "the gaze is stale"
        return GateVerdict(
            "gaze",
            is_open,
            reason,
            FacePairing.NOT_NEEDED,
            age_ms=_rounded(self._gaze.age_ms(now_ns)),
            gaze_deg=_rounded(angle),
        )

    def _next(self, was_open: bool, valence: float, strength: float) -> bool:
        s = self._settings
        if valence > s.pleasant_valence:
            return False
        if was_open and s.mode != "thesis":
            return not (valence > s.leave_valence or strength < s.leave_arousal)
        return valence < s.enter_valence and strength > s.enter_arousal

    def _reason(self, sample: AffectSample, is_open: bool) -> str:
        s = self._settings
        if is_open:
            return "the face looks uncomfortable"
        if sample.valence > s.pleasant_valence:
            return "the face looks pleased"
        if sample.valence >= s.enter_valence:
            return f"valence is not under {s.enter_valence:g}"
        return f"the size of arousal is not over {s.enter_arousal:g}"


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 1)
