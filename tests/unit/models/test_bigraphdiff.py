import copy
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import BundleError, ConfigError, InvalidInput  # noqa: E402
from agent_server.inference.manifest import GOLDEN_FILE, read_manifest  # noqa: E402
from models.bigraphdiff.attention import JointGraph, LinearAttention  # noqa: E402
from models.bigraphdiff.config import (  # noqa: E402
    CONFIGS,
    NetworkConfig,
    TrainConfig,
    ablated,
    network_for,
)
from models.bigraphdiff.diffusion import Normaliser, both_of, draw, noised, signal  # noqa: E402
from models.bigraphdiff.generate import Generator  # noqa: E402
from models.bigraphdiff.manifest import InteractionManifest  # noqa: E402
from models.bigraphdiff.network import Denoiser, to_draw_with  # noqa: E402
from models.bigraphdiff.onnx_denoiser import INPUTS, open_denoiser, read_generator  # noqa: E402
from models.bigraphdiff.train import Learner, load_denoiser, train, train_on  # noqa: E402
from models.bigraphdiff.words import tokens, vocabulary  # noqa: E402
from models.data.interactions import SBU, SBU_NAMES, TORSO, Pairs  # noqa: E402
from models.evaluation import interaction  # noqa: E402
from models.evaluation.interaction_pair_rows import interacting, run_generator  # noqa: E402
from models.evaluation.interaction_pairs import PairCourt, multimodality, nearest_mm  # noqa: E402
from models.evaluation.recurrent import JudgeConfig  # noqa: E402
from models.export.interactions import (  # noqa: E402
    export_interactions,
    golden_input,
    write_denoiser,
)
from models.export.onnx import round_weights  # noqa: E402
from models.training.run import Run  # noqa: E402
from tests.support.interactions import interactions, write_sbu  # noqa: E402

SHAPE = {"features": 2, "layers": 1, "heads": 3, "hidden": 24, "frames": 20, "dropout": 0.0}
SMALL = network_for("sbu", **SHAPE)
WORDS = tokens(SBU.labels)


def network(config: NetworkConfig = SMALL, seed: int = 0) -> Denoiser:
    """Untrained, but with weights that let everything through."""
    torch.manual_seed(seed)
    made = Denoiser(config).eval()
    for weight in made.parameters():
        if weight.dim() > 1:
            torch.nn.init.normal_(weight, std=0.2)
    return made


def pairs(count: int = 6) -> Pairs:
    return Pairs.of(interactions(count), SBU.labels)


def given(config: NetworkConfig = SMALL) -> tuple[torch.Tensor, ...]:
    return golden_input(config, WORDS)


def test_labels_become_the_numbers_of_their_words() -> None:
    labels = ("shaking hands", "Kicking")
    assert vocabulary(labels) == ("hands", "kicking", "shaking")
    assert tokens(labels).tolist() == [[3, 1], [2, 0]]


@pytest.mark.parametrize("row", ["S1", "S2", "S3", "S4"])
def test_the_papers_rows_differ_in_what_they_leave_out(row: str) -> None:
    config = ablated(TrainConfig(SMALL, "sbu"), row).network
    made = network(config)
    noisy, lengths, step, words = given(config)
    with torch.no_grad():
        whole = made(noisy, lengths, step, words)
        streams = made.layers[0](
            [torch.randn(1, 4, config.width, generator=torch.Generator().manual_seed(who))
             for who in (0, 1)],
            torch.ones(1, 4).bool(), torch.zeros(1, 2, config.width),
            torch.ones(1, 2).bool(), torch.zeros(1, config.width),
        )  # fmt: skip
        other = made.layers[0](
            [torch.randn(1, 4, config.width, generator=torch.Generator().manual_seed(who))
             for who in (0, 2)],
            torch.ones(1, 4).bool(), torch.zeros(1, 2, config.width),
            torch.ones(1, 2).bool(), torch.zeros(1, config.width),
        )  # fmt: skip
    assert whole.shape == noisy.shape
    hears_the_other = not torch.equal(streams[0], other[0])
    assert hears_the_other == (row == "S4")
    graphs = [part for part in made.modules() if isinstance(part, JointGraph)]
    assert len(graphs) == (2 if row in ("S3", "S4") else 0)
    drawn = Generator.of(made, Normaliser.of(pairs()), WORDS, config).drawn_steps
    assert (drawn == 1) == (row == "S1")


