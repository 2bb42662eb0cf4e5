from dataclasses import replace
from pathlib import Path

import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import ConfigError  # noqa: E402
from models.data.interactions import SBU, Pairs  # noqa: E402
from models.data.layouts import KINECT15  # noqa: E402
from models.interformer.generator.attention import (  # noqa: E402
    SpatialAttention,
    adjacency,
    nearness,
)
from models.interformer.generator.config import (  # noqa: E402
    ABLATIONS,
    PAPER,
    NetworkConfig,
    TrainConfig,
    ablated,
)
from models.interformer.generator.generate import (  # noqa: E402
    OVERLAP,
    TorchCore,
    emphasised,
    generate,
    react_to,
)
from models.interformer.generator.network import Generator  # noqa: E402
from models.interformer.generator.train import (  # noqa: E402
    load_generator,
    react,
    rollout_error,
    train_on,
)
from models.training.run import Run  # noqa: E402
from tests.support.interactions import interactions  # noqa: E402

SMALL = NetworkConfig(features=1, layers=2, heads=3, hidden=32, latent=4, frames=20)


def made(config: NetworkConfig = SMALL, seed: int = 0) -> Generator:
    torch.manual_seed(seed)
    network = Generator(config).eval()
    torch.nn.init.normal_(network.way.weight, std=0.1)
    return network


def pairs(count: int = 5) -> Pairs:
    return Pairs.of(interactions(count), SBU.labels)


def written(network: Generator, some: Pairs, reaction: torch.Tensor, noise: torch.Tensor):
    with torch.no_grad():
        memory = network.encode(some.action, some.lengths)
        return network.decode(reaction, noise, emphasised(memory.kind), memory)


@pytest.mark.parametrize("row", ABLATIONS)
def test_each_frame_gets_a_next_pose_and_an_end(row: str) -> None:
    some = pairs()
    config = ablated(TrainConfig(network=SMALL), row).network
    told = written(made(config), some, some.reaction, torch.randn(5, 4))
    assert told.pose.shape == some.reaction.shape
    assert told.stop.shape == some.reaction.shape[:2]


def test_an_untrained_reaction_stands_still() -> None:
    some = pairs()
    torch.manual_seed(0)
    told = written(Generator(SMALL).eval(), some, some.reaction, torch.randn(5, 4))
    torch.testing.assert_close(told.pose, some.reaction[:, :1].expand_as(told.pose))


@pytest.mark.parametrize("row", ABLATIONS)
def test_a_future_frame_of_the_reaction_never_changes_the_past(row: str) -> None:
    some, network = pairs(), made(ablated(TrainConfig(network=SMALL), row).network)
    noise = torch.randn(5, 4)
    before = written(network, some, some.reaction, noise)
    changed = some.reaction.clone()
    changed[:, 6:] += torch.randn_like(changed[:, 6:])
    after = written(network, some, changed, noise)
    torch.testing.assert_close(after.pose[:, :6], before.pose[:, :6])
    torch.testing.assert_close(after.stop[:, :6], before.stop[:, :6])
    assert not torch.allclose(after.pose[:, 6], before.pose[:, 6])


def test_padding_changes_nothing() -> None:
    some, network = pairs(), made()
    noise = torch.randn(5, 4)
    whole = written(network, some, some.reaction, noise)
    for row in range(5):
        one = some.take(torch.tensor([row]))
        alone = written(network, one, one.reaction, noise[row : row + 1])
        frames = int(one.lengths[0])
        torch.testing.assert_close(alone.pose[0], whole.pose[row, :frames], atol=1e-5, rtol=1e-5)


@pytest.mark.parametrize("config", [SMALL, replace(PAPER, frames=20)], ids=["small", "paper"])
def test_frame_by_frame_gives_what_all_at_once_gives(config: NetworkConfig) -> None:
    some, network = pairs(), made(config)
    noise = torch.randn(5, config.latent)
    core = TorchCore(network)
    reaction, lengths = generate(
        core, some.action, some.lengths, some.reaction[:, :1], noise, 8, stops=False
    )
    assert lengths.tolist() == [8] * 5
    told = written(network, some, reaction, noise)
    torch.testing.assert_close(reaction[:, 1:], told.pose[:, :-1], atol=1e-5, rtol=1e-5)


def test_the_most_probable_kind_alone_is_told_and_told_loudly() -> None:
    kind = torch.tensor([[1.0, 3.0, 2.9, 0.0], [5.0, 0.0, 0.0, 4.0]])
    told = emphasised(kind)
    expected = [[-0.25, 1.75, -0.25, -0.25], [1.75, -0.25, -0.25, -0.25]]
    torch.testing.assert_close(told, torch.tensor(expected))


