"""Who may do what: passes, and the tokens and keys that stand for them.

A token is a JWT, signed by this server's secret (HS256) or by an Ed25519 key of which the server
needs the public half alone (EdDSA). An API key is a random text of which the server keeps the
hash. Neither is ever logged, recorded or remembered beyond the check.
"""

import hashlib
import hmac
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, get_args

import jwt
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput

Right = Literal["sensor", "renderer", "monitor", "operator"]
"""``sensor`` sends frames, ``renderer`` carries commands out and sets objects, ``monitor`` sees
everything, ``operator`` does over HTTP what is no role of a websocket: set objects, swap models."""
RIGHTS: tuple[Right, ...] = get_args(Right)
AUDIENCE = "agent-server"
Secret = str | Ed25519PrivateKey | Ed25519PublicKey


class NotAdmitted(InvalidInput):
    """A token is missing or wrong, or does not go so far; ``code`` says which."""


@dataclass(frozen=True, slots=True)
class Pass:
    """What somebody may do.

    Attributes:
        name: Who it is, for logs.
        rights: What they may be or do.
        sessions: In which sessions; None means in all.
        expires_ns: Until when, on the wall clock since 1970; None means for good.
    """

    name: str
    rights: frozenset[Right]
    sessions: frozenset[str] | None = None
    expires_ns: int | None = None

    def sees(self, session: str) -> bool:
        """Whether it has to do with a session at all."""
        return self.sessions is None or session in self.sessions

    def require(self, session: str | None, *rights: Right) -> None:
        """Refuse who has none of these rights in a session, or, without one, in all sessions.

        Raises:
            NotAdmitted: With what the pass lacks.
        """
        if self.rights.isdisjoint(rights):
            raise NotAdmitted(
                f"this takes the right {' or '.join(rights)}, and the token gives "
                f"{', '.join(sorted(self.rights))}: ask for another token",
                field="token",
                code="not_allowed",
            )
        if self.sessions is not None and session not in self.sessions:
            what = "all sessions" if session is None else f"the session {session!r}"
            raise NotAdmitted(
                f"the token does not go for {what}: ask for another one",
                field="token",
                code="not_allowed",
            )


ANYBODY = Pass("anybody", frozenset(RIGHTS))
"""Where no tokens are asked for."""


@dataclass(frozen=True, slots=True)
class Access:
    """Decides who is admitted.

    Attributes:
        keys: Pass of each API key by the SHA-256 of the key, in hexadecimal.
        secret: What tokens are checked with, or None where there are none.
    """

    keys: Mapping[str, Pass]
    secret: Secret | None = None

    @property
    def is_guarded(self) -> bool:
        """Whether anybody has to show anything."""
        return bool(self.keys) or self.secret is not None

    def admit(self, token: str | None) -> Pass:
        """What the bearer of a token may do.

        Raises:
            NotAdmitted: If it is missing, wrong or expired.
        """
        if not self.is_guarded:
            return ANYBODY
        if token is None:
            raise NotAdmitted(
                "this server wants a token: send it in hello, in the header Authorization: "
                "Bearer TOKEN, or open the page with ?token=TOKEN",
                field="token",
                code="no_token",
            )
        if (known := self._key(token)) is not None:
            return known
        if self.secret is None:
            raise _bad("it is none of the keys that this server knows")
        return _read(token, self.secret)

    def _key(self, token: str) -> Pass | None:
        """The pass of an API key, compared with every known one in constant time."""
        digest = digest_of(token)
        found = None
        for known, one in self.keys.items():
            if hmac.compare_digest(known, digest):
                found = one
        return found


OPEN = Access({})
"""Admits everybody."""


def digest_of(key: str) -> str:
    """What is kept of an API key: it is long and random, so that one round of SHA-256 will do."""
    return hashlib.sha256(key.encode(errors="surrogatepass")).hexdigest()


def issue(
    secret: str | Ed25519PrivateKey,
    name: str,
    rights: Iterable[Right],
    sessions: Iterable[str] | None,
    lifetime_s: float,
) -> str:
    """A signed token.

    Args:
        secret: What it is signed with.
        name: Who it is for.
        rights: What they may be or do.
        sessions: In which sessions; None means in all.
        lifetime_s: How long it holds.
    """
    now_s = int(time.time())
    claims = {
        "aud": AUDIENCE,
        "sub": name,
        "iat": now_s,
        "exp": now_s + int(lifetime_s),
        "roles": sorted(set(rights)),
    }
    if sessions is not None:
        claims["sessions"] = sorted(set(sessions))
    return jwt.encode(claims, secret, algorithm=_algorithm(secret))


def _algorithm(secret: Secret) -> str:
    return "HS256" if isinstance(secret, str) else "EdDSA"


def _read(token: str, secret: Secret) -> Pass:
    key = secret.public_key() if isinstance(secret, Ed25519PrivateKey) else secret
    try:
        # One algorithm, that of the key: a token cannot choose a weaker one.
        claims = jwt.decode(
            token,
            key,
            algorithms=[_algorithm(secret)],
            audience=AUDIENCE,
            options={"require": ["exp", "sub", "aud", "roles"]},
        )
    except jwt.ExpiredSignatureError:
        raise NotAdmitted(
            "the token has expired: ask for a new one", field="token", code="token_expired"
        ) from None
    except (jwt.InvalidTokenError, ValueError) as error:
        raise _bad(str(error)) from None
    roles, sessions = claims["roles"], claims.get("sessions")
    if not _are_texts(roles) or not set(roles) <= set(RIGHTS):
        raise _bad(f"its roles must be some of {', '.join(RIGHTS)}")
    if sessions is not None and not _are_texts(sessions):
        raise _bad("its sessions must be a list of ids")
    return Pass(
        name=str(claims["sub"]),
        rights=frozenset(roles),
        sessions=None if sessions is None else frozenset(sessions),
        expires_ns=int(claims["exp"]) * NS_PER_S,
    )


def _are_texts(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) for one in value)


def _bad(why: str) -> NotAdmitted:
    return NotAdmitted(f"the token is not valid: {why}", field="token", code="bad_token")