def test_guidance_goes_on_from_what_no_label_makes() -> None:
    config = ablated(TrainConfig(SMALL, "sbu"), "guided").network
    made = network(config)
    noisy, lengths, step, words = given(config)
    with torch.no_grad():
        led = to_draw_with(made)(noisy, lengths, step, words)
        named, unnamed = (made(noisy, lengths, step, one) for one in (words, 0 * words))
    assert config.guidance > 1
    assert not torch.allclose(named, unnamed)
    torch.testing.assert_close(led - unnamed, config.guidance * (named - unnamed))
    assert isinstance(to_draw_with(network()), Denoiser), "without guidance one call is enough"


def test_an_exported_step_is_led_for_any_batch(tmp_path: Path) -> None:
    made = network(ablated(TrainConfig(SMALL, "sbu"), "guided").network)
    write_denoiser(made, tmp_path / "model.onnx")
    denoise = open_denoiser(tmp_path / "model.onnx")
    noisy, lengths, step, words = given(made.config)
    for count in (1, 4):
        some = noisy[:count], lengths[:count], step[:count], words[:count]
        with torch.no_grad():
            torch.testing.assert_close(
                denoise(*some), to_draw_with(made)(*some), atol=1e-4, rtol=1e-4
            )


def test_padding_changes_nothing_and_every_input_counts() -> None:
    made = network()
    noisy, lengths, step, words = given()
    with torch.no_grad():
        whole = made(noisy, lengths, step, words)
        for row, length in enumerate(lengths.tolist()):
            one = slice(row, row + 1)
            alone = made(noisy[one, :, :length], lengths[one], step[one], words[one])
            torch.testing.assert_close(alone[0], whole[row, :, :length], atol=1e-5, rtol=1e-5)
        assert not torch.allclose(made(noisy, lengths, 0 * step, words)[0], whole[0])
        assert not torch.allclose(made(noisy, lengths, step, words.flip(0))[0], whole[0])


def test_linear_attention_is_what_it_costs_less_than() -> None:
    torch.manual_seed(0)
    made = LinearAttention(SMALL).eval()
    torch.nn.init.normal_(made.styled.out.weight)
    x, style = torch.randn(1, 5, SMALL.width), torch.randn(1, SMALL.width)
    mask = torch.tensor([[True, True, True, False, True]])
    q = made.queries(made.norm(x)).reshape(5, SMALL.heads, -1)
    k, v = made.keys_values(made.other_norm(x)).reshape(5, 2, SMALL.heads, -1).unbind(1)
    seen = mask[0].nonzero().flatten()
    mixed = torch.zeros_like(q)
    for head in range(SMALL.heads):
        weights = torch.softmax(q[:, head], -1) @ torch.softmax(k[seen, head], 0).T
        mixed[:, head] = weights @ v[seen, head]  # (T, S) scores, which it never makes
    expected = x + made.styled(mixed.reshape(1, 5, -1), style)
    torch.testing.assert_close(made(x, x, mask, style), expected, atol=1e-5, rtol=1e-5)


def test_normalised_motion_is_of_unit_size_and_comes_back() -> None:
    some = pairs()
    normaliser = Normaliser.of(some)
    motion = both_of(some)
    torch.testing.assert_close(normaliser.back(normaliser.into(motion)), motion)
    shifted = normaliser.into(motion + torch.tensor([1.0, 0.0, 0.0])) - normaliser.into(motion)
    assert shifted[..., TORSO, 0].abs().min() > 0.1  # the torso moves, and nothing else does
    shifted[..., TORSO, :] = 0
    torch.testing.assert_close(shifted, torch.zeros_like(shifted), atol=1e-4, rtol=0)


