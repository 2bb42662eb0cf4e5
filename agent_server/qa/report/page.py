"""The report of a run: one file that asks for nothing outside itself."""

from html import escape
from importlib import resources
from pathlib import Path
from string import Template

from agent_server.errors import InvalidInput
from agent_server.qa.compare import Comparison, compare
from agent_server.qa.report.changes import changes
from agent_server.qa.report.figures import figures
from agent_server.qa.report.strips import strips
from agent_server.qa.report.tables import NONE, fault_table, sign, summary_table
from agent_server.qa.report.timeline import timeline
from agent_server.qa.result import CaseResult, Check, Run
from agent_server.qa.totals import Totals, total

MAX_SHOWN = 40
"""Recordings that are shown one by one; those that failed come first."""
MAX_ROWS = 200


def write_report(run: Run, baseline: Run | None, path: Path) -> None:
    """Write the report.

    Args:
        run: What is reported.
        baseline: What it is compared with, or None.
        path: File to write.

    Raises:
        InvalidInput: If the file cannot be written.
    """
    template = resources.files(__package__).joinpath("page.html").read_text("utf-8")
    sums = total(run.cases)
    comparison = None if baseline is None else compare(baseline, run)
    verdict = ("good", "passed") if run.passed else ("bad", "failed")
    body = [
        _failures(run),
        "" if comparison is None else changes(comparison),
        _section("Recordings", _summary_title(sums), _summary(run)),
        _section("Measurements", "What the labels show", _figures(run, baseline)),
        _faults(run),
        _cases(run),
    ]
    page = Template(template).substitute(
        title=escape(f"{run.suite}: {verdict[1]}"),
        heading=f'{escape(run.suite)}<span class="badge {verdict[0]}">{verdict[1]}</span>',
        lead=_lead(run),
        tiles=_tiles(sums, comparison),
        body="\n".join(body),
    )
    try:
        path.write_text(page, "utf-8")
    except OSError as error:
        raise InvalidInput(f"{path} cannot be written: {error.strerror or error}") from error


def _lead(run: Run) -> str:
    models = ", ".join(f"<code>{escape(n)} {escape(h)}</code>" for n, h in run.models.items())
    minutes = sum(case.duration_ms for case in run.cases) / 60_000
    made = sum(case.origin.startswith("synthetic") for case in run.cases)
    whose = (
        " All of them are synthetic: nobody was recorded."
        if made == len(run.cases)
        else f" {made} of them are synthetic."
        if made
        else ""
    )
    return (
        f"{len(run.cases)} recordings, {minutes:.1f} minutes, replayed by agent-server "
        f"{escape(run.server_version)} with {models} and <code>{escape(run.rules)}</code>.{whose}"
    )


def _tiles(sums: Totals, comparison: Comparison | None) -> str:
    before = None if comparison is None else comparison.before
    after = None if comparison is None else comparison.after
    share = NONE if sums.right_share is None else f"{sums.right_share:.1%}"
    rate = NONE if sums.false_per_hour is None else f"{sums.false_per_hour:.1f}"
    delay = NONE if sums.delay_p50_ms is None else f"{sums.delay_p50_ms / 1000:.2f} s"
    p90 = sums.delay_p90_ms
    most = "" if p90 is None else f", nine in ten within {p90 / 1000:.1f} s"
    rows = (
        ("met", f"{sums.met} of {sums.checks}", "expectations met", 1),
        ("right_share", share, f"right reactions, {sums.right} of {sums.asked}", 100),
        ("false_per_hour", rate,
         f"false reactions an hour, {sums.false} in {60 * sums.hours:.1f} min", -1),
        ("delay_p50_ms", delay, f"median time to react{most}", -0.001),
    )  # fmt: skip
    tiles = []
    for name, value, said, sense in rows:
        delta = ""
        if before is not None and after is not None:
            old, new = getattr(before, name), getattr(after, name)
            delta = "" if old is None or new is None else _delta(new - old, sense)
        tiles.append(f'<div class="tile"><b>{value} {delta}</b><span>{said}</span></div>')
    return "".join(tiles)


def _delta(change: float, sense: float) -> str:
    """A change, in the unit of its tile; ``sense`` is negative where less is better."""
    if abs(change) < 1e-9:
        return '<small class="delta">±0</small>'
    style = "good" if change * sense > 0 else "bad"
    said = f"{change * abs(sense):+.3g}".replace("-", "\u2212")
    return f'<small class="delta {style}">{said}</small>'


