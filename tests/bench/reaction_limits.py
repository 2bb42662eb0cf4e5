"""How many motions pass what stands before a generated reaction is played: limits, and quality.

``python -m tests.bench.reaction_limits --data DIR --set sbu k3hi --json``, with the research
bundles of ``models/benchmarks`` and the train extra: the real reactions of the test split, the same
with their frames shuffled and reactions generated for its actions, by the limits alone; and
reactions to the gestures of ``recorded_streams`` (synthetic people), by the limits and the quality
network, once with the noise of their commands and in further draws.
The limits were widened with these figures in sight; they tell what passes, not what is good.
"""

import argparse
import json
from collections import Counter
from pathlib import Path

import numpy as np

from agent_server.config import Settings
from agent_server.inference.reactor import OnnxReactor
from agent_server.qa.watch import WatchedCore
from agent_server.recording.reader import open_recording
from agent_server.service.loading import load_models, load_room
from agent_server.service.replay import replay
from agent_server.stages.react import Doubt, noise_of, react
from models.data.interactions import facing, interaction_set

ROOT = Path(__file__).parents[2]


def passes(reactor, poses):
    """Whether all poses of a motion are within the limits."""
    doubt = Doubt(reactor.range, reactor.rate_hz)
    return all(doubt.push(pose) is None for pose in poses)


def of_test_split(reactor, data, name):
    """Counts of the data set's own test split."""
    rng = np.random.default_rng(0)
    pairs = [facing(one) for one in interaction_set(name).read(data, "test")]
    motions = [(action.numpy(), reaction.numpy()) for action, reaction in pairs]
    made = (
        [pose for pose, _ in reactor.react(action[: reactor.frames], reaction[0], noise)]
        for at, (action, reaction) in enumerate(motions)
        for noise in [noise_of(str(at), reactor.latent)]
    )
    return {
        "of": len(motions),
        "recorded": sum(passes(reactor, reaction) for _, reaction in motions),
        "shuffled": sum(passes(reactor, rng.permutation(reaction)) for _, reaction in motions),
        "generated": sum(passes(reactor, poses) for poses in made),
    }


def answered():
    """Window, forecast and command's id of every answered gesture of the recorded streams."""
    settings = Settings()
    models = load_models(settings)
    rules = load_room(settings, models)
    for path in sorted((ROOT / "recorded_streams").glob("*.mcap")):
        recording = open_recording(path)
        core = WatchedCore(recording.metadata.session, settings, rules, models)
        for _ in replay(recording, core, models):
            pass
        for sight in core.sights:
            if sight.decision.command is not None:
                yield sight.window, sight.forecast, sight.decision.command.id


def of_recorded_streams(reactor, gestures, draws):
    """Counts of the answered gestures, with the command's noise and with others."""
    seeds = [(*seen, f"{command} {draw}") for *seen, command in gestures for draw in range(draws)]
    return {
        "with_the_commands_noise": played(reactor, gestures),
        "in_other_draws": played(reactor, seeds),
    }


def played(reactor, asked):
    """What becomes of reactions: played to their end, or refused, and why and when."""
    counts = Counter()
    for window, forecast, seed in asked:
        *_, last = react(reactor, window, forecast, seed)
        counts["of"] += 1
        if last.refused is None:
            counts["played"] += 1
            continue
        by = "quality" if "quality" in last.refused else "limits"
        counts[f"refused_by_{by}"] += 1
        counts["refused_before_it_began"] += last.first_frame + len(last.positions) == 0
    return counts


def main():
    """Parse, count, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--set", nargs="+", choices=("sbu", "k3hi"), default=("sbu", "k3hi"))
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    gestures = list(answered())
    found = {}
    for name in given.set:
        reactor = OnnxReactor(ROOT / "models" / "benchmarks" / f"interformer_{name}")
        found[name] = {
            "bundle": f"{reactor.name} {reactor.manifest.version}",
            "test_split": of_test_split(reactor, given.data, name),
            "recorded_streams": of_recorded_streams(reactor, gestures, given.draws),
        }
    print(json.dumps(found, indent=None if given.json else 2))  # noqa: T201 - its answer


if __name__ == "__main__":
    main()
