"""Force disconnects of a client and print whether its commands took effect once.

python -m tests.bench.disconnects --language python --count 1000 --json
"""

import argparse
import asyncio
import json
import sys

from tests.support.command_fates import WRONG
from tests.support.console_clients import LANGUAGES, Missing
from tests.support.disconnects import Trial, run_trial
from tests.support.faults import Delay


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--language", choices=LANGUAGES, required=True)
    parser.add_argument("--count", type=int, default=1000, help="forced disconnects")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--restart-every", type=int, default=10)
    parser.add_argument("--delay-ms", type=float, default=0.0, help="how late bytes pass, each way")
    parser.add_argument("--jitter-ms", type=float, default=0.0, help="and up to this much later")
    parser.add_argument("--json", action="store_true", help="on one line")
    arguments = parser.parse_args()
    trial = Trial(
        arguments.language,
        arguments.count,
        arguments.seed,
        arguments.restart_every,
        delay=Delay(arguments.delay_ms / 1e3, arguments.jitter_ms / 1e3),
    )
    try:
        figures = asyncio.run(run_trial(trial))
    except Missing as error:
        sys.exit(str(error))
    print(json.dumps(figures, indent=None if arguments.json else 2))  # noqa: T201
    is_good = figures["settled"] and not any(figures[fault] for fault in WRONG)
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