def _failures(run: Run) -> str:
    limits = "".join(_check(check) for check in run.limits)
    found = [(case.name, check) for case in run.cases for check in case.checks if not check.passed]
    items = "".join(
        f'<li>{sign("failed")}<a href="#{escape(name)}">{escape(name)}</a>, {escape(check.name)} '
        f"<small>{escape(check.detail)}</small></li>"
        for name, check in found[:MAX_ROWS]
    )
    errors = "".join(
        f"<li>{sign('error')}{escape(case.name)} <small>{escape(case.error)}</small></li>"
        for case in run.cases
        if case.error is not None
    )
    if not (limits or items or errors):
        return ""
    more = f"<li>and {len(found) - MAX_ROWS} more</li>" if len(found) > MAX_ROWS else ""
    missed = len(found) + sum(not check.passed for check in run.limits)
    title = (
        f"{missed} expectation{'s' if missed != 1 else ''} not met"
        if missed
        else "Some recordings cannot be replayed"
        if errors
        else "The suite keeps within its limits"
    )
    content = f'<div class="card"><ul class="list">{limits}{errors}{items}{more}</ul></div>'
    return _section("Verdicts", title, content)


def _check(check: Check) -> str:
    mark = sign("passed" if check.passed else "failed")
    return f"<li>{mark}{escape(check.name)} <small>{escape(check.detail)}</small></li>"


def _summary_title(sums: Totals) -> str:
    if not sums.failed:
        return f"All {sums.recordings} recordings pass"
    return f"{sums.failed} of {sums.recordings} recordings fail"


def _summary(run: Run) -> str:
    order = sorted(run.cases, key=lambda case: (case.status == "passed", case.name))
    table = summary_table(order[:MAX_ROWS])
    if len(order) > MAX_ROWS:
        table += f'<p class="note">and {len(order) - MAX_ROWS} more, all in run.json</p>'
    return table


def _figures(run: Run, baseline: Run | None) -> str:
    cards = "".join(
        f'<div class="card"><p class="kind">{escape(figure.kind)}</p>'
        f"<h3>{escape(figure.finding)}</h3>{figure.svg}"
        f'<p class="note">{escape(figure.note)}</p></div>'
        for figure in figures(run, baseline)
    )
    return f'<div class="grid2">{cards}</div>' if cards else "<p>Nothing is labelled.</p>"


def _faults(run: Run) -> str:
    if not run.faults:
        return ""
    clean = run.faults[0]
    worst = min(run.faults, key=lambda row: row.right)
    title = (
        f"{worst.name} costs most: {clean.right - worst.right} of {clean.right} right reactions"
        if worst.right < clean.right
        else "No fault of the table costs a right reaction"
    )
    return _section("Robustness", title[0].upper() + title[1:], fault_table(run.faults))


def _cases(run: Run) -> str:
    order = sorted(run.cases, key=lambda case: (case.status != "failed", case.name))
    shown = [case for case in order if case.status != "error"][:MAX_SHOWN]
    hidden = len(run.cases) - len(shown)
    note = (
        f'<p class="note">{hidden} more recordings are not shown here; failed ones come first.</p>'
        if hidden
        else ""
    )
    legend = (
        '<p class="note">Triangles are reactions: green came as expected, red did not. Bodies are '
        "drawn from the front: five as they were seen, then the forecast in blue, with "
        "what came as the broad grey body behind it.</p>"
    )
    return _section(
        "One by one",
        "What was labelled, seen and done",
        legend + "".join(_case(case, run.gate.valence) for case in shown) + note,
    )


def _case(case: CaseResult, valence_bound: float) -> str:
    sums = total([case])
    said = f"{case.duration_ms / 1000:.0f} s, {sums.met} of {sums.checks} expectations met"
    failed = "".join(_check(check) for check in case.checks if not check.passed)
    listed = f'<ul class="list">{failed}</ul>' if failed else ""
    is_open = " open" if case.status == "failed" else ""
    return (
        f'<details class="card" id="{escape(case.name)}"{is_open}><summary>{sign(case.status)}'
        f"<b>{escape(case.name)}</b><small>{said}</small></summary><div>{listed}"
        f"{timeline(case, valence_bound)}{strips(case.moments)}</div></details>"
    )


def _section(kind: str, title: str, content: str) -> str:
    return f'<section><p class="kind">{escape(kind)}</p><h2>{escape(title)}</h2>{content}</section>'
