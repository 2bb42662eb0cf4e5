from dataclasses import replace
from pathlib import Path

import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES  # noqa: E402
from agent_server.domain.skeleton import CORE_BONES, CoreJoint  # noqa: E402
from agent_server.errors import ConfigError, InvalidInput  # noqa: E402
from models.data.windows import Augmentation, WindowSet  # noqa: E402
from models.interformer.config import NetworkConfig, TrainConfig  # noqa: E402
from models.interformer.network import (  # noqa: E402
    Calibrated,
    Classifier,
    SpatialAttention,
    adjacency,
)
from models.interformer.train import (  # noqa: E402
    ClassifierLearner,
    Pools,
    Trainer,
    completed,
    hold_last,
    load_classifier,
    mixing_shares,
    train,
)
from models.training.run import Run  # noqa: E402

SMALL = NetworkConfig(layers=1, features=4, dropout=0.0)
CPU = torch.device("cpu")


def labelled(repeats: int = 8) -> WindowSet:
    """Windows in which the right hand is as high as the class says."""
    count = len(GESTURES) * repeats
    labels = torch.arange(len(GESTURES)).repeat(repeats)
    frames = torch.zeros(count, 75, 9, 3)
    frames[:, :, CoreJoint.RIGHT_SHOULDER, 0] = 0.2
    frames[:, :, CoreJoint.LEFT_SHOULDER, 0] = -0.2
    frames[:, :, CoreJoint.RIGHT_WRIST, 1] = labels[:, None] * 0.15 - 0.4
    frames += torch.randn(frames.shape, generator=torch.Generator().manual_seed(0)) * 0.01
    flat = frames.reshape(-1, 9, 3)
    starts = torch.arange(count) * 75
    return WindowSet(flat, flat, starts, labels, labels, GESTURES)


def test_the_mask_is_self_and_neighbours() -> None:
    mask = adjacency()
    assert mask.diagonal().all()
    assert torch.equal(mask, mask.T)
    assert int(mask.sum()) == 9 + 2 * len(CORE_BONES)
    assert mask[CoreJoint.LEFT_ELBOW, CoreJoint.LEFT_WRIST]
    assert not mask[CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]


def test_a_joint_sees_its_neighbours_only_and_its_coordinate_only() -> None:
    torch.manual_seed(0)
    attention = SpatialAttention(SMALL)
    attention.out = torch.nn.Identity()  # type: ignore[assignment]
    x = torch.randn(1, 2, 3, 9, 4)
    changed = x.clone()
    changed[:, :, 1, CoreJoint.LEFT_WRIST] += 1.0  # its y
    before, after = (attention(v.flatten(2)).reshape(1, 2, 3, 9, 4) for v in (x, changed))
    moved = (before != after).any(-1).any(1)[0]  # (3, 9)
    expected = torch.zeros(3, 9, dtype=torch.bool)
    expected[1, [CoreJoint.LEFT_WRIST, CoreJoint.LEFT_ELBOW]] = True
    assert torch.equal(moved, expected)


def test_shapes_and_probabilities() -> None:
    network = Calibrated(Classifier(SMALL), 1.7).eval()
    rows = network(torch.randn(3, 75, 9, 3) * 0.3)
    assert rows.shape == (3, 7)
    torch.testing.assert_close(rows.sum(-1), torch.ones(3))
    sharp = Calibrated(network.classifier, 0.5).eval()(torch.randn(3, 75, 9, 3) * 0.3)
    assert torch.isfinite(sharp).all()


def test_classes_are_drawn_in_the_shares_asked_for() -> None:
    windows = labelled()
    pools = Pools.of(windows, windows.labels)
    index = pools.draw(2000, 0.5, torch.Generator().manual_seed(0))
    shares = torch.bincount(windows.labels[index]) / 2000
    assert float(shares[-1]) == pytest.approx(0.5, abs=0.04)
    assert float(shares[:-1].max()) < 0.12


def test_a_missing_class_is_named() -> None:
    windows = labelled()
    with pytest.raises(InvalidInput, match="hello"):
        some = windows.take((windows.labels != GESTURES.index("hello")).nonzero()[:, 0])
        Pools.of(some, some.labels)


