from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import ConfigError  # noqa: E402
from models.data.clips import Clips, cut_clips  # noqa: E402
from models.data.layouts import Layout  # noqa: E402
from models.simlpe.config import CONFIGS, NetworkConfig, TrainConfig  # noqa: E402
from models.simlpe.network import SiMlpe  # noqa: E402
from models.simlpe.train import SiMlpeLearner, load_simlpe  # noqa: E402
from models.training.errors import position_error  # noqa: E402
from models.training.fit import fit  # noqa: E402
from models.training.run import Run  # noqa: E402
from models.training.source import ClipSource, Windows  # noqa: E402

SMALL = NetworkConfig(seen=20, step=5, future=12, coordinates=9, blocks=2)
CONFIG = TrainConfig(network=SMALL, steps=4, batch=8, validate_every=2, ema=0.9)


def swinging(count: int = 4) -> Clips:
    rng = np.random.default_rng(0)
    time = np.arange(80)[:, None, None] / 25
    recordings = [
        (0.2 * np.sin(rng.uniform(2, 6) * time + rng.uniform(0, 6, (1, 3, 3)))).astype(np.float32)
        for _ in range(count)
    ]
    return cut_clips(recordings, 32)


def source() -> ClipSource:
    clips = swinging()
    motion = clips.all()
    held = {"swinging": Windows(motion[:, :20], motion[:, 20:])}
    return ClipSource(clips, 20, held, Layout("core9", (0, 1, 2), (0, 1, 2), ((0, 1),)), vary=False)


def test_the_published_network_has_the_published_size() -> None:
    network = SiMlpe(CONFIGS["published"].network)
    assert sum(p.numel() for p in network.parameters()) == 48 * (50 * 50 + 50 + 2 * 66) + 2 * (
        66 * 66 + 66
    )


def test_an_untrained_network_repeats_the_last_pose() -> None:
    seen = swinging().all()[:3, :20]
    future = SiMlpe(SMALL)(seen)
    torch.testing.assert_close(future, seen[:, -1:].expand(-1, 12, -1, -1), atol=1e-5, rtol=0)


def test_later_frames_come_from_feeding_the_first_ones_back() -> None:
    torch.manual_seed(0)
    network = SiMlpe(SMALL)
    torch.nn.init.normal_(network.out.weight, std=0.1)
    seen = swinging().all()[:3, :20].flatten(2)
    first = network.one_pass(seen)
    assert first.shape == (3, 5, 9)
    second = network.one_pass(torch.cat([seen, first], dim=1)[:, -20:])
    whole = network(seen.unflatten(2, (3, 3))).flatten(2)
    torch.testing.assert_close(whole[:, :10], torch.cat([first, second], dim=1))
    assert whole.shape == (3, 12, 9)


def test_half_precision_is_for_training_and_near_the_whole_one() -> None:
    torch.manual_seed(0)
    network = SiMlpe(SMALL, half=True)
    torch.nn.init.normal_(network.out.weight, std=0.1)
    for block in network.blocks:
        torch.nn.init.normal_(block.time.weight, std=0.1)
    seen = swinging().all()[:3, :20].flatten(2)
    exact = network.eval().one_pass(seen)
    rough = network.train().one_pass(seen)
    assert not torch.equal(exact, rough)
    torch.testing.assert_close(rough, exact, atol=0.1, rtol=0)


def test_swings_are_learnt_better_than_standing_still(tmp_path: Path) -> None:
    torch.manual_seed(0)
    config = replace(CONFIG, steps=150, learning_rate=3e-3, drop_at=None)
    learner = SiMlpeLearner(config, source())
    cpu, held = torch.device("cpu"), source().validation["swinging"]
    still = position_error(SiMlpe(SMALL), held, cpu)
    fit("simlpe", learner, Run(tmp_path / "run", config, 0, "train", resume=False), 150, 50)
    assert position_error(load_simlpe(tmp_path / "run"), held, cpu) < 0.5 * still


def test_the_rate_drops_where_the_recipe_says() -> None:
    learner = SiMlpeLearner(replace(CONFIG, drop_at=2), source())
    generator = torch.Generator().manual_seed(0)
    rates = []
    for _ in range(4):
        learner.step(generator)
        rates.append(learner.optimizer.param_groups[0]["lr"])
    assert rates == pytest.approx([3e-4, 3e-4, 1e-5, 1e-5])


def test_a_resumed_run_ends_where_an_unbroken_one_does(tmp_path: Path) -> None:
    def go(folder: Path, stop: int, *, resume: bool = False) -> torch.Tensor:
        torch.manual_seed(0)
        learner = SiMlpeLearner(CONFIG, source())
        fit("simlpe", learner, Run(folder, CONFIG, 0, "train", resume), stop, 2)
        return torch.cat([p.flatten() for p in learner.network.parameters()]).detach()

    whole = go(tmp_path / "whole", 4)
    go(tmp_path / "broken", 2)
    assert torch.equal(go(tmp_path / "broken", 4, resume=True), whole)


def test_a_pass_longer_than_the_past_is_refused() -> None:
    with pytest.raises(ConfigError, match="step is 60"):
        NetworkConfig(step=60)
