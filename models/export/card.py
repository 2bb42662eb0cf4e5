"""Cards: what a model is, how it was made and what was measured, in Markdown."""

from collections.abc import Mapping
from typing import Any

from agent_server.config import DecideSettings
from agent_server.domain.gesture import GESTURES
from agent_server.inference.manifest import Manifest, MotionManifest, Training

_DECIDE = DecideSettings()

SETS = {
    "server": "CMU motion capture, the published test files",
    "server-msrc12": "MSRC-12, Kinect recordings that are for evaluation only",
    "server-synthetic": "synthetic people that no split of the training has seen",
    "cmu": "CMU motion capture, the published test files",
    "h36m-256": "Human3.6M, 256 windows of each complete action of S5 (`h36m-256`)",
    "h36m-rms": "Human3.6M, the complete actions of S5, root mean square (`h36m-rms`)",
}
FAMILIES = {
    "ma_wgan": "A generator trained with a critic on tangent vectors of spheres of square-root "
    "velocity functions (manifold-aware Wasserstein GAN).",
    "hp_gan": "HP-GAN: a recurrent generator from sequence to sequence with chance in its states, "
    "taught by a discriminator.",
    "simlpe": "siMLPe (Back to MLP): linear maps over the DCT of the past.",
}
SAMPLED = {"cmu": SETS["server"], "synthetic": SETS["server-synthetic"]}
DRAWN_ROWS = {
    "windows": "windows",
    "error_mm": "distance of a future from the truth, mm",
    "best_mm": "of the nearest of four",
    "mean_mm": "of their mean",
    "still_mm": "of the last pose repeated",
    "apart_mm": "two futures apart, mm",
    "jump_mm": "first step, mm",
    "true_jump_mm": "the truth's",
    "seam_mm": "first step less the last seen one, mm",
    "true_seam_mm": "the truth's",
    "plausible": "futures that are judged real",
    "real_plausible": "true futures that are judged real",
}
GESTURE_ROWS = {
    "1s+2s_predicted": "1 s seen, 2 s predicted (as it runs)",
    "1s+last_frame": "1 s seen, last frame repeated",
    "3s_true": "3 s seen, nothing predicted",
}


def predictor_card(manifest: MotionManifest) -> str:
    """The card of a predictor."""
    origin = (
        "the navel of the last seen frame, axes of the camera frame"
        if manifest.normaliser == "navel_last_seen"
        else "the root, which neither moves nor turns"
    )
    seconds = manifest.output_frames / manifest.rate_hz
    past = manifest.input_frames / manifest.rate_hz
    family = manifest.training.command.split()[4]
    lines = [
        head(manifest, f"Predicts {seconds:g} s of motion from the last {past:g} s."),
        f"Input `seen` (B, {manifest.input_frames}, J, 3), output `future` "
        f"(B, {manifest.output_frames}, J, 3), float32, the joints of {manifest.skeleton}: "
        f"metres, origin at {origin}, {manifest.rate_hz} Hz.",
        "",
        FAMILIES[family],
        "",
        "## Measured",
    ]
    for row in _measured(manifest.results):
        words = f"On {SETS[row['protocol']]}, {row['windows']} windows, {row['metric']}:"
        lines += ["", words, "", *_horizon_table(row), "", _motion_line(row["average"])]
    return "\n".join([*lines, "", *tail(manifest)])


