"""The page that shows how well motion is predicted: figures and tables in one file."""

from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

from models.evaluation.figures.comparison import Comparison
from models.evaluation.figures.curves import coordinate_plot, error_plot, speed_plot
from models.evaluation.figures.embedding import embedding_plot
from models.evaluation.figures.strips import strip_plots
from models.evaluation.figures.style import duration
from models.evaluation.page import cell, entry, plot_section, section, table, write_page
from models.evaluation.prediction import Outcome
from models.evaluation.protocols import Protocol

DATA = {
    "h36m": "Human3.6M, those actions of subject 5 of which both takes are there. "
    "Weights trained on Human3.6M are for research only",
    "cmu": "CMU motion capture, test files, with global motion removed",
    "server": "CMU motion capture, test files, as the nine joints of the server",
    "server-msrc12": "MSRC-12, people before a Kinect, for evaluation only: no weights that ship "
    "have seen it",
    "server-synthetic": "recordings of virtual people whom no training has seen",
}
"""What was measured on, by the name of the protocol or else of its data."""

Row = dict[str, Any]
Column = tuple[str, str, Callable[[Row], float]]
"""Key, heading and the figure of a model's summary."""


def write_report(
    folder: Path,
    protocol: Protocol,
    results: dict[str, dict[str, Outcome]],
    summaries: dict[str, Row],
) -> Path:
    """Write a page that needs nothing but itself.

    Args:
        folder: Where ``index.html`` goes; made where it is missing.
        protocol: How the models were measured.
        results: Model -> action -> outcome, at least one of each. Titles speak of the first model;
            the others are there to compare it with.
        summaries: Model -> what ``prediction.summary`` says of it.

    Returns:
        Path of the page.
    """
    comparison = Comparison(protocol, results, summaries)
    plots = [
        error_plot(comparison),
        speed_plot(comparison),
        coordinate_plot(comparison),
        *strip_plots(comparison),
        embedding_plot(comparison),
    ]
    return write_page(
        folder,
        title=f"Motion prediction, {protocol.name}",
        kind="Motion prediction",
        heading=_heading(comparison),
        lead=_lead(comparison),
        key="".join(f"<li>{_name(comparison, model)}</li>" for model in comparison.models),
        body=_numbers(comparison) + "".join(map(plot_section, plots)),
    )


def _heading(comparison: Comparison) -> str:
    others = [f"`{name}`" for name in comparison.models[1:]]
    if not others:
        return f"`{comparison.subject}` under `{comparison.protocol.name}`"
    listed = f"{', '.join(others[:-1])} and {others[-1]}" if others[1:] else others[0]
    return f"`{comparison.subject}` beside {listed}"


def _lead(comparison: Comparison) -> str:
    protocol = comparison.protocol
    data = DATA.get(protocol.name) or DATA[protocol.data]
    windows = comparison.summaries[comparison.subject]["windows"]
    frame_ms = comparison.future_ms[0]
    return (
        f"Protocol `{protocol.name}`: {windows:,} windows of {len(comparison.actions)} actions; "
        f"{duration(protocol.seen * frame_ms)} are seen and "
        f"{duration(comparison.future_ms[-1])} predicted, {1000 // frame_ms} frames a second, "
        f"{len(protocol.layout.joints)} joints. The error is the {protocol.metric}. Data: {data}."
    )


def _name(comparison: Comparison, model: str) -> str:
    return entry(f"<code>{escape(model)}</code>", comparison.colours[model])


def _numbers(comparison: Comparison) -> str:
    actions = "".join(_action_table(comparison, action) for action in comparison.actions)
    return section(
        "Numbers",
        "Average over the actions",
        _error_table(comparison) + _motion_table(comparison),
        "Bold is best in its column, to the precision shown: the lowest error, or the first step "
        "closest to the truth. Speed off the truth is the mean over time of the difference of "
        "mean speeds (MPJS).",
        f"<details><summary>Each action on its own</summary>{actions}</details>",
    )


def _error_table(comparison: Comparison) -> str:
    rows = {model: comparison.summaries[model]["average"] for model in comparison.models}
    return _table(comparison, _horizon_columns(comparison), rows, "error, mm")


def _action_table(comparison: Comparison, action: str) -> str:
    rows = {model: comparison.summaries[model]["actions"][action] for model in comparison.models}
    errors = _table(comparison, _horizon_columns(comparison), rows, "error, mm")
    return f"<h3>{escape(action)}</h3>{errors}"


def _horizon_columns(comparison: Comparison) -> list[Column]:
    def column(ms: int) -> Column:
        return str(ms), duration(ms), lambda row: float(row["mpjpe"][str(ms)])

    return [column(ms) for ms in comparison.protocol.horizons_ms]


def _motion_table(comparison: Comparison) -> str:
    def judged(row: Row) -> Row:
        average = row["average"]
        off = abs(round(average["jump_mm"], 1) - average["true_jump_mm"])
        return {**row, **average, "jump_off": off}

    rows = {model: judged(comparison.summaries[model]) for model in comparison.models}
    true_jump = comparison.average(comparison.subject, "true_jump_mm")
    columns: list[tuple[str, str, str | None, str]] = [
        ("mpjs_error", "speed off the truth, mm a frame", "mpjs_error", ".2f"),
        ("jump_mm", f"first step, mm (truth {true_jump:.1f})", "jump_off", ".1f"),
        ("bone_error_mm", "bone lengths off, mm", "bone_error_mm", ".2f"),
        ("parameters", "parameters", None, ",d"),
        ("ms_per_window", "ms a window", None, ".2f"),
    ]
    body = ""
    for model, row in rows.items():
        cells = ""
        for key, _, judge, form in columns:
            best = judge is not None and row[judge] == min(other[judge] for other in rows.values())
            cells += cell(key, format(row[key], form), best)
        body += f'<tr data-model="{escape(model)}">{_row_head(comparison, model)}{cells}</tr>'
    return table("", [title for _, title, _, _ in columns], body)


def _table(comparison: Comparison, columns: list[Column], rows: dict[str, Row], corner: str) -> str:
    """A table with a row a model; the lowest figure of a column is bold."""
    lowest = {key: min(round(figure(r), 1) for r in rows.values()) for key, _, figure in columns}
    body = ""
    for model, row in rows.items():
        cells = "".join(
            cell(key, f"{figure(row):.1f}", round(figure(row), 1) == lowest[key])
            for key, _, figure in columns
        )
        body += f'<tr data-model="{escape(model)}">{_row_head(comparison, model)}{cells}</tr>'
    return table(corner, [title for _, title, _ in columns], body)


def _row_head(comparison: Comparison, model: str) -> str:
    return f'<th scope="row">{_name(comparison, model)}</th>'
