import math

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES, IDLE  # noqa: E402
from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from agent_server.errors import InvalidInput  # noqa: E402
from models.data.windows import (  # noqa: E402
    AMBIGUOUS,
    TRAINED,
    Augmentation,
    Recording,
    Stretch,
    augment,
    cut,
    join,
    whole_labels,
    window_labels,
)

NOTHING = Augmentation(yaw=0.0, scale=0.0, noise_m=0.0, drop=0.0)


def take(frames: int = 120, gesture: str | None = "cold", seed: int = 0) -> Recording:
    rng = np.random.default_rng(seed)
    motion = rng.standard_normal((frames, 9, 3)).astype(np.float32)
    stretches = None if gesture is None else (Stretch(gesture, 40, 90),)
    return Recording(motion, motion + 0.01, stretches, "v00")


def test_labels_follow_onset_and_offset() -> None:
    last = np.array([39, 40, 47, 48, 80, 81, 89, 90])
    labels = window_labels([Stretch("hello", 40, 90)], GESTURES, last)
    hello, idle = GESTURES.index("hello"), GESTURES.index(IDLE)
    assert labels.tolist() == [
        idle, AMBIGUOUS, AMBIGUOUS, hello, hello, AMBIGUOUS, AMBIGUOUS, idle,
    ]  # fmt: skip


def test_unknown_recordings_have_no_label_and_idle_ones_only_idle() -> None:
    last = np.arange(100)
    assert set(window_labels(None, GESTURES, last)) == {AMBIGUOUS}
    assert set(window_labels([], GESTURES, last)) == {GESTURES.index(IDLE)}


def test_a_recording_may_show_several_gestures() -> None:
    stretches = [Stretch("wink", 10, 40), Stretch("bow", 60, 90)]
    labels = window_labels(stretches, ("bow", "wink", IDLE), np.array([5, 20, 50, 70, 95]))
    assert labels.tolist() == [2, 1, 2, 0, 2]


def test_a_whole_window_also_shows_what_begins_in_its_future() -> None:
    cold = GESTURES.index("cold")
    last = np.array([0, 49, 50, 69, 70, 100, 140, 141, 149, 150])
    stretches = [Stretch("cold", 100, 150)]
    idle = GESTURES.index(IDLE)
    expected = [idle, idle, AMBIGUOUS, AMBIGUOUS, cold, cold, cold, AMBIGUOUS, AMBIGUOUS, idle]
    assert whole_labels(stretches, GESTURES, last).tolist() == expected
    assert set(whole_labels(None, GESTURES, last)) == {AMBIGUOUS}


def test_windows_are_judged_where_the_seen_second_says_it_all() -> None:
    windows = cut([take(200)])
    judged = windows.judged()
    last = judged.starts + 24
    cold = judged.labels == GESTURES.index("cold")
    assert int(last[cold].min()) == 48
    assert int(last[~cold].min()) == 90
    early = cut([take(200)], margins=TRAINED)
    assert int((early.starts[early.labels == GESTURES.index("cold")] + 24).min()) == 44


def test_windows_are_normalised_at_the_last_seen_navel() -> None:
    windows = cut([take(), take(seed=1)])
    assert len(windows) == 2 * (120 - 75 + 1)
    observed, clean = windows.frames(torch.tensor([0, 50]))
    assert torch.equal(observed[:, 24, CoreJoint.NAVEL], torch.zeros(2, 3))
    torch.testing.assert_close(clean - observed, torch.full_like(clean, 0.01), atol=1e-5, rtol=0)


def test_no_window_crosses_from_one_recording_into_the_next() -> None:
    first, second = take(80), take(80, seed=1)
    windows = cut([first, second])
    starts = windows.starts.tolist()
    assert starts == [*range(6), *range(80, 86)]


def test_joined_sets_keep_their_windows() -> None:
    a, b = cut([take()]), cut([take(seed=1)])
    both = join([a, b])
    expected, _ = b.frames(torch.tensor([3]))
    got, _ = both.frames(torch.tensor([len(a) + 3]))
    assert torch.equal(got, expected)
    assert both.classes == GESTURES


def test_too_short_recordings_are_refused() -> None:
    with pytest.raises(InvalidInput, match="75 frames"):
        cut([take(74)])


def test_augmentation_without_size_only_mirrors() -> None:
    observed, clean = cut([take()]).frames(torch.arange(40))
    got, _ = augment(observed, clean, NOTHING, torch.Generator().manual_seed(1))
    same = (got == observed).flatten(1).all(1)
    assert 0 < int(same.sum()) < 40
    other = got[~same]
    source = observed[~same]
    torch.testing.assert_close(
        other[:, :, CoreJoint.LEFT_WRIST],
        source[:, :, CoreJoint.RIGHT_WRIST] * torch.tensor([-1.0, 1.0, 1.0]),
    )


def test_augmentation_keeps_bones_and_touches_only_seen_frames_with_noise() -> None:
    observed, clean = cut([take()]).frames(torch.arange(16))
    turned = Augmentation(yaw=math.pi / 4, scale=0.0, noise_m=0.0, drop=0.0)
    got, _ = augment(observed.clone(), clean, turned, torch.Generator().manual_seed(1))
    torch.testing.assert_close(
        got.norm(dim=-1).sum(2), observed.norm(dim=-1).sum(2), atol=1e-4, rtol=1e-4
    )
    noisy = Augmentation(yaw=0.0, scale=0.0, noise_m=0.05, drop=0.5)
    _, still_clean = augment(observed.clone(), clean, noisy, torch.Generator().manual_seed(1))
    _, plain = augment(observed.clone(), clean, NOTHING, torch.Generator().manual_seed(1))
    moved = (still_clean - plain).flatten(1, 2)  # the origin moves with the noise, nothing else
    assert float((moved - moved[:, :1]).abs().max()) < 1e-5


def test_a_held_joint_stays_where_it_was() -> None:
    observed, clean = cut([take()]).frames(torch.arange(8))
    hold = Augmentation(yaw=0.0, scale=0.0, noise_m=0.0, drop=1.0)
    got, _ = augment(observed, clean, hold, torch.Generator().manual_seed(2))
    steps = got[:, 1:25, CoreJoint.LEFT_WRIST] - got[:, :24, CoreJoint.LEFT_WRIST]
    assert ((steps == 0).all(-1).sum(1) > 0).all()
    torso = got[:, 1:25, CoreJoint.NECK] - got[:, :24, CoreJoint.NECK]
    assert not (torso == 0).all(-1).any()


def test_augmentation_is_seeded() -> None:
    observed, clean = cut([take()]).frames(torch.arange(8))
    how = Augmentation(yaw=0.5, scale=0.1, noise_m=0.02, drop=0.3)
    a = augment(observed.clone(), clean, how, torch.Generator().manual_seed(5))[0]
    b = augment(observed.clone(), clean, how, torch.Generator().manual_seed(5))[0]
    assert torch.equal(a, b)
