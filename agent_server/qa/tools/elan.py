"""Labels from ELAN, the annotation tool of the Max Planck Institute for Psycholinguistics.

An ``.eaf`` file holds tiers of annotations over a video. Three names of tiers are read here,
with or without ``@`` and a subject behind them: ``gesture`` (its values are gestures),
``expected`` (the reaction to the gesture that it overlaps most, or is the child of) and
``quiet`` (whatever its value: the agent must stay quiet). Format: EAF 2.x and 3.0 schemas,
https://www.mpi.nl/tools/elan/EAFv3.0.xsd.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ParseError

from defusedxml import DefusedXmlException
from defusedxml.ElementTree import parse

from agent_server.domain.gesture import IDLE
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import InvalidInput
from agent_server.recording.label_table import made_label

TIERS = ("gesture", "expected", "quiet")


@dataclass(frozen=True, slots=True)
class _Annotation:
    id: str
    tier: str
    subject: str
    onset_ms: int
    offset_ms: int
    value: str

    def overlap_ms(self, other: "_Annotation") -> int:
        return min(self.offset_ms, other.offset_ms) - max(self.onset_ms, other.onset_ms)


def read_elan(path: Path) -> list[Label]:
    """The labels of an ELAN file, in milliseconds from the start of its video.

    Raises:
        InvalidInput: If it is no ELAN file, has none of the tiers, or an annotation is wrong.
    """
    try:
        root = parse(path, forbid_dtd=True).getroot()
    except (OSError, ParseError, DefusedXmlException) as error:
        raise InvalidInput(f"{path} cannot be read as an ELAN file: {error}") from error
    if root is None or root.tag != "ANNOTATION_DOCUMENT":
        raise InvalidInput(f"{path} is no ELAN file: it begins with another element")
    annotations = list(_annotations(root, path))
    if not annotations:
        tiers = ", ".join(tier.get("TIER_ID", "") for tier in root.iter("TIER")) or "none"
        raise InvalidInput(
            f"{path} has no annotation on a tier {', '.join(TIERS)} (its tiers: {tiers}): rename "
            "the tiers, a subject may follow after '@'",
            field="labels",
        )
    gestures = [one for one in annotations if one.tier == "gesture"]
    expected: dict[str, str] = {}
    for one in annotations:
        if one.tier == "expected":
            expected[_answered(one, gestures, path).id] = one.value
    quiet = [one for one in annotations if one.tier == "quiet"]
    hushed = {q.id: [g for g in gestures if g.overlap_ms(q) > 0] for q in quiet}
    silent = {g.id for found in hushed.values() for g in found}
    labels = [
        _label(one, one.value, expected.get(one.id), one.id in silent, path) for one in gestures
    ]
    # Quiet that goes with no gesture is a label of its own.
    labels += [_label(one, IDLE, None, True, path) for one in quiet if not hushed[one.id]]
    return sorted(labels, key=lambda label: label.onset_ns)


def _label(one: _Annotation, gesture: str, expected: str | None, quiet: bool, path: Path) -> Label:
    return made_label(
        gesture,
        one.onset_ms * NS_PER_MS,
        one.offset_ms * NS_PER_MS,
        one.subject,
        expected,
        quiet=quiet,
        where=f"{path}, annotation {one.id}",
    )


def _annotations(root: Element, path: Path) -> Iterator[_Annotation]:
    """Annotations of the tiers that are read; a child has the time of its parent."""
    times = {
        slot.get("TIME_SLOT_ID", ""): int(slot.get("TIME_VALUE", "-1"))
        for slot in root.iter("TIME_SLOT")
    }
    spans: dict[str, tuple[int, int]] = {}
    parents: dict[str, str] = {}
    for aligned in root.iter("ALIGNABLE_ANNOTATION"):
        ends = (aligned.get("TIME_SLOT_REF1", ""), aligned.get("TIME_SLOT_REF2", ""))
        spans[aligned.get("ANNOTATION_ID", "")] = (times.get(ends[0], -1), times.get(ends[1], -1))
    for child in root.iter("REF_ANNOTATION"):
        parents[child.get("ANNOTATION_ID", "")] = child.get("ANNOTATION_REF", "")
    for tier in root.iter("TIER"):
        name, _, subject = tier.get("TIER_ID", "").partition("@")
        if name.lower() not in TIERS:
            continue
        for found in (*tier.iter("ALIGNABLE_ANNOTATION"), *tier.iter("REF_ANNOTATION")):
            own = found.get("ANNOTATION_ID", "")
            at = own
            for _ in range(len(parents)):  # a chain of children, which must end
                at = parents.get(at, at)
            onset, offset = spans.get(at, (-1, -1))
            if not 0 <= onset < offset:
                raise InvalidInput(
                    f"{path}, annotation {own}: it has no time: align it in ELAN, and save again",
                    field="labels",
                )
            value = (found.findtext("ANNOTATION_VALUE") or "").strip()
            who = subject or tier.get("PARTICIPANT", "")
            yield _Annotation(own, name.lower(), who, onset, offset, value)


def _answered(one: _Annotation, gestures: list[_Annotation], path: Path) -> _Annotation:
    """The gesture that an expected reaction goes with."""
    best = max(gestures, key=one.overlap_ms, default=None)
    if best is None or one.overlap_ms(best) <= 0:
        raise InvalidInput(
            f"{path}, annotation {one.id}: {one.value!r} is expected where no gesture is: draw it "
            "over the gesture that asks for it",
            field="expected",
        )
    return best
