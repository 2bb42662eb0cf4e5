import shutil
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import BundleError, InvalidInput  # noqa: E402
from agent_server.inference.manifest import (  # noqa: E402
    GOLDEN_FILE,
    ReactionManifest,
    read_manifest,
)
from agent_server.inference.reactor import OnnxReactor  # noqa: E402
from models.data.bvh import read_bvh  # noqa: E402
from models.data.interactions import SBU, SBU_NAMES, Pairs  # noqa: E402
from models.evaluation import interaction  # noqa: E402
from models.evaluation.interaction import Court, position_error_mm, stand_still  # noqa: E402
from models.evaluation.interaction_rows import reacting  # noqa: E402
from models.evaluation.recurrent import JudgeConfig  # noqa: E402
from models.export import reaction  # noqa: E402
from models.export.interaction import write_interaction  # noqa: E402
from models.export.reaction import export_reaction, golden_input  # noqa: E402
from models.interformer.generator.config import NetworkConfig, TrainConfig  # noqa: E402
from models.interformer.generator.generate import TorchCore, generate  # noqa: E402
from models.interformer.generator.onnx_core import ENCODER_FILE, OnnxCore  # noqa: E402
from models.interformer.generator.train import load_generator, train  # noqa: E402
from models.interformer.quality.train import train_quality  # noqa: E402
from models.training.run import Run  # noqa: E402
from tests.support.interactions import interactions, write_sbu  # noqa: E402

SMALL = NetworkConfig(features=1, layers=1, heads=3, hidden=32, latent=4, frames=24)
ROWS = [
    (group, act, 9 + 2 * number)
    for number, group in enumerate(("s01s02", "s02s03", "s01s03"))
    for act in SBU_NAMES
]


QUICK = replace(JudgeConfig(), width=32, steps=120, learning_rate=5e-3)
"""Judges of few updates, which is enough for bodies as simple as these."""


@pytest.fixture(scope="module")
def quick_judges() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(interaction, "JudgeConfig", lambda: QUICK)
        patch.setattr(interaction, "JUDGES", 1)
        patch.setattr(reaction, "train_quality", partial(train_quality, steps=20))
        yield


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory, quick_judges: None) -> Path:
    """The bundle of a run of a few updates on a made-up SBU; the run is beside it."""
    torch.set_num_threads(1)
    place = tmp_path_factory.mktemp("made_up")
    write_sbu(place, "train", ROWS)
    write_sbu(place, "test", [("s02s06", act, 12) for act in SBU_NAMES])
    config = TrainConfig(network=SMALL, steps=6, batch=4, learning_rate=0.02, validate_every=3)
    run = Run(place / "run", config, 0, "python -m models train reaction", resume=False)
    train(config, run, place)
    folder = place / "interformer_sbu"
    export_reaction(place / "run", folder, "0.1.0", place, place / "runs")
    return folder


@pytest.fixture(scope="module")
def core(bundle: Path) -> OnnxCore:
    return OnnxCore.of(bundle)[0]


@pytest.mark.parametrize("rows", [1, 4])
def test_torch_and_onnx_write_the_same_reactions(bundle: Path, core: OnnxCore, rows: int) -> None:
    network = load_generator(bundle.parent / "run")
    given = [part[:rows] for part in golden_input(SMALL.latent)]
    expected, ends = generate(TorchCore(network), *given, 24)
    found, found_ends = generate(core, *given, 24)
    torch.testing.assert_close(found, expected, atol=1e-4, rtol=0)
    assert torch.equal(ends, found_ends)


def test_judges_take_true_reactions_for_what_they_are(tmp_path: Path, quick_judges: None) -> None:
    everybody = interactions(28)
    court = Court.of(SBU, everybody, everybody[:14], tmp_path)

    def truth(pairs: Pairs, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
        return pairs.reaction, pairs.lengths

    found, still = court.measure(truth), court.measure(stand_still)
    assert found["accuracy"] == court.real()["accuracy"] > still["accuracy"] + 0.2
    assert found["diversity_score"] == found["error_mm"] == found["length_error_frames"] == 0
    assert found["frechet_distance"] == pytest.approx(0, abs=1e-3)
    assert still["diversity_score"] > 20 and still["error_mm"] > 20
    again = Court.of(SBU, everybody, everybody[:14], tmp_path)  # the judges are found again
    assert again.real() == court.real()
    assert len(list(tmp_path.iterdir())) == 1


def test_a_reaction_that_ends_early_keeps_its_last_pose(core: OnnxCore, tmp_path: Path) -> None:
    pairs = Pairs.of(interactions(4), SBU.labels)
    court = Court(SBU, pairs, ())

    def early(some: Pairs, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
        return some.reaction[:, :1], torch.ones_like(some.lengths)

    still = pairs.with_reactions(*stand_still(pairs, 0))
    made = pairs.with_reactions(interaction.as_long(early(pairs, 0)[0], pairs), pairs.lengths)
    assert position_error_mm(made, court.test) == position_error_mm(still, court.test)


def test_a_run_becomes_a_bundle_that_is_whole(bundle: Path, tmp_path: Path) -> None:
    folder = tmp_path / bundle.name
    shutil.copytree(bundle, folder)
    core, manifest = OnnxCore.of(folder)
    assert manifest.licence.startswith("research only")
    card = (folder / "CARD.md").read_text()
    assert "Research only" in card and "7 test interactions" in card
    with np.load(folder / GOLDEN_FILE) as golden:
        given = [torch.from_numpy(golden[name]) for name in ("action", "lengths", "given", "noise")]
        found, _ = generate(core, *given, golden["reaction"].shape[1], stops=False)
        np.testing.assert_allclose(found.numpy(), golden["reaction"], atol=1e-4)
    reactor = OnnxReactor(folder)  # which checks the golden output of every network
    assert reactor.manifest.results["quality"]["passes"].keys() == {
        *("recorded", "generated", "zero_velocity")
    }
    with (folder / ENCODER_FILE).open("ab") as file:
        file.write(b"x")
    with pytest.raises(BundleError, match=r"encoder\.onnx was altered"):
        read_manifest(folder, ReactionManifest)


def test_an_interaction_is_written_for_animators(core: OnnxCore, tmp_path: Path) -> None:
    test = interactions(14)

    def write(name: str, label: str = "shaking hands", seed: int = 0) -> Path:
        out = tmp_path / name
        write_interaction(core, SMALL.latent, 24, SBU, test, label, seed, out)
        return out

    names, positions, rate = read_bvh(write("one.bvh"))
    assert (tmp_path / "one.png").read_bytes()[:4] == b"\x89PNG"
    assert rate == pytest.approx(SBU.rate_hz)
    with np.load(write("one.npz")) as motion:
        assert motion["action"].shape[1:] == motion["reaction"].shape[1:] == (15, 3)
        torso = motion["reaction"][:, 2]
    np.testing.assert_allclose(positions[:, names.index("torso")], torso, atol=1e-5)
    with pytest.raises(InvalidInput, match="none of sbu's: walking"):
        write("one.bvh", label="dancing")
    with pytest.raises(InvalidInput, match="ends in none of"):
        write("one.fbx")


def test_the_seed_decides(core: OnnxCore) -> None:
    pairs = Pairs.of(interactions(5), SBU.labels)
    react = reacting(core, SMALL.latent, SMALL.frames)
    first, again, other = (react(pairs, seed)[0] for seed in (0, 0, 1))
    assert torch.equal(first, again)
    assert not torch.equal(first[:, :2], other[:, :2])
