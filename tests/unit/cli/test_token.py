"""Tokens and keys from the command line, and settings explained and checked there."""

import pytest
from typer.testing import CliRunner

from agent_server.cli.main import app
from agent_server.config import AccessSettings
from agent_server.errors import ConfigError
from agent_server.service.secrets import load_access


def run(*arguments, code=0, **environment):
    result = CliRunner().invoke(app, [str(one) for one in arguments], env=environment)
    if isinstance(result.exception, ConfigError):
        raise result.exception
    assert result.exit_code == code, result.output
    return result.stdout.strip()


def test_a_token_is_issued_for_roles_of_sessions(tmp_path):
    secret = tmp_path / "secret"
    assert run("token", "--new-secret", secret) == ""
    said = run(
        *("token", "--secret-file", secret, "--role", "sensor", "--role", "monitor"),
        *("--session", "hall", "--name", "kinect"),
    )
    found = load_access(AccessSettings(secret_file=str(secret)), {}).admit(said)
    assert (found.name, found.rights, found.sessions) == (
        *("kinect", {"sensor", "monitor"}),
        {"hall"},
    )
    said = run("token", "--role", "operator", AGENT_SERVER_SECRET=secret.read_text())
    assert load_access(AccessSettings(secret_file=str(secret)), {}).admit(said).sessions is None


def test_an_api_key_is_printed_once_and_its_hash_kept(tmp_path):
    keys = tmp_path / "keys.toml"
    key = run("token", "--api-key", "--keys-file", keys, "--role", "renderer", "--name", "unity")
    assert key not in keys.read_text()
    found = load_access(AccessSettings(keys_file=str(keys)), {}).admit(key)
    assert (found.name, found.rights) == ("unity", {"renderer"})


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--role", "sensor"), "nothing to sign with"),
        ((), "say what it is for"),
        (("--role", "king"), "sensor, renderer, monitor, operator"),
        (("--role", "sensor", "--api-key"), "--keys-file"),
    ],
)
def test_what_is_lacking_is_said(arguments, said):
    with pytest.raises(ConfigError, match=said):
        run("token", *arguments)


def test_settings_are_explained_and_checked(tmp_path):
    path = tmp_path / "settings.toml"
    path.write_text(run("config", "--explain") + "\n")
    assert "no mistakes" in run("check-config", path)
    path.write_text("[server]\nprot = 1\n")
    assert f"{path}:2: [server] prot: unknown key; did you mean 'port'" in run(
        "check-config", path, code=1
    )
    assert '"mistakes"' in run("check-config", path, "--json", code=1)
    assert "port = 9000" in run("config", AGENT_SERVER__SERVER__PORT="9000")
