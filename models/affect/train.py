"""Training an affect model, and measuring by cross-validation what it can do.

Everything is chosen by cross-validation among the training faces. The models that ship are then
trained on all of them, for as long as the validated ones were.
"""

import time
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from agent_server.domain.arrays import Float32
from models.affect.config import AffectConfig
from models.affect.data import FaceFeatures
from models.affect.network import TARGETS, AffectNetwork
from models.affect.views import PLAIN

SPREAD_WEIGHT = 0.1
RIDGE = 0.003
"""Of the linear part, on standardised features, for each sample."""
SMALLEST = 0.1
"""Of the features' median deviation: what is added to each, for those that hardly vary."""


@dataclass(frozen=True, slots=True)
class Validated:
    """Estimates for faces that the networks had not seen.

    Attributes:
        estimates: Shape (N, 4): valence, arousal and their standard deviations.
        affect: Shape (N, 2): the labels.
    """

    estimates: Float32
    affect: Float32

    @property
    def gain(self) -> Float32:
        """What estimates ought to be multiplied by to vary as the labels do.

        Estimates under squared error shrink towards the middle; half of that is taken back,
        which costs no accuracy and brings uncomfortable faces over the gate's thresholds.
        """
        ratio = self.affect.std(axis=0) / self.estimates[:, :TARGETS].std(axis=0)
        gain: Float32 = ((1 + ratio) / 2).astype(np.float32)
        return gain

    @property
    def widening(self) -> Float32:
        """What standard deviations must be multiplied by to fit the errors."""
        errors = (self.estimates[:, :TARGETS] - self.affect) / self.estimates[:, TARGETS:]
        widening: Float32 = np.sqrt(np.square(errors).mean(axis=0)).astype(np.float32)
        return widening


def train(config: AffectConfig, faces: FaceFeatures, seed: int) -> AffectNetwork:
    """Train a network on all of ``faces``."""
    torch.manual_seed(seed)
    features, affect = _samples(config, faces)
    mirror = faces.mirror
    size = features.shape[1]
    network = AffectNetwork(config, size, mirror.order.tolist(), mirror.signs.tolist())
    # A shape that hardly ever shows must not be blown up.
    smallest = SMALLEST * float(features.std(0).median())
    network.centre, network.scale = features.mean(0), 1 / (features.std(0) + smallest)
    given = network.standardise(features)
    if config.linear:
        network.slope, network.level = _ridge(given, affect)
    steps = max(1, config.epochs * len(given) // config.batch)
    optimiser = torch.optim.AdamW(
        network.members.parameters(), config.rate, weight_decay=config.weight_decay
    )
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, config.rate, total_steps=steps)
    network.train()
    for _ in range(steps):
        batch, target = _batch(config, given, affect)
        means, logs = network.members(batch)
        loss = _loss(means, logs, target)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    return network.eval()


def cross_validate(config: AffectConfig, faces: FaceFeatures, folds: int, seed: int) -> Validated:
    """Estimates for each face by networks that were trained without the person."""
    estimates = np.zeros((len(faces.affect), 2 * TARGETS), np.float32)
    for index, (train_on, test_on) in enumerate(faces.folds(folds, seed)):
        network = train(config, faces.take(train_on), seed + index)
        estimates[test_on] = estimate(network, faces.features[test_on, PLAIN])
    seen = faces.found[:, PLAIN]
    return Validated(estimates[seen], faces.affect[seen])


def estimate(network: AffectNetwork, features: Float32) -> Float32:
    """Valence, arousal and their standard deviations of each row."""
    with torch.no_grad():
        result: Float32 = network(torch.from_numpy(features)).numpy()
    return result


def train_and_calibrate(
    config: AffectConfig, faces: FaceFeatures, folds: int, seed: int
) -> tuple[AffectNetwork, Validated, float]:
    """The network for a bundle, what cross-validation says of it, and the seconds it took."""
    began = time.monotonic()
    validated = cross_validate(config, faces, folds, seed)
    network = train(config, faces, seed)
    network.gain = torch.from_numpy(validated.gain)
    scaled = Validated(
        np.concatenate(
            (
                (validated.estimates[:, :TARGETS] * validated.gain).clip(-1, 1),
                validated.estimates[:, TARGETS:],
            ),
            axis=1,
        ),
        validated.affect,
    )
    network.widening = torch.from_numpy(scaled.widening)
    final = scaled.estimates.copy()
    final[:, TARGETS:] *= scaled.widening
    return network, Validated(final, scaled.affect), time.monotonic() - began


def _samples(config: AffectConfig, faces: FaceFeatures) -> tuple[Tensor, Tensor]:
    """Every view that shows a face, with the label of its picture."""
    found = faces.found if config.varied else faces.found & (np.arange(faces.found.shape[1]) == 0)
    labels = np.repeat(faces.affect[:, None], faces.found.shape[1], axis=1)
    return torch.from_numpy(faces.features[found]), torch.from_numpy(labels[found])


def _ridge(given: Tensor, affect: Tensor) -> tuple[Tensor, Tensor]:
    """Slope (D, 2) and level (2,) of a ridge regression; the level is not shrunk."""
    values, targets = given.double(), affect.double()
    centre, level = values.mean(0), targets.mean(0)
    apart = values - centre
    penalty = RIDGE * len(values) * torch.eye(values.shape[1], dtype=torch.float64)
    slope = torch.linalg.solve(apart.T @ apart + penalty, apart.T @ (targets - level))
    return slope.float(), (level - centre @ slope).float()


def _batch(config: AffectConfig, given: Tensor, affect: Tensor) -> tuple[Tensor, Tensor]:
    """A batch for each member: noisy faces, or two mixed (Zhang et al. 2018)."""
    chosen = torch.randint(len(given), (config.members, config.batch))
    batch, target = given[chosen], affect[chosen]
    if config.mixup:
        share = torch.distributions.Beta(config.mixup, config.mixup).sample(
            (config.members, config.batch, 1)
        )
        other = torch.randint(len(given), (config.members, config.batch))
        batch = share * batch + (1 - share) * given[other]
        target = share * target + (1 - share) * affect[other]
    return batch + config.noise * torch.randn_like(batch), target


def _loss(means: Tensor, logs: Tensor, target: Tensor) -> Tensor:
    """Squared error of the estimates, and likelihood of the errors under their deviations."""
    errors = means - target
    likelihood = logs + 0.5 * errors.detach().square() * (-2 * logs).exp()
    return errors.square().sum(2).mean(1).sum() + SPREAD_WEIGHT * likelihood.sum(2).mean(1).sum()