def test_noise_grows_until_nothing_is_left() -> None:
    left = signal(1000)
    assert (left.diff() <= 0).all() and left[0] > 0.999 and left[-1] < 1e-4
    clean, noise = torch.ones(2, 3), torch.zeros(2, 3)
    step = torch.tensor([0, 500])
    torch.testing.assert_close(noised(clean, noise, step, left)[:, 0], left[step].sqrt())


def test_draws_have_the_spread_of_what_the_noise_was_taken_from() -> None:
    # Of a normal distribution the best guess is known, so that draws can be checked.
    left, spread, middle = signal(1000), 0.3, 2.0

    def best(noisy: torch.Tensor, lengths: torch.Tensor, step: torch.Tensor, words: torch.Tensor):
        share = left[step].reshape(-1, 1, 1, 1, 1)
        gain = share.sqrt() * spread**2 / (share * spread**2 + 1 - share)
        return middle + gain * (noisy - share.sqrt() * middle)

    noise = torch.randn(20, 2, 10, 15, 3, generator=torch.Generator().manual_seed(0))
    lengths, words = torch.full((20,), 10), torch.ones(20, 1).long()
    found = draw(best, noise, lengths, words, 1000)
    assert float(found.mean()) == pytest.approx(middle, abs=0.02)
    assert float(found.std()) == pytest.approx(spread, rel=0.1)
    at_once = draw(best, noise, lengths, words, 1000, drawn_steps=1)
    assert float(at_once.std()) < 0.01  # a transformer alone gives the mean
    with pytest.raises(InvalidInput, match="take 1 to 1000 steps"):
        draw(best, noise, lengths, words, 1000, drawn_steps=2000)


def generator(config: NetworkConfig = SMALL) -> Generator:
    return replace(
        Generator.of(network(config), Normaliser.of(pairs()), WORDS, config), drawn_steps=4
    )


def test_long_interactions_are_made_in_pieces_without_a_leap() -> None:
    made = generator()
    lengths = torch.tensor([50, 9])
    white = torch.Generator().manual_seed(0)
    found = made.interactions(torch.tensor([3, 0]), lengths, white)
    assert found.action.shape == found.reaction.shape == (2, 50, 15, 3)
    assert (found.action[1, 9:] == found.action[1, 8]).all()
    whole = generator(replace(SMALL, frames=64)).interactions(
        torch.tensor([3, 0]), torch.tensor([20, 9]), torch.Generator().manual_seed(0)
    )
    torch.testing.assert_close(found.action[:, :12], whole.action[:, :12])  # the first piece


def test_a_piece_goes_on_from_where_the_one_before_was() -> None:
    one = pairs(1)
    stands = Pairs(*(who[:, :1].expand(-1, 30, -1, -1) for who in (one.action, one.reaction)),
                   torch.tensor([30]), one.labels)  # fmt: skip
    pieces: list[int] = []

    def still(noisy: torch.Tensor, *others: torch.Tensor) -> torch.Tensor:
        pieces.append(noisy.shape[2])
        return torch.zeros_like(noisy)  # the mean pose

    made = Generator(still, Normaliser.of(stands), WORDS, 20, 1000, 2)
    found = made.interactions(
        torch.tensor([0]), torch.tensor([45]), torch.Generator().manual_seed(0)
    )
    assert pieces == [20, 20, 20, 20, 20, 20, 9, 9]
    torch.testing.assert_close(found.action, one.action[:, :1].expand(-1, 45, -1, -1))
    torch.testing.assert_close(found.reaction, one.reaction[:, :1].expand(-1, 45, -1, -1))


def test_the_seed_decides() -> None:
    made, labels, lengths = generator(), torch.tensor([1]), torch.tensor([12])
    first, again, other = (
        made.interactions(labels, lengths, torch.Generator().manual_seed(seed)).action
        for seed in (1, 1, 2)
    )
    assert torch.equal(first, again) and not torch.allclose(first, other)


