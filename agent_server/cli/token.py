"""``agent-server token``."""

import os
from pathlib import Path
from typing import Annotated

import msgspec
import typer
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

from agent_server.cli.options import ConfigOption, KeysFileOption, SecretFileOption, settings_with
from agent_server.errors import ConfigError
from agent_server.service.auth import RIGHTS, Right, issue
from agent_server.service.secrets import SECRET_VARIABLE, load_secret, new_key, new_secret


def token(
    role: Annotated[
        list[str] | None,
        typer.Option(help="sensor, renderer, monitor or operator; again for more than one."),
    ] = None,
    session: Annotated[
        list[str] | None, typer.Option(help="Session it goes for; again for more. Default: all.")
    ] = None,
    name: Annotated[str, typer.Option(help="Who it is for; logs show it.")] = "client",
    hours: Annotated[float, typer.Option(min=0.01, help="How long a token holds.")] = 12.0,
    config: ConfigOption = None,
    secret_file: SecretFileOption = None,
    keys_file: KeysFileOption = None,
    api_key: Annotated[
        bool,
        typer.Option("--api-key", help="Make an API key, which never expires; its hash is kept."),
    ] = False,
    make_secret: Annotated[
        Path | None,
        typer.Option(
            "--new-secret", metavar="FILE", help="Make a secret that tokens are signed with."
        ),
    ] = None,
) -> None:
    """Issue a token, or an API key, for roles of sessions; it is printed and kept nowhere."""
    if make_secret is not None:
        new_secret(make_secret)
        return
    access = settings_with(config, secret_file=secret_file, keys_file=keys_file).access
    rights, sessions = _rights(role or []), session or None
    if api_key:
        if access.keys_file is None:
            raise ConfigError("an API key's hash is kept in a file: name it with --keys-file FILE")
        print(new_key(Path(access.keys_file), name, rights, sessions))
        return
    secret = load_secret(access, os.environ)
    if secret is None:
        raise ConfigError(
            "there is nothing to sign with: name a secret with --secret-file FILE or in "
            f"{SECRET_VARIABLE}; `agent-server token --new-secret FILE` makes one"
        )
    if isinstance(secret, Ed25519PublicKey):
        raise ConfigError("a public key only checks tokens: sign with the private one")
    print(issue(secret, name, rights, sessions, hours * 3600))


def _rights(roles: list[str]) -> list[Right]:
    if not roles:
        raise ConfigError(f"say what it is for: --role {', --role '.join(RIGHTS)}")
    try:
        return msgspec.convert(roles, list[Right])
    except msgspec.ValidationError:
        raise ConfigError(f"--role is one of {', '.join(RIGHTS)}; got {', '.join(roles)}") from None
