"""A share of what tests/bench does to recordings: servers are killed, files are damaged."""

from tests.support.damage import Trial
from tests.support.kills import kill_often
from tests.support.recordings import write_session


async def test_a_server_that_is_killed_leaves_all_but_the_last_second():
    kills = await kill_often(20, seed=1, life_s=(0.1, 1.2))
    assert kills.kills == len(kills.lost_s) == 20
    assert kills.unreadable == kills.wrong == []
    assert max(kills.lost_s) <= 1.0
    assert kills.frames > 100


def test_files_that_were_cut_or_flipped_give_no_wrong_record(tmp_path):
    trial = Trial(write_session(tmp_path / "whole.mcap", seconds=6), tmp_path, seed=2)
    for _ in range(60):
        trial.cut_or_flip()
    assert trial.damage.faults == []
    assert trial.damage.refused > 40
    assert trial.damage.lost_records > 0


def test_a_million_mutated_bytes_are_refused_with_a_sentence(tmp_path):
    trial = Trial(write_session(tmp_path / "whole.mcap", seconds=6), tmp_path, seed=3)
    while trial.damage.damaged_bytes < 1_000_000:
        trial.mutate()
    assert trial.damage.faults == []
    assert trial.damage.refused > 10
