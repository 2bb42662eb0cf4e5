import os
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from scipy.io import savemat  # noqa: E402

from agent_server.errors import InvalidInput  # noqa: E402
from models.data.interactions import (  # noqa: E402
    JOINTS,
    K3HI,
    SBU,
    SBU_FOLDS,
    TORSO,
    Interaction,
    PairFrame,
    Pairs,
    facing,
    held_out,
    vary,
)
from models.data.layouts import KINECT15  # noqa: E402
from tests.support.interactions import interactions, write_sbu  # noqa: E402


def test_a_split_is_read_in_metres_with_y_up(tmp_path: Path) -> None:
    (one,) = write_sbu(tmp_path, "train", [("s01s02", "03", 12)])
    (read,) = SBU.read(tmp_path, "train")
    assert (read.name, read.group, read.label) == ("s01s02/03/001", "s01s02", "kicking")
    np.testing.assert_allclose(read.action, one.action, atol=1e-5)
    np.testing.assert_allclose(read.reaction, one.reaction, atol=1e-5)
    assert (read.action[:, 0, 1] > read.action[:, TORSO, 1]).all()  # the head is above


def test_walking_away_is_walking(tmp_path: Path) -> None:
    write_sbu(tmp_path, "test", [("s01s02", "01", 12), ("s01s02", "02", 12)])
    assert {one.label for one in SBU.read(tmp_path, "test")} == {"walking"}


def test_a_missing_list_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"Test\.txt is missing: give as --data"):
        K3HI.read(tmp_path, "test")


def test_people_with_unequal_frames_are_refused(tmp_path: Path) -> None:
    write_sbu(tmp_path, "train", [("s01s02", "03", 12)])
    folder = tmp_path / SBU.folder / "Skeletons_Check/s01s02/03/001"
    savemat(folder / "skeleton_B.mat", {"curve_B": np.zeros((45, 11))})
    with pytest.raises(InvalidInput, match="12 frames and"):
        SBU.read(tmp_path, "train")


def test_a_body_of_another_shape_is_refused(tmp_path: Path) -> None:
    write_sbu(tmp_path, "train", [("s01s02", "03", 12)])
    folder = tmp_path / SBU.folder / "Skeletons_Check/s01s02/03/001"
    savemat(folder / "skeleton_A.mat", {"curve_B": np.zeros((27, 12))})
    with pytest.raises(InvalidInput, match=r"45 rows .* found 27x12"):
        SBU.read(tmp_path, "train")


def test_the_pair_looks_along_x_and_a_frame_undoes_itself() -> None:
    one = interactions(1)[0]
    action, reaction = facing(one)
    apart = reaction[0, TORSO] - action[0, TORSO]
    assert apart[0] > 0 and abs(float(apart[2])) < 1e-5
    torch.testing.assert_close(action[0, TORSO] + reaction[0, TORSO], torch.zeros(3))
    frame = PairFrame.of(torch.from_numpy(one.action[0]), torch.from_numpy(one.reaction[0]))
    whole = torch.from_numpy(one.reaction)
    torch.testing.assert_close(frame.back(frame.into(whole)), whole)
    torch.testing.assert_close(torch.linalg.det(frame.turn), torch.tensor(1.0))


def test_where_the_room_is_turned_the_pair_is_not() -> None:
    one = interactions(1)[0]
    turn = np.array([[0.6, 0, -0.8], [0, 1, 0], [0.8, 0, 0.6]], np.float32)
    shift = np.array([1, 2, 3], np.float32)
    moved = Interaction(
        one.name, one.group, one.label, one.action @ turn + shift, one.reaction @ turn + shift
    )
    for first, second in zip(facing(one), facing(moved), strict=True):
        torch.testing.assert_close(first, second, atol=1e-5, rtol=0)


def test_padding_repeats_the_last_frame_and_masks_tell() -> None:
    pairs = Pairs.of(interactions(5), SBU.labels)
    for row, length in enumerate(pairs.lengths.tolist()):
        assert (pairs.reaction[row, length:] == pairs.reaction[row, length - 1]).all()
        assert pairs.mask[row].tolist() == [at < length for at in range(pairs.mask.shape[1])]


def test_batches_have_one_length_and_all_interactions_are_drawn() -> None:
    pairs = Pairs.of(interactions(8), SBU.labels)
    generator = torch.Generator().manual_seed(0)
    seen = set()
    for _ in range(60):
        batch = pairs.draw(3, generator)
        assert batch.reaction.shape[1] == int(batch.lengths.max())
        seen |= set(batch.lengths.tolist())
    assert seen == set(pairs.lengths.tolist())


def test_variation_keeps_bodies_and_who_faces_whom() -> None:
    pairs = Pairs.of(interactions(8), SBU.labels)
    swap = torch.ones(len(SBU.labels), dtype=torch.bool)
    varied = vary(pairs, torch.Generator().manual_seed(0), scale=0.0, swap=swap)
    assert not torch.equal(varied.action, pairs.action)
    apart = varied.reaction[:, 0, TORSO] - varied.action[:, 0, TORSO]
    assert (apart[:, 0] > 0).all()
    left = varied.action[:, 0, 3] - varied.action[:, 0, 6]
    assert (left[:, 2] < 0).all()  # whoever looks along x has the left shoulder at -z
    bones = torch.tensor(KINECT15.bones)

    def lengths(x: torch.Tensor) -> torch.Tensor:
        return (x[:, :, bones[:, 0]] - x[:, :, bones[:, 1]]).norm(dim=-1).sum(dim=(1, 2))

    both = lengths(pairs.action) + lengths(pairs.reaction)
    torch.testing.assert_close(lengths(varied.action) + lengths(varied.reaction), both)


def test_people_change_places_only_where_they_may() -> None:
    pairs = Pairs.of(interactions(8), SBU.labels)
    never = torch.zeros(len(SBU.labels), dtype=torch.bool)
    torch.testing.assert_close(
        vary(pairs, torch.Generator().manual_seed(3), swap=never).action,
        vary(pairs, torch.Generator().manual_seed(3), swap=never).action,
    )
    still = vary(pairs, torch.Generator().manual_seed(3), scale=0.0, swap=never)
    heights = pairs.action[:, :, 0, 1]
    torch.testing.assert_close(still.action[:, :, 0, 1], heights)


def test_folds_hold_out_whole_pairs_of_people() -> None:
    everybody = interactions(8)
    others, held = held_out(everybody, SBU_FOLDS[0])
    assert {one.group for one in held} <= set(SBU_FOLDS[0])
    assert len(others) + len(held) == len(everybody)
    assert not {one.group for one in others} & set(SBU_FOLDS[0])
    assert sum(map(len, SBU_FOLDS)) == len({name for fold in SBU_FOLDS for name in fold}) == 21


def test_the_real_splits() -> None:
    folder = os.environ.get("AGENT_SERVER_DATA")
    if folder is None or not (Path(folder) / "k3hi").exists():
        pytest.skip("AGENT_SERVER_DATA has no sbu and k3hi")
    data = Path(folder)
    for spec, train, test in ((SBU, 195, 30), (K3HI, 236, 28)):
        assert len(spec.read(data, "train")) == train
        held = spec.read(data, "test")
        assert len(held) == test
        assert {one.label for one in held} == set(spec.labels)
        pairs = Pairs.of(held, spec.labels)
        left = pairs.action[:, 0, 3] - pairs.action[:, 0, 6]
        kicking = pairs.labels == spec.labels.index("kicking")
        assert (left[kicking, 2] < 0).all()  # people face each other
        assert pairs.reaction.shape[2] == JOINTS