def test_true_futures_come_with_the_label_of_the_whole_window(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    windows = labelled()
    whole = (windows.labels + 1) % len(GESTURES)
    shown: list[tuple[torch.Tensor, torch.Tensor]] = []
    monkeypatch.setattr(
        Trainer, "step", lambda self, motion, labels, generator: shown.append((motion, labels))
    )
    nothing = Augmentation(yaw=0.0, scale=0.0, noise_m=0.0, drop=0.0)
    config = TrainConfig(
        network=SMALL, batch=20, true_future=0.25, last_frame=0.5, augmentation=nothing
    )

    class Zero(torch.nn.Module):
        def forward(self, seen: torch.Tensor) -> torch.Tensor:
            return torch.full((len(seen), 50, 9, 3), 7.0)

    learner = ClassifierLearner(config, replace(windows, whole=whole), windows, Zero())
    for seed in range(20):
        learner.step(torch.Generator().manual_seed(seed))
    wrists = [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]  # some windows are mirrored
    heights = torch.cat([motion[:, 0, wrists, 1].sum(-1) for motion, _ in shown])
    labels = torch.cat([each for _, each in shown])
    future = torch.cat([motion[:, 25:] for motion, _ in shown])
    predicted = (future == 7.0).all(-1).all(-1).all(-1)
    true = torch.arange(400) % 20 < 5
    seen_label = ((heights + 0.4) / 0.15).abs().round().long()
    assert torch.equal(labels[~true], seen_label[~true])
    assert torch.equal(labels[true], (seen_label[true] + 1) % len(GESTURES))
    assert not predicted[true].any()
    assert float(predicted[~true].float().mean()) == pytest.approx(0.5, abs=0.1)


def test_rows_get_the_futures_and_the_frames_that_they_ask_for() -> None:
    observed = torch.randn(5, 75, 9, 3)

    def zero(seen: torch.Tensor) -> torch.Tensor:
        return torch.zeros(len(seen), 50, 9, 3)

    assert torch.equal(completed(zero, observed, TrainConfig(futures="true")), observed)
    held = completed(zero, observed, TrainConfig(futures="held"))
    assert torch.equal(held[:, 25:], hold_last(observed[:, :25]))
    assert not completed(zero, observed, TrainConfig())[:, 25:].any()
    short = TrainConfig(futures="held", network=NetworkConfig(frames=25))
    assert torch.equal(completed(zero, observed, short), observed[:, :25])
    assert Classifier(short.network)(observed[:, :25]).shape == (5, 7)


def test_a_few_windows_are_learnt_by_heart() -> None:
    windows = labelled()
    torch.manual_seed(0)
    trainer = Trainer(TrainConfig(network=SMALL, steps=250, learning_rate=3e-3), CPU)
    motion = windows.frames(torch.arange(len(windows)))[0]
    for _ in range(60):
        terms = trainer.step(motion, windows.labels, torch.Generator())
    assert terms["accuracy"] > 0.9


def test_windows_are_mixed_by_the_larger_half_of_a_beta_distribution() -> None:
    generator = torch.Generator().manual_seed(0)
    shares = mixing_shares(4000, 0.3, generator)
    assert 0.5 <= float(shares.min()) < 0.55
    assert float(shares.max()) == pytest.approx(1.0, abs=1e-3)
    assert float(shares.mean()) == pytest.approx(0.866, abs=0.02)
    assert not torch.equal(shares, mixing_shares(4000, 0.3, generator))
    trainer = Trainer(TrainConfig(network=SMALL, mixup=0.3), CPU)
    windows = labelled(2)
    motion = windows.all()
    assert trainer.step(motion, windows.labels, generator)["loss"] > 0


def test_a_run_leaves_a_classifier_that_can_be_loaded(tmp_path: Path) -> None:
    windows = labelled()
    config = TrainConfig(network=SMALL, steps=4, batch=16, validate_every=2)
    predictor = torch.nn.Module()
    predictor.forward = hold_last  # type: ignore[assignment]
    for name in ("a", "b"):
        run = Run(tmp_path / name, config, 3, "train", resume=False)
        train(config, run, windows, windows, predictor)
    a, b = (load_classifier(tmp_path / name).state_dict() for name in ("a", "b"))
    assert all(torch.equal(a[key], b[key]) for key in a)


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="patch 4"):
        NetworkConfig(patch=4)
    with pytest.raises(ConfigError, match="heads 5"):
        NetworkConfig(heads=5)
    with pytest.raises(ConfigError, match=r"true_future is 1\.2"):
        TrainConfig(true_future=1.2)
