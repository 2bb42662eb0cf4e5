import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from models.data.interactions import SBU, Pairs  # noqa: E402
from models.evaluation.reaction_quality import quality_report  # noqa: E402
from models.interformer.quality.counterfeits import COUNTERFEITS, moves  # noqa: E402
from models.interformer.quality.network import Quality, QualityStep  # noqa: E402
from models.interformer.quality.train import train_quality  # noqa: E402
from tests.support.interactions import interactions  # noqa: E402


@pytest.fixture(scope="module")
def pairs() -> Pairs:
    torch.set_num_threads(1)
    return Pairs.of(interactions(28), SBU.labels)


def chance() -> torch.Generator:
    return torch.Generator().manual_seed(0)


@pytest.mark.parametrize("name", COUNTERFEITS)
def test_a_counterfeit_is_another_motion_of_the_same_form(name: str, pairs: Pairs) -> None:
    made = COUNTERFEITS[name](pairs, pairs, chance())
    assert made.shape == pairs.reaction.shape
    assert bool(made.isfinite().all())
    apart = (made - pairs.reaction).norm(dim=-1).amax((1, 2))
    assert float((apart[moves(pairs)] > 0.01).float().mean()) > 0.9
    assert torch.equal(made, COUNTERFEITS[name](pairs, pairs, chance()))


def test_what_is_borrowed_belongs_to_another_kind_of_action(pairs: Pairs) -> None:
    # Each reaction drifts by its label, so that a borrowed one tells whose it is.
    drift = torch.linspace(0, 1, pairs.reaction.shape[1])[:, None, None]
    marked = pairs.reaction[:, :1] + drift * pairs.labels[:, None, None, None]
    those = pairs.with_reactions(marked, pairs.lengths)
    made = COUNTERFEITS["of_another"](those, those, chance())
    lender = (made - made[:, :1])[:, -1, 0, 0].round().long()
    assert bool((lender != pairs.labels).all())


def test_a_step_at_a_time_says_what_the_whole_does(pairs: Pairs) -> None:
    network = Quality(width=16).eval()
    step = QualityStep(network)
    with torch.no_grad():
        whole = network(pairs.action, pairs.reaction)
        both = torch.cat([pairs.action, pairs.reaction], dim=2)
        hidden, before, found = torch.zeros(len(pairs), 16), both[:, 0], []
        for pair in both.unbind(1):
            logits, hidden = step(both[:, 0], before, pair, hidden)
            before = pair
            found.append(logits)
    torch.testing.assert_close(torch.stack(found, dim=1), whole, atol=1e-5, rtol=0)


def test_no_frame_hangs_on_what_comes_after_it(pairs: Pairs) -> None:
    network = Quality(width=16).eval()
    with torch.no_grad():
        whole = network(pairs.action, pairs.reaction)
        head = network(pairs.action[:, :6], pairs.reaction[:, :6])
    torch.testing.assert_close(head, whole[:, :6], atol=1e-6, rtol=0)


def test_it_learns_to_tell_recorded_reactions_from_none(pairs: Pairs) -> None:
    test = Pairs.of(interactions(49)[28:], SBU.labels)
    network = train_quality(SBU, pairs, seed=0, steps=120)
    still = test.reaction[:, :1].expand_as(test.reaction)
    report = quality_report(network, test, {"zero_velocity": still})
    assert report["auc"]["still"] > 0.8
    assert report["auc"]["trembling"] > 0.8
    assert report["passes"]["recorded"] > report["passes"]["zero_velocity"] + 0.3
    again = train_quality(SBU, pairs, seed=0, steps=2)
    for one, other in zip(
        again.parameters(), train_quality(SBU, pairs, seed=0, steps=2).parameters(), strict=True
    ):
        assert torch.equal(one, other)
