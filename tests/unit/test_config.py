"""Settings refuse contradictions with a sentence that names the key."""

import pytest

from agent_server.config import Settings, explain, load_settings, mistakes_in
from agent_server.config.explain import meanings
from agent_server.config.load import keys, sections
from agent_server.errors import ConfigError


def load(tmp_path, text):
    path = tmp_path / "settings.toml"
    path.write_text(text)
    return load_settings(path)


def test_no_file_gives_the_defaults():
    assert load_settings(None) == Settings()


def test_a_file_overrides_what_it_names_and_nothing_else(tmp_path):
    settings = load(tmp_path, "[window]\nhop_frames = 10\n[gate]\nmode = 'optional'\n")
    assert settings.window.hop == 10
    assert settings.gate.mode == "optional"
    assert settings.decide == Settings().decide


def test_the_thesis_grid_has_no_overlap(tmp_path):
    assert load(tmp_path, "[window]\nmode = 'thesis'\n").window.hop == 25


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("[window]\nhop_frames = 0\n", "hop_frames"),
        ("[window]\nmax_gap_ms = 1\n", "max_gap_ms"),
        ("[window]\nhops = 3\n", "hops"),
        ("[subject]\npolicy = 'explicit'\n", "body_id"),
        ("[subject]\nbody_id = 4\n", "policy"),
        ("[subject]\nrelease_s = 5.0\n", "release_s"),
        ("[gate]\nenter_valence = 1.0\n", "enter_valence"),
        ("[gate]\nleave_arousal = 4.0\n", "leave_arousal"),
        ("[gate]\nmax_age_ms = 0\n", "max_age_ms"),
        ("[gate]\nmode = 'sometimes'\n", "sometimes"),
        ("[decide]\nenter = 0.2\n", "enter"),
        ("[decide]\nenter_ungated = 0.5\n", "enter_ungated"),
        ("[decide]\nenter_windows = 0\n", "enter_windows"),
        ("[decide]\nleave_windows = 0\n", "leave_windows"),
        ("[decide]\ncooldown_s = -1.0\n", "cooldown_s"),
        ("[decide]\ncooldown_s = inf\n", "cooldown_s"),
        ("[server]\nport = 70000\n", "port"),
        ("[server]\nmax_message_bytes = 10\n", "max_message_bytes"),
        ("[server]\nmax_sessions = 0\n", "max_sessions"),
        ("[server]\ncommand_queue = 0\n", "command_queue"),
        ("[server]\nsession_linger_s = -1.0\n", "session_linger_s"),
        ("[models]\nclassifier = ''\n", "classifier"),
        ("[models]\ngate = 'x'\n", "gate"),
        ("[vmc]\nhost = ''\n", "host"),
        ("[vmc]\nport = 0\n", "port"),
        ("[vmc]\nlead_ms = 2000\n", "lead_ms"),
        ("[vmc]\nshow = 'dreamt'\n", "dreamt"),
        ("[window\n", "TOML"),
    ],
)
def test_a_wrong_setting_is_refused_by_name(tmp_path, text, named):
    with pytest.raises(ConfigError, match=named):
        load(tmp_path, text)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"nowhere\.toml"):
        load_settings(tmp_path / "nowhere.toml")


def test_every_mistake_of_a_file_is_named_with_its_line(tmp_path):
    path = tmp_path / "settings.toml"
    path.write_text(
        "[server]\nport = 70000\nhostt = 'a'\n[gate]\nmode = 'sometimes'\n"
        "[window]\nhop_frames = 0\nmax_gap_ms = 1\n[nope]\na = 1\n"
    )
    mistakes = mistakes_in(path)
    assert sorted(int(one.removeprefix(f"{path}:").partition(":")[0]) for one in mistakes) == [
        *(2, 3, 5, 7, 8, 9)
    ]
    assert any("did you mean 'host'" in one for one in mistakes)
    assert mistakes_in(path) == mistakes
    path.write_text("[server]\nport = 1\n[server\n")
    assert [one.removeprefix(f"{path}:").partition(":")[0] for one in mistakes_in(path)] == ["3"]
    path.write_text("server = 3\n")
    assert "write [server]" in mistakes_in(path)[0]


def test_the_environment_has_the_last_word(tmp_path):
    path = tmp_path / "settings.toml"
    path.write_text("[server]\nport = 1\nhost = '::1'\n")
    settings = load_settings(
        path,
        {
            "AGENT_SERVER__SERVER__PORT": "9000",
            "AGENT_SERVER__ACCESS__ORIGINS": "['https://example.org']",
            "AGENT_SERVER__FACE__RECORD_IMAGES": "true",
            "AGENT_SERVER__RULES": "room.toml",
            "AGENT_SERVER_DATA": "is none of ours",
        },
    )
    assert (settings.server.port, settings.server.host) == (9000, "::1")
    assert settings.access.origins == ("https://example.org",)
    assert settings.face.record_images
    assert settings.rules == "room.toml"


@pytest.mark.parametrize(
    ("variable", "value", "said"),
    [
        ("AGENT_SERVER__SERVER__PORT", "many", "PORT: [server] port: Expected `int`"),
        ("AGENT_SERVER__SERVER__PROT", "1", "did you mean 'port'"),
        ("AGENT_SERVER__SEVER__PORT", "1", "did you mean 'server'"),
        ("AGENT_SERVER__ACCESS__ORIGINS", "['x'", "origins"),
        ("AGENT_SERVER__ACCESS__ORIGINS", "['example.org']", "write scheme, host and port"),
        ("AGENT_SERVER__ACCESS__SECRET", "pssst", "unknown key"),
    ],
)
def test_what_is_wrong_in_the_environment_is_named(variable, value, said):
    with pytest.raises(ConfigError) as caught:
        load_settings(None, {variable: value})
    assert said in str(caught.value)
    assert "pssst" not in str(caught.value)


def test_every_key_is_explained_and_the_explanation_is_a_file_of_settings(tmp_path):
    for name, kind in sections().items():
        assert set(keys(kind)) <= set(meanings(kind)), name
    settings = load(tmp_path, "rules = 'a.toml'\n[vmc]\nshow = 'predicted'\n")
    assert load(tmp_path, explain(settings)) == settings
    assert load(tmp_path, explain(settings, with_words=False)) == settings
    assert 'show = "predicted"  # default: "observed"' in explain(settings)
