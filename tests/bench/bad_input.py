"""Sends mutated messages to a server of its own and prints what came of it as JSON.

    python -m tests.bench.bad_input --count 2000000 --json

Status 1 if anything was not handled, the witness was disturbed, or memory has grown.
"""

import argparse
import asyncio
import json
import sys

from tests.support.bad_input import run_trial

MOST_GROWTH_MIB = 48
UNTOLD_FRAMES = 30
"""What the witness has sent since its last window; its figures come with a window."""


def faults_of(figures):
    """What ought not to be, in words."""
    faults = []
    witness = figures["witness"]
    if figures["unhandled"]:
        faults.append(f"{figures['unhandled']} unhandled exceptions or errors in the log")
    if figures["exit_status"] != 0:
        faults.append(f"the server ended with {figures['exit_status']}")
    if witness["errors"]:
        faults.append(f"the witness was disturbed: {witness['errors']}")
    if not witness["decisions"]:
        faults.append("the witness got no decisions")
    if witness["frames_sent"] - (witness["frames_taken"] or 0) > UNTOLD_FRAMES:
        faults.append("frames of the witness were not taken")
    growth = figures["rss_mib"]["end"] - figures["rss_mib"]["after_a_fifth"]
    if growth > MOST_GROWTH_MIB:
        faults.append(f"memory has grown by {growth:.0f} MiB")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--within-s", type=float, default=24 * 3600, help="stop after this long")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    figures = asyncio.run(run_trial(arguments.count, arguments.seed, arguments.within_s))
    figures["faults"] = faults_of(figures)
    print(json.dumps(figures, indent=None if arguments.json else 2))  # noqa: T201
    sys.exit(bool(figures["faults"]))


if __name__ == "__main__":
    main()
