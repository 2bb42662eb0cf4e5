"""What every report has in common: one file that needs nothing but itself."""

import base64
import re
from html import escape
from pathlib import Path
from string import Template

from models.evaluation.figures.style import Plot

PAGE = "index.html"
TEMPLATE = Path(__file__).with_name("page.html")


def write_page(
    folder: Path, *, title: str, kind: str, heading: str, lead: str, key: str, body: str
) -> Path:
    """Write a page that asks for nothing outside itself.

    Args:
        folder: Where ``index.html`` goes; made where it is missing.
        title: Of the browser's tab, plain text.
        kind: What sort of report it is, plain text.
        heading: Text with names in backticks.
        lead: What was measured on; text with names in backticks.
        key: HTML of the entries of the legend.
        body: HTML of all sections.

    Returns:
        Path of the page.
    """
    page = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(title),
        kind=escape(kind),
        heading=marked(heading),
        lead=marked(lead),
        key=key,
        body=body,
    )
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / PAGE
    path.write_text(page, encoding="utf-8")
    return path


def plot_section(plot: Plot) -> str:
    """A figure under its finding, with how to read it."""
    picture = base64.b64encode(plot.png).decode("ascii")
    said = escape(plot.title.replace("`", ""))
    figure = f'<figure><img alt="{said}" src="data:image/png;base64,{picture}"></figure>'
    return section(plot.kind, plot.title, figure, plot.note)


def section(kind: str, title: str, content: str, note: str, more: str = "") -> str:
    """A part of a page.

    Args:
        kind: What sort of content it is, plain text.
        title: The finding; text with names in backticks.
        content: HTML.
        note: How to read it; text with names in backticks, empty for none.
        more: HTML below the note.
    """
    below = f'<p class="note">{marked(note)}</p>' if note else ""
    return (
        f'<section><p class="kind">{escape(kind)}</p><h2>{marked(title)}</h2>'
        f"{content}{below}{more}</section>"
    )


def entry(name: str, colour: str) -> str:
    """A name in HTML, beside a dot of its colour."""
    return f'<i class="dot" style="background:{colour}"></i>{name}'


def cell(key: str, text: str, best: bool) -> str:
    """A figure of a table; the best of its column is bold."""
    said = escape(text)
    return f'<td data-key="{escape(key)}">{f"<b>{said}</b>" if best else said}</td>'


def table(corner: str, headings: list[str], body: str) -> str:
    """A table that scrolls sideways where the window is narrow.

    Args:
        corner: Plain text above the names of the rows.
        headings: Of the columns, plain text.
        body: HTML of the rows.
    """
    head = "".join(f'<th scope="col">{escape(heading)}</th>' for heading in headings)
    return (
        f'<div class="wide"><table><thead><tr><th scope="col">{escape(corner)}</th>{head}</tr>'
        f"</thead><tbody>{body}</tbody></table></div>"
    )


def marked(text: str) -> str:
    """Escaped text: what stands in backticks is code, and a number keeps its unit beside it."""
    whole = re.sub(r"(?<=\d) (?=(?:s|ms|mm|%)(?!\w))", "\u00a0", escape(text))
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", whole)
