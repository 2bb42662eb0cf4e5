"""Suite files."""

import pytest

from agent_server.errors import ConfigError
from agent_server.qa.suite import Terms, load_suite


@pytest.fixture
def folder(tmp_path):
    for name in ("a.mcap", "b.mcap"):
        (tmp_path / name).write_bytes(b"")
    return tmp_path


def write(folder, text):
    (folder / "suite.toml").write_text(text, "utf-8")
    return load_suite(folder)


def test_a_folder_without_a_file_is_a_suite_of_its_recordings(folder):
    suite = load_suite(folder)
    assert suite.name == folder.name
    assert [case.name for case in suite.cases] == ["a.mcap", "b.mcap"]
    assert suite.cases[0].terms == Terms()


def test_a_recording_overrides_the_defaults_key_by_key(folder):
    suite = write(
        folder,
        '[defaults]\nwithin_ms = 1500\nlate_ms = 500\n[recording."b.mcap"]\nwithin_ms = 900\n',
    )
    assert [(c.terms.within_ms, c.terms.late_ms) for c in suite.cases] == [(1500, 500), (900, 500)]


def test_the_file_itself_may_be_named_and_choose_recordings(folder):
    path = folder / "strict.toml"
    path.write_text('name = "strict"\nrecordings = ["b*.mcap"]\n[limits]\nmin_right = 0.9\n')
    suite = load_suite(path)
    assert suite.name == "strict"
    assert [case.name for case in suite.cases] == ["b.mcap"]
    assert suite.limits.min_right == 0.9


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[recording."c.mcap"]\nwithin_ms = 1\n', "'c.mcap', which is none of its recordings"),
        ("[defaults]\nwithin = 1\n", "unknown field `within`"),
        ("[defaults]\nwithin_ms = -5\n", "within_ms is -5: it must be 0 or more"),
        ('[defaults]\nwithin_ms = "soon"\n', "Expected `int | null`, got `str`"),
        ("[limits\n", "is not valid TOML"),
        ('recordings = ["*.bag"]\n', "holds no *.bag"),
        ('[[defaults.expect]]\nreaction = "greet"\n', "missing required field `onset_s`"),
    ],
)
def test_a_mistake_is_named(folder, text, words):
    with pytest.raises(ConfigError) as caught:
        write(folder, text)
    assert words in str(caught.value)


def test_what_is_no_suite_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="holds no"):
        load_suite(tmp_path)
    with pytest.raises(ConfigError, match="is no suite"):
        load_suite(tmp_path / "x.mcap")
    with pytest.raises(ConfigError, match="cannot read"):
        load_suite(tmp_path / "x.toml")
