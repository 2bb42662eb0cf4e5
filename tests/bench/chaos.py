"""Does to a server what happens to servers, and prints what was promised and seen as JSON.

    python -m tests.bench.chaos --json
    python -m tests.bench.chaos --only stopped

Status 1 if anything that was promised was not seen.
"""

import argparse
import asyncio
import json
import sys

from tests.support.chaos import SCENARIOS


def main():
    names = [one.__name__ for one in SCENARIOS]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=names, help="one alone")
    parser.add_argument("--json", action="store_true", help="on one line")
    arguments = parser.parse_args()
    chosen = [one for one in SCENARIOS if arguments.only in (None, one.__name__)]
    outcomes = [asyncio.run(one()) for one in chosen]
    print(json.dumps(outcomes, indent=None if arguments.json else 2))  # noqa: T201
    sys.exit(not all(one["kept"] for one in outcomes))


if __name__ == "__main__":
    main()