def test_a_short_training_learns_who_stands_where(tmp_path: Path) -> None:
    config = TrainConfig(
        SMALL, "sbu", steps=60, batch=8, learning_rate=5e-3, save_every=30, ema=0.9
    )
    some = pairs(14)

    train_on(config, Run(tmp_path / "whole", config, 0, "train", resume=False), some)
    made = run_generator(tmp_path / "whole", SBU)
    found = made.interactions(some.labels, some.lengths, torch.Generator().manual_seed(0))
    untrained = generator().interactions(
        some.labels, some.lengths, torch.Generator().manual_seed(0)
    )

    def off(these: Pairs) -> float:
        return float((both_of(these)[:, :, 0] - both_of(some)[:, :, 0]).norm(dim=-1).mean())

    assert off(found) < 0.5 * off(untrained)


def test_a_run_that_was_stopped_goes_on_as_if_it_had_not_been() -> None:
    config, some = TrainConfig(SMALL, "sbu", batch=4), pairs(8)
    white = torch.Generator().manual_seed(0)
    whole = Learner(config, some)
    for _ in range(2):
        whole.step(white)
    kept, chance = copy.deepcopy(whole.state()), white.get_state()
    expected = [whole.step(white) for _ in range(2)]
    again, later = Learner(config, some), torch.Generator()
    again.load(kept)
    later.set_state(chance)
    assert [again.step(later) for _ in range(2)] == expected


def test_multimodality_compares_true_pairs_of_a_label() -> None:
    features = np.array([[0.0, 0.0], [3.0, 4.0], [10.0, 0.0], [10.0, 2.0], [7.0, 7.0]])
    labels = torch.tensor([0, 0, 1, 1, 2])
    assert multimodality(features, labels) == pytest.approx((5 + 2) / 2)


