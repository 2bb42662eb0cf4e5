"""Secrets out of files and the environment, and into files when they are made."""

import logging
import secrets
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

import msgspec
from cryptography.exceptions import UnsupportedAlgorithm
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import load_pem_private_key, load_pem_public_key

from agent_server.config import AccessSettings
from agent_server.errors import ConfigError
from agent_server.service.auth import Access, Pass, Right, Secret, digest_of

log = logging.getLogger(__name__)

SECRET_VARIABLE = "AGENT_SERVER_SECRET"  # noqa: S105 - where it stands, not what it is
KEY_VARIABLE = "AGENT_SERVER_API_KEY"
SMALLEST_BYTES = 32
"""HS256 is as strong as its secret is long (RFC 7518, section 3.2)."""


class _Key(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One entry of a file of API keys."""

    sha256: str
    roles: list[Right]
    sessions: list[str] | None = None


def load_access(settings: AccessSettings, environment: Mapping[str, str]) -> Access:
    """Everything that admits somebody.

    Raises:
        ConfigError: If a file cannot be read or a secret is too weak.
    """
    keys = {} if settings.keys_file is None else _read_keys(Path(settings.keys_file))
    if key := environment.get(KEY_VARIABLE):
        if len(key.encode()) < SMALLEST_BYTES:
            raise ConfigError(f"{KEY_VARIABLE} is too short: {_HOW_LONG}")
        keys[digest_of(key)] = Pass(
            KEY_VARIABLE, frozenset(("sensor", "renderer", "monitor", "operator"))
        )
    return Access(keys, load_secret(settings, environment))


def load_secret(settings: AccessSettings, environment: Mapping[str, str]) -> Secret | None:
    """What tokens are signed and checked with, or None if nothing names it.

    Raises:
        ConfigError: If it cannot be read or is too weak.
    """
    if text := environment.get(SECRET_VARIABLE):
        return _secret(text, SECRET_VARIABLE)
    if settings.secret_file is None:
        return None
    path = Path(settings.secret_file)
    return _secret(_read(path), str(path))


def new_key(path: Path, name: str, rights: Iterable[Right], sessions: Iterable[str] | None) -> str:
    """Make an API key, add its hash to a file, and give the key: it is kept nowhere.

    Raises:
        ConfigError: If the file is wrong, cannot be written or knows the name already.
    """
    entries = _entries(path) if path.exists() else {}
    if name in entries:
        raise ConfigError(
            f"{path} has a key {name!r} already: remove it there, or take another name"
        )
    key = secrets.token_urlsafe(SMALLEST_BYTES)
    entry = _Key(
        digest_of(key), sorted(set(rights)), None if sessions is None else sorted(set(sessions))
    )
    lines = [f"[{_quoted(name)}]"]
    lines += [
        f"{field} = {_quoted(value)}"
        for field, value in msgspec.structs.asdict(entry).items()
        if value is not None
    ]
    _write(path, (_read(path) if path.exists() else "") + "\n".join(lines) + "\n\n")
    return key


def new_secret(path: Path) -> None:
    """Make a secret for HS256 and write it to a new file that its owner alone may read.

    Raises:
        ConfigError: If there is such a file, or it cannot be written.
    """
    if path.exists():
        raise ConfigError(f"{path} exists: tokens that it has signed would all be void")
    _write(path, secrets.token_urlsafe(SMALLEST_BYTES) + "\n")


_HOW_LONG = (
    f"give {SMALLEST_BYTES} bytes or more; `agent-server token --new-secret FILE` makes such a text"
)


def _secret(text: str, source: str) -> Secret:
    text = text.strip()
    if not text.startswith("-----BEGIN"):
        if len(text.encode()) < SMALLEST_BYTES:
            raise ConfigError(f"the secret in {source} is too short: {_HOW_LONG}")
        return text
    try:
        data = text.encode()
        is_private = "PRIVATE KEY-----" in text
        key = load_pem_private_key(data, None) if is_private else load_pem_public_key(data)
    except (ValueError, TypeError, UnsupportedAlgorithm):
        raise ConfigError(
            f"{source} holds no key in PEM that can be read without a password"
        ) from None
    if not isinstance(key, Ed25519PrivateKey | Ed25519PublicKey):
        raise ConfigError(f"{source} holds a key that is not Ed25519, which EdDSA takes")
    return key


def _read_keys(path: Path) -> dict[str, Pass]:
    return {
        key.sha256.lower(): Pass(
            name,
            frozenset(key.roles),
            None if key.sessions is None else frozenset(key.sessions),
        )
        for name, key in _entries(path).items()
    }


def _entries(path: Path) -> dict[str, _Key]:
    try:
        return msgspec.convert(tomllib.loads(_read(path)), dict[str, _Key])
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise ConfigError(
            f"{path} is no file of API keys: {error}; write [NAME] and below it sha256, roles and, "
            "if the key is not for all, sessions"
        ) from None


def _read(path: Path) -> str:
    try:
        text = path.read_text("utf-8")
        if path.stat().st_mode & 0o077:
            log.warning("%s can be read by others: chmod 600 it", path)
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError:
        raise ConfigError(f"{path} holds no text") from None
    return text


def _write(path: Path, text: str) -> None:
    try:
        path.touch(0o600)
        path.write_text(text, "utf-8")
    except OSError as error:
        raise ConfigError(f"cannot write {path}: {error.strerror}") from error


def _quoted(value: object) -> str:
    """JSON's texts and lists of texts are TOML's too."""
    return msgspec.json.encode(value).decode()
