"""What changed against the baseline, as a part of the page."""

from html import escape

from agent_server.qa.compare import CaseChange, Comparison, Flip
from agent_server.qa.report.tables import NONE, sign, table
from agent_server.qa.result import Step

MAX_DIFFERING = 12
MAX_CASES = 60


def changes(comparison: Comparison) -> str:
    """The section, in which what broke comes first."""
    changed = [change for change in comparison.changes if change.is_change]
    changed.sort(key=lambda change: (-len(change.broken), -len(change.differing), change.name))
    cards = "".join(_case(change) for change in changed[:MAX_CASES])
    if len(changed) > MAX_CASES:
        cards += f'<p class="note">and {len(changed) - MAX_CASES} more recordings changed</p>'
    notes = "".join(
        f'<p class="note">{word}: {escape(", ".join(names))}</p>'
        for word, names in (("New", comparison.added), ("Gone", comparison.removed))
        if names
    )
    return (
        f'<section><p class="kind">Against the baseline</p><h2>{_title(comparison)}</h2>'
        f"{notes}{cards}</section>"
    )


def _title(comparison: Comparison) -> str:
    if not comparison.differing and not comparison.broken and not comparison.mended:
        return f"All {comparison.decisions} decisions are as before"
    return (
        f"{comparison.broken} expectations broke and {comparison.mended} were mended; "
        f"{comparison.differing} of {comparison.decisions} decisions differ"
    )


def _case(change: CaseChange) -> str:
    flips = "".join(_flip("failed", flip) for flip in change.broken)
    flips += "".join(_flip("passed", flip) for flip in change.mended)
    listed = f'<ul class="list">{flips}</ul>' if flips else ""
    notes = [f"{len(change.differing)} of {change.decisions} decisions differ"]
    if change.unpaired:
        notes.append(f"{change.unpaired} windows in only one of the runs")
    if change.other_file:
        notes.append("the file is another one")
    rows = [_row(before, after) for before, after in change.differing[:MAX_DIFFERING]]
    shown = table("window's end", ("before", "now", "why, now"), rows) if rows else ""
    more = len(change.differing) - MAX_DIFFERING
    if more > 0:
        shown += f'<p class="note">and {more} more</p>'
    is_open = " open" if change.broken else ""
    status = "failed" if change.broken else "passed" if change.mended else "skipped"
    return (
        f'<details class="card"{is_open}><summary>{sign(status)}<b>{escape(change.name)}</b>'
        f"<small>{', '.join(notes)}</small></summary><div>{listed}{shown}</div></details>"
    )


def _flip(status: str, flip: Flip) -> str:
    return (
        f"<li>{sign(status)}{escape(flip.after.name)} <small>{escape(flip.before.detail)}, now "
        f"{escape(flip.after.detail)}</small></li>"
    )


def _row(before: Step, after: Step) -> str:
    return (
        f'<tr><th scope="row">{after.at_ms / 1000:.2f} s</th><td>{_said(before)}</td>'
        f'<td>{_said(after)}</td><td class="text">{escape(after.reason) or NONE}</td></tr>'
    )


def _said(step: Step) -> str:
    came = step.reaction or step.outcome
    return (
        f"{escape(step.gesture)}: {escape(came.replace('_', ' '))} "
        f"<small>({escape(step.best)} {step.probability:.2f})</small>"
    )
