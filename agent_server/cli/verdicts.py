"""What a run of a suite came to, in the terminal."""

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from agent_server.qa.compare import Comparison
from agent_server.qa.result import CaseResult, Check, FaultResult, Run
from agent_server.qa.totals import Totals, total

MANY = 30
"""Of more recordings than this, only those that need a look are listed."""
MAX_DIFFERING = 10
_SIGNS = {
    "passed": "[green]✓[/]",
    "failed": "[bold red]✗[/]",
    "skipped": "[dim]\u2013[/]",
    "error": "[bold red]![/]",
}


def show_run(console: Console, run: Run, comparison: Comparison | None) -> None:
    """Print verdicts, the figures, and what changed."""
    shown = run.cases
    if len(shown) > MANY:
        shown = [case for case in shown if case.status != "passed"]
        console.print(f"{len(run.cases) - len(shown)} recordings passed, the others:")
    if shown:
        console.print(_cases(shown))
    for case in shown:
        if case.status in ("failed", "error"):
            console.print(f"\n[bold]{escape(case.name)}[/]")
        if case.error is not None:
            console.print(f"  {_SIGNS['error']} {escape(case.error)}", soft_wrap=True)
        for check in case.checks:
            if not check.passed:
                _check(console, check)
    if run.faults:
        console.print(_faults(run.faults))
    if comparison is not None:
        _changes(console, comparison)
    sums = total(run.cases)
    console.print()
    for check in run.limits:
        _check(console, check)
    colour, word = ("green", "passed") if run.passed else ("red", "failed")
    console.print(f"[bold {colour}]{escape(run.suite)} {word}[/]: {_sentence(sums)}")


def _cases(cases: list[CaseResult]) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("")
    table.add_column("recording", overflow="fold")
    for heading in ("length", "met", "right", "false", "median delay"):
        table.add_column(heading, justify="right")
    for case in cases:
        sums = total([case])
        table.add_row(
            _SIGNS[case.status],
            escape(case.name),
            f"{case.duration_ms / 1000:.0f} s",
            f"{sums.met}/{sums.checks}",
            f"{sums.right}/{sums.asked}" if sums.asked else "",
            str(sums.false) if sums.false else "",
            _ms(sums.delay_p50_ms),
        )
    return table


def _check(console: Console, check: Check) -> None:
    sign = _SIGNS["passed" if check.passed else "failed"]
    console.print(f"  {sign} {escape(check.name)}: {escape(check.detail)}", soft_wrap=True)


def _faults(rows: list[FaultResult]) -> Table:
    table = Table(title="\nUnder faults", title_justify="left", box=None, header_style="dim")
    table.add_column("fault")
    for heading in ("right", "against none", "false an hour", "median delay", "refused"):
        table.add_column(heading, justify="right")
    clean = rows[0]
    for row in rows:
        table.add_row(
            row.name,
            f"{row.right}/{row.asked}",
            "" if row is clean else _lost(row.right - clean.right),
            f"{row.false / row.hours:.1f}" if row.hours else "",
            _ms(row.delay_p50_ms),
            str(row.refused) if row.refused else "",
        )
    return table


def _lost(change: int) -> str:
    said = f"{change:+d}" if change else "0"
    return f"[red]{said}[/]" if change < 0 else said


def _changes(console: Console, comparison: Comparison) -> None:
    console.print(
        f"\n[bold]Against the baseline[/]: {comparison.broken} expectations broken, "
        f"{comparison.mended} mended; {comparison.differing} of {comparison.decisions} decisions "
        "differ"
    )
    for name, cases in (("new", comparison.added), ("gone", comparison.removed)):
        if cases:
            console.print(f"  {name}: {escape(', '.join(cases))}", soft_wrap=True)
    for change in comparison.changes:
        if not change.is_change:
            continue
        note = ", another file of this name" if change.other_file else ""
        unpaired = f", {change.unpaired} windows in only one run" if change.unpaired else ""
        console.print(
            f"  {escape(change.name)}: {len(change.differing)} decisions differ{unpaired}{note}"
        )
        for sign, flips in (("[red]✗[/]", change.broken), ("[green]✓[/]", change.mended)):
            for flip in flips:
                console.print(
                    f"    {sign} {escape(flip.after.name)}: {escape(flip.before.detail)}, now "
                    f"{escape(flip.after.detail)}",
                    soft_wrap=True,
                )
        for before, after in change.differing[:MAX_DIFFERING]:
            console.print(
                f"    [dim]{after.at_ms / 1000:7.2f} s[/]  {before.gesture} "
                f"{before.reaction or before.outcome} [dim]→[/] {after.gesture} "
                f"{after.reaction or after.outcome}"
            )
        if len(change.differing) > MAX_DIFFERING:
            console.print(f"    [dim]and {len(change.differing) - MAX_DIFFERING} more[/]")


def _sentence(sums: Totals) -> str:
    parts = [f"{sums.met} of {sums.checks} expectations met on {sums.recordings} recordings"]
    if sums.asked:
        parts.append(f"{sums.right} of {sums.asked} reactions right")
    if sums.delay_p50_ms is not None:
        parts.append(f"median delay {_ms(sums.delay_p50_ms)}")
    if sums.false_per_hour is not None:
        parts.append(
            f"{sums.false} false reactions in {60 * sums.hours:.1f} min "
            f"({sums.false_per_hour:.1f} an hour)"
        )
    return ", ".join(parts)


def _ms(value: float | None) -> str:
    return "" if value is None else f"{value:.0f} ms"
