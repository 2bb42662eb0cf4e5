"""The report on affect: one page with all figures."""

from pathlib import Path

from models.affect.config import Source
from models.evaluation.affect import Reading
from models.evaluation.figures.affect import gate_plot, scatter_plot, uncertainty_plot, worst_plot
from models.evaluation.page import plot_section, write_page

_WORDS = {
    "mesh": "the mesh of the face",
    "points68": "68 points of the face",
    "blendshapes": "blendshapes",
}


def write_affect_page(reading: Reading, source: Source, folder: Path) -> Path:
    """Write the page; gives its path."""
    plots = [plot(reading) for plot in (scatter_plot, gate_plot, uncertainty_plot, worst_plot)]
    count, found = len(reading.found), int(reading.found.sum())
    return write_page(
        folder,
        title=f"Affect from {source}",
        kind="Affect",
        heading=f"Valence and arousal from {_WORDS[source]}",
        lead=f"{found} of {count} pictures show a face that was found; the pipeline and the model "
        f"`affect_{source}` are those that ship. {reading.ms_per_frame:g} ms a picture.",
        key="",
        body="".join(plot_section(plot) for plot in plots),
    )
