"""The research bundles that make reactions, as the server runs them."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from agent_server import assets
from agent_server.config import ModelSettings, Settings
from agent_server.errors import BundleError, RuleError
from agent_server.inference.manifest import write_manifest
from agent_server.inference.reactor import OnnxReactor
from agent_server.service.loading import PREDICTOR, load_models, load_room
from agent_server.stages.react import noise_of

BENCHMARKS = Path(__file__).parents[3] / "models" / "benchmarks"
NAMES = ("interformer_sbu", "interformer_k3hi")


@pytest.mark.parametrize("name", NAMES)
def test_a_bundle_meets_its_golden_output_and_reacts(name):
    reactor = OnnxReactor(BENCHMARKS / name)
    action, first = (
        np.array(pose, np.float32) for pose in (reactor.range.action, reactor.range.reaction)
    )
    still = np.repeat(action[None], 30, axis=0)
    made = list(reactor.react(still, first, noise_of("s/c1", reactor.latent)))
    poses = [pose for pose, _ in made]
    assert all(0 <= quality <= 1 for _, quality in made)
    assert 1 < len(poses) <= 30
    np.testing.assert_array_equal(poses[0], first)
    assert all(pose.shape == (15, 3) and np.isfinite(pose).all() for pose in poses)
    again = list(reactor.react(still, first, noise_of("s/c1", reactor.latent)))
    np.testing.assert_array_equal(poses, [pose for pose, _ in again])


def test_another_golden_output_or_another_kind_of_bundle_is_refused(tmp_path):
    folder = tmp_path / NAMES[0]
    shutil.copytree(BENCHMARKS / NAMES[0], folder)
    with np.load(folder / "golden.npz") as golden:
        arrays = dict(golden)
    manifest = OnnxReactor(BENCHMARKS / NAMES[0]).manifest
    for name, place in (("reaction", (2, 9, 8, 1)), ("quality", (1, 7))):
        wrong = arrays | {name: arrays[name].copy()}
        wrong[name][place] += 0.01
        np.savez_compressed(folder / "golden.npz", **wrong)
        write_manifest(folder, manifest)
        with pytest.raises(BundleError, match="does not give its golden output"):
            OnnxReactor(folder)
    with pytest.raises(BundleError, match="can predict, one that can react is needed"):
        OnnxReactor(assets.bundles() / PREDICTOR)


def test_none_is_loaded_unless_it_is_named():
    assert load_models().reactor is None
    settings = Settings(models=ModelSettings(reactions=str(BENCHMARKS / NAMES[0])))
    models = load_models(settings)
    assert models.by_task[-1] == ("react", models.reactor)
    assert NAMES[0] in models.hashes


def test_a_rule_that_asks_for_a_motion_that_nobody_makes_is_refused_at_the_start(tmp_path):
    path = tmp_path / "room.toml"
    path.write_text(
        (Path(__file__).parents[3] / "agent_server/scene/room.toml")
        .read_text()
        .replace('reaction = "greet"\n', 'reaction = "greet"\nmotion = "generated"\n')
    )
    line = path.read_text().splitlines().index('motion = "generated"') + 1
    settings = Settings(rules=str(path))
    with pytest.raises(RuleError) as refused:
        load_room(settings, load_models(settings))
    assert str(refused.value) == (
        f"{path}:{line}: rules[5].motion: hello -> greet asks for a generated motion, and no model "
        "makes one; name a bundle that reacts, reactions = 'FOLDER' in [models] of the settings, "
        'or write motion = "authored"'
    )
    able = Settings(rules=str(path), models=ModelSettings(reactions=str(BENCHMARKS / NAMES[0])))
    (rule,) = load_room(able, load_models(able)).rules["hello"]
    assert rule.motion == "generated"