def test_copies_are_found_out() -> None:
    some = pairs(10)
    assert nearest_mm(some.take(torch.tensor([3, 1])), some) == pytest.approx(0, abs=1e-3)
    moved = Pairs(some.action + 1.0, some.reaction + 1.0, some.lengths, some.labels)
    assert nearest_mm(moved, some) == pytest.approx(1000 * math.sqrt(3), rel=0.2)


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The bundle of a run of a few updates on a made-up SBU; the run is beside it."""
    torch.set_num_threads(1)
    place = tmp_path_factory.mktemp("made_up")
    groups = ("s01s02", "s02s03", "s01s03")
    rows = [(group, act, 10 + 2 * at) for at, group in enumerate(groups) for act in SBU_NAMES]
    write_sbu(place, "train", rows)
    write_sbu(place, "test", [(f"s0{n}s06", act, 12) for n in (2, 5) for act in SBU_NAMES])
    config = TrainConfig(SMALL, "sbu", steps=6, batch=4, save_every=3)
    train(config, Run(place / "run", config, 0, "python -m models train", resume=False), place)
    with pytest.MonkeyPatch.context() as patch:
        quick = replace(JudgeConfig(), width=32, steps=300, batch=32, learning_rate=5e-3)
        patch.setattr(interaction, "JudgeConfig", lambda: quick)
        patch.setattr("models.evaluation.interaction_pairs.JUDGES", 1)
        patch.setattr("models.evaluation.interaction_pairs.DRAWS", 1)
        folder = place / "bigraphdiff_sbu"
        export_interactions(place / "run", folder, "0.1.0", place, place / "runs")
        yield folder


def test_judges_of_both_people_take_real_ones_for_what_they_are(bundle: Path) -> None:
    court = PairCourt.of(SBU, bundle.parent, bundle.parent / "runs")  # found again
    found = court.setting()
    assert found["real"]["accuracy"] > 0.7
    assert found["copied"]["accuracy"] > 0.7
    assert found["copied"]["nearest_training_mm"] == pytest.approx(0, abs=1e-3)
    swapped = Pairs(court.test.reaction, court.test.action, court.test.lengths, court.test.labels)
    judge = court.judges[0]
    assert judge.people == 2
    assert not torch.equal(judge.sees(swapped), judge.sees(court.test))
    truth = court.measure(lambda labels, lengths, seed: court.test)
    assert truth["accuracy"] == found["real"]["accuracy"]
    others = Pairs(*(who.roll(1, 0) for who in (court.test.action, court.test.reaction)),
                   court.test.lengths, court.test.labels)  # fmt: skip
    assert court.measure(lambda labels, lengths, seed: others)["accuracy"] < 0.4
    assert truth["frechet_distance"] == pytest.approx(0, abs=1e-3)
    assert truth["multimodality_score"] == truth["diversity_score"] == 0


def test_torch_and_onnx_take_the_same_noise_away(bundle: Path) -> None:
    made, normaliser = load_denoiser(bundle.parent / "run")
    round_weights(made)
    exported, manifest = read_generator(bundle)
    for frames in (20, 7):
        noisy, lengths, step, words = given()
        some = noisy[:, :, :frames], lengths.clamp(max=frames), step, words
        with torch.no_grad():
            torch.testing.assert_close(exported.denoise(*some), made(*some), atol=1e-4, rtol=0)
    torch.testing.assert_close(exported.normaliser.mean, normaliser.mean)
    labels, lengths = torch.tensor([3, 1]), torch.tensor([12, 9])
    torch_made = Generator.of(made, normaliser, WORDS, SMALL)
    first, second = (
        interacting(each)(labels, lengths, 0).action for each in (exported, torch_made)
    )
    torch.testing.assert_close(first, second, atol=1e-3, rtol=0)
    assert manifest.lengths["kicking"] == (10, 14)
    assert manifest.drawn_steps <= 50


def test_a_run_becomes_a_bundle_that_is_whole(bundle: Path) -> None:
    manifest = read_manifest(bundle, InteractionManifest)
    assert manifest.licence.startswith("research only")
    card = (bundle / "CARD.md").read_text()
    assert "Research only" in card and "14 test interactions" in card
    with np.load(bundle / GOLDEN_FILE) as golden:
        args = [torch.from_numpy(golden[name]) for name in INPUTS]
        found = open_denoiser(bundle / "model.onnx")(*args)
        np.testing.assert_allclose(found.numpy(), golden["clean"], atol=1e-4)
    whole = bundle / "normaliser.npz"
    kept = whole.read_bytes()
    whole.write_bytes(kept + b"x")
    with pytest.raises(BundleError, match=r"normaliser\.npz was altered"):
        read_generator(bundle)
    whole.write_bytes(kept)


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="heads 7 does not divide"):
        network_for("sbu", heads=7)
    with pytest.raises(ConfigError, match="set diffusion, too"):
        network_for("sbu", diffusion=False)
    with pytest.raises(ConfigError, match="guidance is 2 without diffusion"):
        network_for("sbu", diffusion=False, graph="none", guidance=2.0)
    with pytest.raises(ConfigError, match="set 'ballet' is none of sbu"):
        network_for("ballet")


def test_labels_are_hidden_and_noise_is_high_only_where_draws_are_led(monkeypatch) -> None:
    seen: list[torch.Tensor] = []
    at: list[torch.Tensor] = []
    heard = Denoiser.forward

    def forward(self, noisy, lengths, step, words):
        seen.append(words)
        at.append(step)
        return heard(self, noisy, lengths, step, words)

    monkeypatch.setattr(Denoiser, "forward", forward)
    for row in ("S4", "guided"):
        learner = Learner(ablated(TrainConfig(SMALL, "sbu", batch=64), row), pairs(14))
        learner.step(torch.Generator().manual_seed(0))
    without, led = ((words == 0).all(1).float().mean() for words in seen)
    assert without == 0
    assert 0.05 < led < 0.3
    last = SMALL.steps - SMALL.steps // 5
    without, led = ((step >= last).float().mean() for step in at)
    assert without < 0.35
    assert 0.45 < led < 0.75


def test_long_recordings_fit_the_sets_that_have_them() -> None:
    assert CONFIGS["ntu"].network.frames == 300
    assert CONFIGS["paper_ntu"].network.layers == 8
