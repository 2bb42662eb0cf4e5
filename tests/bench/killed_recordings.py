"""Kill a recording server at random moments; print whether its files are readable and what is lost.

python -m tests.bench.killed_recordings --count 200 --json
"""

import argparse
import asyncio
import json
import sys

import numpy as np

from tests.support.kills import kill_often

MAX_LOST_S = 1.0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="how often it is killed")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true", help="on one line")
    arguments = parser.parse_args()
    kills = asyncio.run(kill_often(arguments.count, arguments.seed))
    p50, p95 = np.percentile(kills.lost_s, (50, 95))
    figures = {
        "seed": arguments.seed,
        "kills": kills.kills,
        "unreadable": kills.unreadable,
        "wrong": kills.wrong,
        "frames_saved": kills.frames,
        "lost_s_p50": round(float(p50), 3),
        "lost_s_p95": round(float(p95), 3),
        "lost_s_max": round(max(kills.lost_s), 3),
    }
    print(json.dumps(figures, indent=None if arguments.json else 2))  # noqa: T201
    is_good = not (kills.unreadable or kills.wrong) and max(kills.lost_s) <= MAX_LOST_S
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
