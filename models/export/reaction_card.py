"""The card of a generator of reactions."""

from collections.abc import Mapping
from typing import Any

from agent_server.inference.manifest import ReactionManifest
from models.export.card import head, made, percent

ROWS = {
    "real": "the true reactions",
    "reactions": "this model",
    "zero_velocity": "the first pose, held",
}


PASSES = {
    "recorded": "of the recorded reactions",
    "generated": "of those this model makes",
    "zero_velocity": "of first poses that are held",
}


def reaction_card(manifest: ReactionManifest) -> str:
    """Markdown: what the model is, what was measured, how it was made."""
    results = manifest.results
    latency, quality = results["latency"], results["quality"]
    lines = [
        head(manifest, "Makes the reaction of a person to the action of another one."),
        f"`encoder.onnx` reads an action of up to {manifest.frames} frames at "
        f"{manifest.rate_hz} Hz: 15 joints, metres, y up, origin in the middle between both "
        "torsos at the first frame, x from the first person to the second. `model.onnx` writes "
        "one frame of the reaction and keeps keys and values of those before; "
        f"{manifest.latent} numbers of noise make it one of several reactions.",
        "",
        "An InterFormer (Chopin et al., IEEE TMM 2023): attention between joints beside attention "
        "between moments, masked by the skeleton and raised by the joints' nearness.",
        "",
        "## Measured",
        f"{results['test_interactions']} test interactions, so that one of them is "
        f"{100 / results['test_interactions']:.1f} points of accuracy; means over "
        f"{results['judges']} recurrent classifiers of real reactions and {results['draws']} "
        "draws of noise.",
        "",
        "| | accuracy | diversity score | Frechet distance | joint distance |",
        "|---|---|---|---|---|",
        *(_row(words, results[name]) for name, words in ROWS.items()),
        "",
        "By class: "
        + ", ".join(
            f"{label} {percent(share)}" for label, share in results["reactions"]["by_class"].items()
        )
        + ".",
        "",
        "## The quality network",
        "`quality.onnx` sees both people frame by frame and says how probable it is so far that "
        "the reaction is a recorded one to this action. It was trained on the training split "
        "against counterfeits, judges what is generated, and taught the generator nothing.",
        "",
        "On the test split it holds for recorded, more probably than not: "
        + ", ".join(f"{PASSES[name]} {percent(share)}" for name, share in quality["passes"].items())
        + ".",
        "A recorded reaction is held to be better than a counterfeit (area under the curve): "
        + ", ".join(f"{name.replace('_', ' ')} {auc:.2f}" for name, auc in quality["auc"].items())
        + ".",
        "",
        "## Also",
        f"- its own end is {results['reactions']['length_error_frames']} frames off",
        f"- one frame on one thread: p50 {latency['p50_ms']} ms, p95 {latency['p95_ms']} ms",
        f"- torch and ONNX differ by at most {results['onnx_difference_m']:.1e} m in "
        "a whole reaction",
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
    for name, unit in (("diversity_score", " %"), ("frechet_distance", ""), ("error_mm", " mm")):
        cells.append(f"{figures[name]}{unit}" if name in figures else "-")
    return f"| {words} | " + " | ".join(cells) + " |"
