"""How long the server takes from its start until it is ready.

``python -m tests.bench.start --runs 5 --json``: from the start of the process to
``/readyz``, by the clock and in processor time. The first run is left out: it fills the disk's
cache and compiles the modules, as an installer does.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import httpx
from prometheus_client.parser import text_string_to_metric_families

READY_WITHIN_S = 60.0


def start(compiled):
    """Start a server, wait until it is ready, stop it: seconds by the clock, and of processor."""
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": compiled}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    began_s = time.perf_counter()
    command = (sys.executable, "-m", "agent_server", "serve", "--json", "--port", "0")
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
    ) as server:
        try:
            url = json.loads(server.stdout.readline())["address"]
            while not _is_ready(url):
                if time.perf_counter() - began_s > READY_WITHIN_S:
                    sys.exit(f"the server is not ready after {READY_WITHIN_S:g} s")
                time.sleep(0.01)
            return time.perf_counter() - began_s, _processor_s(url)
        finally:
            server.terminate()


def _is_ready(url):
    return httpx.get(f"{url}/readyz", timeout=10).status_code == httpx.codes.OK


def _processor_s(url):
    families = text_string_to_metric_families(httpx.get(f"{url}/metrics", timeout=10).text)
    samples = (sample for family in families for sample in family.samples)
    return next(one.value for one in samples if one.name == "process_cpu_seconds_total")


def main():
    """Parse, run, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as compiled:
        start(compiled)
        wall_s, processor_s = zip(*(start(compiled) for _ in range(given.runs)), strict=True)
    found = {
        "runs": given.runs,
        "ready_s": round(statistics.median(wall_s), 2),
        "worst_s": round(max(wall_s), 2),
        "processor_s": round(statistics.median(processor_s), 2),
    }
    print(json.dumps(found, indent=None if given.json else 2))  # noqa: T201 - its answer


if __name__ == "__main__":
    main()
