"""The card of a classifier that was taught gestures by its user."""

from agent_server.inference.manifest import MotionManifest
from models.evaluation.readings import PREDICTED
from models.export.card import head, percent, tail

ROWS = {
    "1s+2s_predicted": "1 s seen, 2 s predicted (as it runs)",
    "1s+last_frame": "1 s seen, last frame repeated",
    "3s_true": "3 s seen, nothing predicted",
}


def taught_card(manifest: MotionManifest) -> str:
    """The card in Markdown."""
    results = manifest.results
    people, decided = results["people"], results["decisions"][PREDICTED]
    lines = [
        head(manifest, f"Tells {len(manifest.labels)} classes of motion apart."),
        f"Classes: {', '.join(manifest.labels)}; taught by recordings: "
        f"{', '.join(results['taught'])}.",
        "",
        f"Trained on {', '.join(people['train'])} with a {results['encoder']} encoder; "
        f"{people['chosen']} chose the checkpoint and the temperature "
        f"({results['temperature']:.2f}); the figures are of {people['test']}.",
        "",
    ]
    if people["chosen"] == people["test"]:
        lines += [
            "The person of the figures also chose the checkpoint, so that they are kinder than "
            "those of a third person would be.",
            "",
        ]
    lines += [
        "## Measured",
        "| what the classifier gets | accuracy | mean recall | calibration error |",
        "|---|---|---|---|",
        *(
            f"| {words} | {percent(results[key]['accuracy'])} | "
            f"{percent(results[key]['balanced_accuracy'])} | {results[key]['ece']:.3f} |"
            for key, words in ROWS.items()
        ),
        "",
        f"- gestures decided on: {percent(decided['right'])} right, {percent(decided['wrong'])} "
        f"wrong, {percent(decided['missed'])} missed of {decided['gestures']}",
        f"- from onset to decision: median {decided['delay_s_p50']} s, nine in ten within "
        f"{decided['delay_s_p90']} s",
        f"- false reactions to synthetic idle motion: "
        f"{results['idle_synthetic']['false_reactions']} in "
        f"{results['idle_synthetic']['minutes']} minutes",
        "",
        *tail(manifest),
    ]
    return "\n".join(lines)
