"""Damage recordings at random; print what was read and recovered of them.

    python -m tests.bench.damaged_recordings --count 500 --fuzz-bytes 10000000 --json

The recording is synthetic: 20 s of a body, a face and decisions.
"""

import argparse
import dataclasses
import json
import sys
import tempfile
from pathlib import Path

from tests.support.damage import Trial
from tests.support.recordings import write_session


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=500, help="files that are cut or flipped")
    parser.add_argument("--fuzz-bytes", type=int, default=10_000_000, help="bytes of mutated files")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true", help="on one line")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        whole = write_session(folder / "whole.mcap", seconds=20)
        cuts = Trial(whole, folder, arguments.seed)
        while cuts.damage.files < arguments.count:
            cuts.cut_or_flip()
        fuzz = Trial(whole, folder, arguments.seed + 1)
        while fuzz.damage.damaged_bytes < arguments.fuzz_bytes:
            fuzz.mutate()
    figures = {
        "seed": arguments.seed,
        "cut_or_flipped": dataclasses.asdict(cuts.damage),
        "mutated": dataclasses.asdict(fuzz.damage),
    }
    print(json.dumps(figures, indent=None if arguments.json else 2))  # noqa: T201
    sys.exit(1 if cuts.damage.faults or fuzz.damage.faults else 0)


if __name__ == "__main__":
    main()
