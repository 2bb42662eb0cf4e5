"""The card of a generator of interactions."""

from collections.abc import Mapping
from typing import Any

from models.bigraphdiff.manifest import InteractionManifest
from models.export.card import head, made, percent

ROWS = {
    "real": "the true interactions",
    "interactions": "this model",
    "copied": "a training interaction of the same label, copied",
}
FIGURES = (
    ("frechet_distance", ""),
    ("multimodality_score", " %"),
    ("nearest_training_mm", " mm"),
)


def interactions_card(manifest: InteractionManifest) -> str:
    """Markdown: what the model is, what was measured, how it was made."""
    results = manifest.results
    latency = results["latency"]
    lines = [
        head(manifest, "Makes the motion of two people from a label of what they do."),
        f"`model.onnx` takes the noise away from up to {manifest.frames} frames at "
        f"{manifest.rate_hz} Hz: two people of 15 joints as offsets from their torsos, scaled by "
        "`normaliser.npz`; metres, y up, origin in the middle between both torsos at the first "
        f"frame, x from the first person to the second. A draw takes {manifest.drawn_steps} of "
        f"the {manifest.steps} steps; what is longer is made in pieces.",
        "",
        "A BiGraphDiff (Chopin et al., WACV 2024): a stream a person with efficient attention, "
        "styled by the step of a diffusion, and a bipartite graph with a learned adjacency between "
        "the joints of the two. Labels: " + ", ".join(manifest.labels) + ".",
        "",
        "## Measured",
        f"{results['test_interactions']} test interactions, so that one of them is "
        f"{100 / results['test_interactions']:.1f} points of accuracy; "
        f"{percent(results['most_frequent_label'])} have the most frequent label. Means over "
        f"{results['judges']} recurrent classifiers that see both people and {results['draws']} "
        "draws, each with the labels and lengths of the test interactions.",
        "",
        "| | accuracy | Frechet distance | multimodality off by | nearest training interaction |",
        "|---|---|---|---|---|",
        *(_row(words, results[name]) for name, words in ROWS.items()),
        "",
        "By label: "
        + ", ".join(
            f"{label} {percent(share)}"
            for label, share in results["interactions"]["by_class"].items()
        )
        + ".",
        "",
        f"- an interaction of {latency['frames']} frames on one thread: p50 "
        f"{latency['p50_ms']:.0f} ms, p95 {latency['p95_ms']:.0f} ms",
        f"- torch and ONNX differ by at most {results['onnx_difference']:.1e} in a step, where "
        "joints are of about unit size",
        "",
        *made(
            manifest,
            manifest.training,
            "on the whole training split; nothing was chosen by the test split",
        ),
    ]
    return "\n".join(lines)


def _row(words: str, figures: Mapping[str, Any]) -> str:
    cells = [percent(figures["accuracy"])]
    cells += [f"{figures[name]}{unit}" if name in figures else "-" for name, unit in FIGURES]
    return f"| {words} | " + " | ".join(cells) + " |"