def test_a_reaction_ends_where_its_end_is_more_probable_than_not() -> None:
    some, network = pairs(), made()
    torch.nn.init.normal_(network.stop.weight, std=1.0)
    core, noise, first = TorchCore(network), torch.randn(5, 4), some.reaction[:, :1]
    endless, _ = generate(core, some.action, some.lengths, first, noise, 8, stops=False)
    stop = written(network, some, endless, noise).stop
    torch.nn.init.constant_(network.stop.bias, -float(stop.median()))
    reaction, lengths = generate(core, some.action, some.lengths, first, noise, 8)
    over = stop - stop.median() > 0
    for row, length in enumerate(lengths.tolist()):
        expected = int(over[row].int().argmax()) + 1 if over[row].any() else 8
        assert length == expected
        assert (reaction[row, length:] == reaction[row, length - 1]).all()
        torch.testing.assert_close(reaction[row, :length], endless[row, :length])


def test_other_noise_makes_another_reaction_and_the_same_noise_the_same() -> None:
    some, network = pairs(), made()
    first, again, other = (
        react(network, some, torch.randn(5, 4, generator=torch.Generator().manual_seed(seed)))[0]
        for seed in (1, 1, 2)
    )
    assert torch.equal(first, again)
    frames = min(first.shape[1], other.shape[1])
    assert not torch.allclose(first[:, :frames], other[:, :frames])


def test_the_masks_are_those_of_the_skeleton() -> None:
    mask = adjacency()
    assert torch.equal(mask, mask.T)
    assert int(mask.sum()) == 15 + 2 * len(KINECT15.bones)
    assert mask[3].nonzero().flatten().tolist() == [1, 3, 4]  # neck, shoulder, elbow


@pytest.mark.parametrize("masked", [True, False])
def test_spatial_attention_is_attention_over_all_joints_behind_a_mask(masked: bool) -> None:
    some, config = pairs(), replace(SMALL, features=2)
    torch.manual_seed(0)
    attention = SpatialAttention(config, masked)
    x, other = torch.randn(2, *some.reaction.shape[:2], config.width)
    near = nearness(some.reaction, some.action)
    mask = adjacency() if masked else torch.ones(15, 15).bool()
    told = []
    for coordinate in range(3):
        asking, asked = (each.unflatten(-1, (3, 15, 2))[:, :, coordinate] for each in (x, other))
        q, k, v = (
            each @ weights[coordinate]
            for each, weights in (
                (asking, attention.queries),
                (asked, attention.keys),
                (asked, attention.values),
            )
        )
        scores = (q @ k.transpose(-1, -2) * 2**-0.5).masked_fill(~mask, -torch.inf)
        told.append((torch.softmax(scores, -1) + (0 if masked else near)) @ v)
    expected = attention.out(torch.stack(told, dim=2).flatten(2))
    found = attention(x, other, None if masked else near)
    torch.testing.assert_close(found, expected, atol=1e-5, rtol=1e-5)


def test_near_joints_have_larger_shares() -> None:
    some = pairs()
    near = nearness(some.reaction, some.action)
    torch.testing.assert_close(near.sum(-1), torch.ones(near.shape[:-1]))
    apart = torch.cdist(some.reaction, some.action)
    assert torch.equal(near.argmax(-1), apart.argmin(-1))


def test_a_long_action_is_reacted_to_in_pieces_without_a_leap() -> None:
    network = made()
    torch.nn.init.constant_(network.stop.bias, -9.0)
    torch.nn.init.zeros_(network.way.weight)
    action = pairs(1).action[0]
    long = action.repeat(8, 1, 1)[:50]
    first = pairs(1).reaction[0, 0]
    room = torch.tensor([1.0, 0.5, 2.0])
    made_up = react_to(TorchCore(network), long + room, first + room, torch.zeros(4), 20)
    assert len(made_up) >= len(long) - OVERLAP
    torch.testing.assert_close(made_up, (first + room).expand_as(made_up))


def test_a_room_that_is_turned_turns_the_reaction() -> None:
    network, some = made(), pairs(1)
    turn = torch.tensor([[0.6, 0.0, -0.8], [0.0, 1.0, 0.0], [0.8, 0.0, 0.6]])
    noise, core = torch.randn(4), TorchCore(network)
    plain = react_to(core, some.action[0], some.reaction[0, 0], noise, 20)
    turned = react_to(core, some.action[0] @ turn, some.reaction[0, 0] @ turn, noise, 20)
    torch.testing.assert_close(turned, plain @ turn, atol=1e-4, rtol=1e-4)


def test_a_short_training_beats_standing_still(tmp_path: Path) -> None:
    config = TrainConfig(
        network=SMALL, steps=80, batch=8, learning_rate=5e-3, validate_every=40, noise_m=0.005
    )
    some = pairs(14)
    still = 1000 * float(
        ((some.reaction[:, :1] - some.reaction).norm(dim=-1).mean(-1) * some.mask).sum()
        / some.mask.sum()
    )
    train_on(config, Run(tmp_path / "run", config, 0, "train", resume=False), some, some)
    assert rollout_error(load_generator(tmp_path / "run"), some) < 0.7 * still


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="heads 4 does not divide"):
        NetworkConfig(features=1, heads=4)
    with pytest.raises(ConfigError, match="set spatial, too"):
        NetworkConfig(spatial=False)
    with pytest.raises(ConfigError, match="uses is 0"):
        TrainConfig(uses=0)


def test_the_published_shape() -> None:
    assert (PAPER.width, PAPER.layers, PAPER.heads, PAPER.hidden) == (45, 6, 3, 2048)
