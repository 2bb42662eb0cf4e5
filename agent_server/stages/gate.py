"""The affect gate: whether a person looks as if they want something done.

A discomfort gesture passes when valence < -3 and the size of arousal > 3 on [-10, 10]
(Chopin's thesis, chapter 5), with hysteresis, and never when valence > 0.
"""

from agent_server.config import GateSettings
from agent_server.domain.affect import AffectSample
from agent_server.domain.decision import GateVerdict
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import InvalidInput


class AffectGate:
    """Follows the affect of one person.

    Args:
        settings: Thresholds and mode.
    """

    def __init__(self, settings: GateSettings) -> None:
        self._settings = settings
        self._has_face = True
        self._latest: AffectSample | None = None
        self._is_open = False

    def set_face(self, has_face: bool) -> None:
        """Say whether the sensor can see a face at all; a headset cannot."""
        self._has_face = has_face

    @property
    def mode(self) -> str:
        """The mode in force: ``off`` without a face to see."""
        return self._settings.mode if self._has_face else "off"

    def push(self, sample: AffectSample) -> None:
        """Take the next sample.

        Raises:
            InvalidInput: If it is not later than the last one; nothing has changed then.
        """
        latest = self._latest
        if latest is not None and sample.originating_ns <= latest.originating_ns:
            raise InvalidInput(
                f"originating_ns is {sample.originating_ns}, and {latest.originating_ns} has been "
                "seen: send each sample once, in the order of capture",
                field="originating_ns",
                code="out_of_order",
            )
        self._latest = sample
        self._is_open = self._next(sample.valence, abs(sample.arousal))

    def verdict(self, now_ns: int) -> GateVerdict:
        """Say whether a discomfort gesture whose window ends at ``now_ns`` may pass."""
        settings, sample, mode = self._settings, self._latest, self.mode
        age_ms = None if sample is None else (now_ns - sample.originating_ns) / NS_PER_MS
        # A face from the future is as little this moment's as one from the past.
        is_fresh = age_ms is not None and abs(age_ms) <= settings.max_age_ms
        if sample is None or not is_fresh:
            if mode == "off":
                reason, is_open = "the gate is off", True
            else:
                reason = "no face was seen" if sample is None else "the face is stale"
                is_open = mode == "optional"
            return GateVerdict(mode, is_open, reason, None, None, _rounded(age_ms))
        if mode == "off":
            reason, is_open = "the gate is off", True
        else:
            reason, is_open = self._reason(sample), self._is_open
        return GateVerdict(mode, is_open, reason, sample.valence, sample.arousal, _rounded(age_ms))

    def _next(self, valence: float, strength: float) -> bool:
        s = self._settings
        if valence > s.pleasant_valence:
            return False
        if self._is_open and s.mode != "thesis":
            return not (valence > s.leave_valence or strength < s.leave_arousal)
        return valence < s.enter_valence and strength > s.enter_arousal

    def _reason(self, sample: AffectSample) -> str:
        s = self._settings
        if self._is_open:
            return "the face looks uncomfortable"
        if sample.valence > s.pleasant_valence:
            return "the face looks pleased"
        if sample.valence >= s.enter_valence:
            return f"valence is not under {s.enter_valence:g}"
        return f"the size of arousal is not over {s.enter_arousal:g}"


def _rounded(age_ms: float | None) -> float | None:
    return None if age_ms is None else round(age_ms, 1)
