"""What is remembered of sessions: over kills, full disks and large files."""

import pytest

from agent_server.domain.command import Command, Step
from agent_server.domain.scene import AgentMode, RoomState
from agent_server.errors import ConfigError
from agent_server.service import store as stores
from agent_server.service.store import FolderStore, MemoryStore, Saved

COMMAND = Command("s/c1", 1, "greet", "hello", (Step("wave", None, 1.0),), 5, None, 3, 4, 3000)


def saved(sequence=1, session="s", ledger="l"):
    room = RoomState(
        mode=AgentMode.REACTING,
        objects={"window": "open"},
        sequence=sequence,
        now_ns=7,
        gesture_ns=6,
        attending_ns=5,
        has_renderer=True,
        command=COMMAND,
        is_started=True,
        heard_ns=7,
    )
    return Saved(session, ledger, 1_000, room)


@pytest.fixture
def stores_at():
    """Makes stores of a folder, and closes what they have opened."""
    made = []

    def make(folder):
        made.append(FolderStore(folder, 0))
        return made[-1]

    yield make
    for store in made:
        for session in ("s", "Lab"):
            store.release(session)


@pytest.fixture
def folder(tmp_path, stores_at):
    return stores_at(tmp_path / "state")


@pytest.mark.parametrize("kind", ["memory", "folder"])
def test_the_last_state_is_remembered_until_it_is_forgotten(kind, tmp_path):
    store = MemoryStore() if kind == "memory" else FolderStore(tmp_path, 0)
    assert store.load("s") is None
    for sequence in (1, 2):
        store.save(saved(sequence))
    assert store.load("s") == saved(2)
    store.release("s")
    assert store.load("s") == saved(2)
    assert store.load("t") is None
    store.forget("s")
    assert store.load("s") is None


def test_another_process_reads_what_a_killed_one_has_written(folder, tmp_path):
    folder.save(saved(3))
    assert FolderStore(tmp_path / "state", 0).load("s") == saved(3)


@pytest.mark.parametrize("cut", range(1, 60, 7))
def test_a_state_that_was_cut_off_leaves_the_one_before_and_takes_more_after_it(
    folder, tmp_path, stores_at, cut
):
    folder.save(saved(1))
    folder.save(saved(2))
    folder.release("s")
    path = tmp_path / "state" / "s.session.jsonl"
    path.write_bytes(path.read_bytes()[:-cut])
    again = stores_at(tmp_path / "state")
    # One byte less is only the end of the line.
    assert again.load("s") == saved(2 if cut == 1 else 1)
    again.save(saved(3))
    assert again.load("s") == saved(3)


def test_a_file_does_not_grow_without_bound(folder, tmp_path, monkeypatch):
    monkeypatch.setattr(stores, "LARGEST_BYTES", 4096)
    for sequence in range(100):
        folder.save(saved(sequence))
        assert folder.load("s") == saved(sequence)
    assert (tmp_path / "state" / "s.session.jsonl").stat().st_size < 2 * 4096


def test_names_that_one_disk_takes_for_the_same_are_kept_apart(folder, tmp_path):
    folder.save(saved(1, "Lab"))
    folder.release("Lab")
    (tmp_path / "state" / "Lab.session.jsonl").rename(tmp_path / "state" / "lab.session.jsonl")
    assert folder.load("lab") is None


def test_a_disk_that_fails_costs_the_memory_and_is_said(folder, caplog, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(stores, "FileIO", full)
    folder.save(saved())
    assert "not remembered over a restart" in caplog.text
    assert "No space left on device" in caplog.text


def test_a_folder_that_cannot_be_written_is_refused_with_the_way_out(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ConfigError, match="--state"):
        FolderStore(tmp_path / "file" / "state", 0)
