"""Settings refuse contradictions with a sentence that names the key."""

import pytest

from agent_server.config import Settings, load_settings
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
