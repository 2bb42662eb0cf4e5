"""Make the recorded streams and their expected decision logs anew.

``make recordings`` runs it after a change of the generator, the models or the rules; the
difference it makes to ``expected/`` is what a reviewer looks at.
"""

import argparse
import hashlib
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from agent_server import __version__
from agent_server.config import Settings
from agent_server.protocol.inputs import input_from_message, input_to_message
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.writer import RecordingWriter
from agent_server.service.core import Core
from agent_server.service.loading import load_models, load_room
from agent_server.service.replay import log_line, replay
from agent_server.synthetic.scenario import SCENARIOS, Scenario, play

HERE = Path(__file__).parent


def write_stream(scenario: Scenario, path: Path) -> None:
    """Play a scenario into a recording; the same scenario gives the same records."""
    session = play(scenario)
    metadata = RecordingMetadata(
        session=scenario.name,
        server_version=__version__,
        face=session.face,
        joint_format=session.format,
        description=scenario.description,
        licence="Apache-2.0",
        origin=f"synthetic: agent_server.synthetic, seed {scenario.seed}",
    )
    with RecordingWriter(path, metadata, AT_ONCE) as writer:
        appends: list[tuple[int, Callable[[], None]]] = [
            (label.onset_ns, partial(writer.append_label, label)) for label in session.labels
        ]
        for event in session.events:
            # As a live server takes them in: checked and rounded.
            taken = input_from_message(input_to_message(event))
            if taken is None:
                raise AssertionError(f"{event} is nothing that a sensor sends")
            appends.append((event.originating_ns, partial(writer.append_input, taken)))
        for _, append in sorted(appends, key=lambda item: item[0]):
            append()


def write_expected(stream: Path, log: Path) -> int:
    """Write the decision log of a stream; gives the number of decisions."""
    settings, models = Settings(), load_models()
    recording = open_recording(stream)
    rules = load_room(settings, models)
    core = Core(recording.metadata.session, settings, rules, models)
    lines = [log_line(decision) for decision in replay(recording, core, models)]
    log.parent.mkdir(exist_ok=True)
    log.write_bytes(b"".join(line + b"\n" for line in lines))
    return len(lines)


def main() -> None:
    """Make all streams, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="scenarios to make; all if none is named")
    parser.add_argument("--logs-only", action="store_true", help="keep the streams")
    arguments = parser.parse_args()
    for scenario in SCENARIOS:
        if arguments.names and scenario.name not in arguments.names:
            continue
        stream = HERE / f"{scenario.name}.mcap"
        if not arguments.logs_only:
            with tempfile.TemporaryDirectory() as folder:
                made = Path(folder) / stream.name
                write_stream(scenario, made)
                stream.write_bytes(made.read_bytes())
        count = write_expected(stream, HERE / "expected" / f"{scenario.name}.jsonl")
        print(f"{stream.name}: {stream.stat().st_size / 1e6:.2f} MB, {count} decisions")
    sums = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
        for path in sorted(HERE.glob("*.mcap"))
    ]
    (HERE / "SHA256SUMS").write_text("".join(sums), "ascii")


if __name__ == "__main__":
    main()