def _measured(results: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The rows of all protocols; the server's own has the others inside."""
    nested: list[Mapping[str, Any]] = [
        row for row in results.values() if isinstance(row, dict) and "protocol" in row
    ]
    return [results, *nested] if "protocol" in results else nested


def sampler_card(manifest: MotionManifest) -> str:
    """The card of a sampler."""
    lines = [
        head(manifest, f"Draws up to {manifest.draws} futures of 2 s from the last 1 s."),
        f"Inputs `seen` (B, {manifest.input_frames}, 9, 3) float32 and `draw` (B,) int64, the "
        f"number of a draw in 0..{manifest.draws - 1}; outputs `future` "
        f"(B, {manifest.output_frames}, 9, 3) and `quality` (B,), how probably the future is real. "
        "Metres, origin at the navel of the last seen frame, axes of the camera frame, "
        f"{manifest.rate_hz} Hz. The random vectors are inside the graph: a number means the same "
        "future of a motion everywhere. They are of the quarter of many whose futures, on "
        "validation windows, are judged real most often.",
        "",
        f"{FAMILIES[manifest.training.command.split()[4]]} The quality network of HP-GAN was "
        "trained beside it and taught nobody.",
        "",
        "## Measured",
        "Held-out windows every second; four draws of each.",
        "",
        "| | " + " | ".join(SAMPLED.values()) + " |",
        "|---" * (len(SAMPLED) + 1) + "|",
    ]
    for key, words in DRAWN_ROWS.items():
        cells = " | ".join(
            percent(row[key]) if key.endswith("plausible") else f"{row[key]:g}"
            for row in (manifest.results[name] for name in SAMPLED)
        )
        lines.append(f"| {words} | {cells} |")
    times = ", ".join(
        f"{count}: p50 {row['p50_ms']} ms, p95 {row['p95_ms']} ms"
        for count, row in manifest.results["latency"].items()
    )
    return "\n".join(
        [
            *lines,
            "",
            f"- draws of one window in one batch on one thread: {times}",
            f"- torch and ONNX differ by at most {manifest.results['onnx_difference']:.1e}",
            "",
            *made(
                manifest,
                manifest.training,
                f"the checkpoint is that of update {manifest.results['update']}, chosen on "
                "validation people and recordings",
            ),
        ]
    )


def classifier_card(manifest: MotionManifest) -> str:
    """The card of a classifier."""
    results = manifest.results
    lines = [
        head(manifest, "Tells seven gestures apart from one second seen and two predicted."),
        "Input `motion` (B, 75, 9, 3) float32: 25 seen and 50 predicted frames at 25 Hz, metres, "
        "origin at the navel of the last seen frame, axes of the camera frame. Output "
        f"`probabilities` (B, 7): {', '.join(GESTURES)}.",
        "",
        "An Interformer encoder: attention between joints (masked by the skeleton, a head a "
        "coordinate) in parallel with attention between moments. The temperature that calibrates "
        f"the probabilities ({results['temperature']:.2f}) is inside the graph.",
        "",
        "A window shows a gesture from 0.32 s after its onset until 0.4 s before its end; windows "
        "in between are left out of training and of the accuracies.",
        "",
        "## Measured",
        "On synthetic people that no split of the training has seen:",
        "",
        "| what the classifier gets | accuracy | mean recall | calibration error |",
        "|---|---|---|---|",
    ]
    for key, words in GESTURE_ROWS.items():
        if key in results:
            row = results[key]
            lines.append(
                f"| {words} | {percent(row['accuracy'])} | "
                f"{percent(row['balanced_accuracy'])} | {row['ece']:.3f} |"
            )
    recall = results["1s+2s_predicted"]["recall"]
    lines += [
        "",
        "Recall of each class with predicted frames: "
        + ", ".join(f"{name} {percent(value)}" for name, value in recall.items())
        + ".",
        "",
        f"Decisions ({_DECIDE.enter_windows} windows in a row, 0.2 s apart, at {_DECIDE.enter:g} "
        f"or more, hello at {_DECIDE.enter_ungated:g}):",
        "",
        *decision_lines(results["decisions"]),
        "",
        "Reactions where there should be none:",
        "",
    ]
    lines += [
        f"- {words}: {row['false_reactions']} in {row['minutes']} minutes"
        for words, row in (
            ("synthetic idle motion with hard negatives", results["idle_synthetic"]),
            ("CMU test recordings", results["idle_cmu"]),
        )
    ]
    return "\n".join([*lines, "", *tail(manifest)])


def head(manifest: Manifest, sentence: str) -> str:
    """Title, a sentence, and what the weights are."""
    return (
        f"# {manifest.name} {manifest.version}\n\n{sentence}\n\n"
        f"{manifest.parameters:,} parameters, ONNX opset {manifest.opset}, weights under "
        f"{manifest.licence}.\n"
    )


def _horizon_table(row: Mapping[str, Any]) -> list[str]:
    def cells(values: Mapping[str, float]) -> str:
        return " | ".join(f"{value:.1f}" for value in values.values())

    errors = row["average"]["mpjpe"]
    lines = [
        "| | " + " | ".join(f"{ms} ms" for ms in errors) + " |",
        "|---" * (len(errors) + 1) + "|",
        f"| this model | {cells(errors)} |",
    ]
    if "zero_velocity" in row:
        lines.append(f"| zero velocity (the last pose repeated) | {cells(row['zero_velocity'])} |")
    return lines


def _motion_line(row: Mapping[str, Any]) -> str:
    return (
        f"It moves {row['mpjs_mm']} mm a frame where the truth moves {row['true_mpjs_mm']}; its "
        f"first step is {row['jump_mm']} mm where the truth's is {row['true_jump_mm']}; bones "
        f"deviate by {row['bone_error_mm']} mm."
    )


def decision_lines(row: Mapping[str, Any]) -> list[str]:
    """What the decision stage makes of labelled takes."""
    return [
        f"- {row['takes']} takes of one gesture: {percent(row['right'])} right, "
        f"{percent(row['wrong'])} wrong, {percent(row['missed'])} missed",
        f"- from onset to decision: median {row['delay_s_p50']} s, "
        f"nine in ten within {row['delay_s_p90']} s",
    ]


def tail(manifest: MotionManifest) -> list[str]:
    """Time, exactness and origin."""
    results = manifest.results
    same = "the same bits as" if manifest.batch_exact else "other bits than"
    return [
        f"- one window on one thread: p50 {results['latency']['p50_ms']} ms, "
        f"p95 {results['latency']['p95_ms']} ms",
        f"- torch and ONNX differ by at most {results['onnx_difference']:.1e}",
        f"- a row of a batch of up to 16 has {same} a batch of one",
        "",
        *made(
            manifest,
            manifest.training,
            "the checkpoint was chosen on validation people and recordings",
        ),
    ]


def made(manifest: Manifest, training: Training, chosen: str) -> list[str]:
    """Data, command, time and the choice of the checkpoint."""
    return [
        "## How it was made",
        *(f"- {s.name}: {_origin(s.synthetic)}, licence: {s.licence}" for s in training.data),
        f"- `{training.command}`",
        f"- seed {training.seed}, {training.wall_s / 60:.0f} minutes on {training.hardware}",
        f"- {chosen}",
        "",
        _caveat(manifest, training),
        "",
    ]


def _caveat(manifest: Manifest, training: Training) -> str:
    if manifest.licence.startswith("research only"):
        return (
            "Research only: these weights may be used to check the figures above and for nothing "
            "else. They are part of neither the wheel nor the image."
        )
    if any(source.synthetic for source in training.data):
        return (
            "The synthetic motion is made up by a program. It says nothing yet about how the "
            "model does on real people performing these gestures."
        )
    return "A baseline to compare with; the server does not run it."


def _origin(synthetic: bool) -> str:
    return "synthetic" if synthetic else "real recordings"


def percent(share: float) -> str:
    """A share for readers."""
    return f"{100 * share:.1f} %"
