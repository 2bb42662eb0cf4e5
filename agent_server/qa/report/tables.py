"""The tables of a report."""

from collections.abc import Sequence
from html import escape

from agent_server.qa.result import CaseResult, FaultResult
from agent_server.qa.totals import total

NONE = "\u2013"
"""Stands where there is no figure."""
_SIGNS = {
    "passed": ("good", "✓", "passed"),
    "failed": ("bad", "✗", "failed"),
    "error": ("bad", "!", "cannot be replayed"),
    "skipped": ("soft", "\u2013", "nothing is expected"),
}


def sign(status: str) -> str:
    """A verdict as a sign that is read out as a word."""
    style, mark, said = _SIGNS[status]
    return f'<span class="sign {style}" role="img" aria-label="{said}">{mark}</span>'


def summary_table(cases: Sequence[CaseResult]) -> str:
    """One row a recording."""
    rows = []
    for case in cases:
        sums = total([case])
        delay = NONE if sums.delay_p50_ms is None else f"{sums.delay_p50_ms / 1000:.2f} s"
        right = f"{sums.right} of {sums.asked}" if sums.asked else NONE
        false = f'<td class="bad">{sums.false}</td>' if sums.false else "<td>0</td>"
        rows.append(
            f'<tr><th scope="row">{sign(case.status)}<a href="#{escape(case.name)}">'
            f"{escape(case.name)}</a></th><td>{case.duration_ms / 1000:.0f} s</td>"
            f"<td>{sums.met} of {sums.checks}</td>"
            f"<td>{right}</td>{false}"
            f"<td>{delay}</td></tr>"
        )
    headings = ("length", "expectations met", "right reactions", "false", "median delay")
    return table("recording", headings, rows)


def fault_table(faults: Sequence[FaultResult]) -> str:
    """One row a fault; the first is without any."""
    clean = faults[0]
    rows = []
    for row in faults:
        lost = row.right - clean.right
        style = "bad" if lost < 0 else ""
        against = "" if row is clean else "0" if lost == 0 else f"{lost:+d}".replace("-", "\u2212")
        rate = f"{row.false / row.hours:.1f}" if row.hours else NONE
        delay = NONE if row.delay_p50_ms is None else f"{row.delay_p50_ms / 1000:.2f} s"
        rows.append(
            f'<tr><th scope="row">{escape(row.name)}</th><td>{row.right} of {row.asked}</td>'
            f'<td class="{style}">{against}</td><td>{rate}</td><td>{delay}</td>'
            f"<td>{row.refused or ''}</td></tr>"
        )
    headings = (
        "right reactions",
        "against none",
        "false an hour",
        "median delay",
        "refused",
    )
    return table("fault", headings, rows)


def table(corner: str, headings: Sequence[str], rows: Sequence[str]) -> str:
    """A table that scrolls sideways where the window is narrow; rows are HTML."""
    head = "".join(f'<th scope="col">{escape(heading)}</th>' for heading in headings)
    return (
        f'<div class="wide"><table><thead><tr><th scope="col">{escape(corner)}</th>{head}</tr>'
        f"</thead><tbody>{''.join(rows)}</tbody></table></div>"
    )
