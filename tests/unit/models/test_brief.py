"""Short trainings: they learn, the same seed gives the same weights, other chance goes on."""

import pytest

torch = pytest.importorskip("torch")

from torch import nn  # noqa: E402

from models.training.brief import train_briefly  # noqa: E402


def fitted(seed=0, steps=200):
    def loss(network, generator):
        x = torch.randn(16, 2, generator=generator)
        return (network(x)[:, 0] - (x[:, 0] - 2 * x[:, 1])).square().mean()

    return train_briefly(
        lambda: nn.Linear(2, 1),
        loss,
        seed,
        steps=steps,
        learning_rate=0.1,
        weight_decay=0.0,
        warm=10,
    )


def test_it_learns_and_gives_the_network_as_it_is_evaluated():
    network = fitted()
    assert not network.training
    torch.testing.assert_close(network.weight, torch.tensor([[1.0, -2.0]]), rtol=0.0, atol=0.01)


def test_the_seed_alone_decides_and_nobody_elses_chance_is_touched():
    torch.manual_seed(5)
    expected = torch.rand(3)
    torch.manual_seed(5)
    first, other = fitted(seed=1, steps=3), fitted(seed=2, steps=3)
    torch.testing.assert_close(torch.rand(3), expected, rtol=0.0, atol=0.0)
    again = fitted(seed=1, steps=3)
    torch.testing.assert_close(first.weight, again.weight, rtol=0.0, atol=0.0)
    assert not torch.equal(first.weight, other.weight)
