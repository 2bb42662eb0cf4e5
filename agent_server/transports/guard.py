"""What stands before every route: where a request comes from, and what its bearer may do.

Everything is closed but what is named: health, and the files of the page, which hold no secret.
A websocket may pass without a token, for it may come in hello.
"""

import logging
from collections.abc import Iterable
from http import HTTPStatus
from http.cookies import SimpleCookie
from ipaddress import ip_address
from urllib.parse import urlsplit

from starlette.datastructures import URL, Headers, MutableHeaders, QueryParams
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from agent_server.config import Settings
from agent_server.service.auth import Access, NotAdmitted, Pass, Right

log = logging.getLogger(__name__)

COOKIE = "agent_server_token"
_ADMITTED = "agent_server.admitted"
_SHOWN = "agent_server.shown"
STATUS = {"not_allowed": HTTPStatus.FORBIDDEN}
"""HTTP status of a refusal by its code; of any other it is 401."""
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(self), microphone=(), geolocation=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
"""Of every response that does not say otherwise."""
ONLY_TLS = "max-age=31536000"


class Guard:
    """Refuses who may not come in, and says what a browser may do with what is given out.

    Args:
        app: What is guarded.
        access: Who is admitted.
        settings: From where.
        open_paths: What needs no token.
    """

    def __init__(
        self, app: ASGIApp, access: Access, settings: Settings, open_paths: Iterable[str]
    ) -> None:
        self._app = app
        self._access = access
        self._origins = frozenset(settings.access.origins)
        self._has_any_host = access.is_guarded or settings.access.insecure
        self._open_paths = frozenset(open_paths)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or let the application answer."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        is_secure = scope["scheme"] in ("https", "wss")
        answer: ASGIApp | None = self._answer(scope)
        if scope["type"] == "http":
            send = _with_headers(send, is_secure=is_secure)
        await (answer or self._app)(scope, receive, send)

    def _answer(self, scope: Scope) -> Response | None:
        """A refusal, or another answer in the application's place."""
        headers = Headers(scope=scope)
        path = scope["path"]
        is_open = scope["type"] == "http" and path in self._open_paths
        if not is_open and (sentence := self._wrong_origin(headers)):
            log.info("refused %s %s: %s", _peer(scope), path, sentence)
            return _refusal(HTTPStatus.FORBIDDEN, "wrong_origin", sentence)
        query = QueryParams(scope["query_string"])
        token = _token(headers, query)
        if scope["type"] == "websocket":
            scope[_SHOWN] = token
            return None
        try:
            if is_open and "token" in query:
                return self._remember(scope, query)
            if not is_open:
                scope[_ADMITTED] = self._access.admit(token)
        except NotAdmitted as error:
            log.info("refused %s %s: %s", _peer(scope), path, error.code)
            return refused(error)
        return None

    def _remember(self, scope: Scope, query: QueryParams) -> Response:
        """Keep the page's token in a cookie, and take it out of the address."""
        token = query["token"]
        self._access.admit(token)
        rest = [(name, value) for name, value in query.multi_items() if name != "token"]
        there = URL(scope=scope).replace(query=str(QueryParams(rest)))
        target = f"{there.path}?{there.query}" if there.query else there.path
        response = RedirectResponse(target, HTTPStatus.SEE_OTHER)
        response.headers["Cache-Control"] = "no-store"
        response.set_cookie(
            COOKIE, token, httponly=True, samesite="strict", secure=scope["scheme"] == "https"
        )
        return response

    def _wrong_origin(self, headers: Headers) -> str | None:
        """Why a page may not do this, if it is one that asks and it may not."""
        host = headers.get("host", "")
        if not self._has_any_host and not _is_of_this_machine(urlsplit(f"//{host}").hostname):
            # A page whose name was made to mean this machine would else be of the same origin.
            return (
                f"no tokens are asked for, and so this server is {host!r} to nobody: call it by "
                "localhost or a number"
            )
        origin = headers.get("origin")
        if origin is None or origin in self._origins:
            return None
        page = urlsplit(origin)
        if page.netloc == host and page.scheme in ("http", "https"):
            return None
        here = urlsplit(f"//{host}").hostname
        if is_loopback(page.hostname) and is_loopback(here):
            return None
        return (
            f"a page of {origin} may not connect: add it to origins in [access], or open the "
            "page of this server"
        )


def admitted(scope: Scope) -> Pass:
    """What the bearer of a request's token may do."""
    found: Pass = scope[_ADMITTED]
    return found


def shown_token(scope: Scope) -> str | None:
    """The token of a websocket's handshake."""
    token: str | None = scope[_SHOWN]
    return token


def require(scope: Scope, session: str | None, *rights: Right) -> None:
    """Refuse a request whose bearer has none of these rights in a session, or in all of them.

    Raises:
        NotAdmitted: With what is lacking.
    """
    admitted(scope).require(session, *rights)


def refused(error: NotAdmitted) -> Response:
    """The answer to who is not admitted."""
    status = STATUS.get(error.code, HTTPStatus.UNAUTHORIZED)
    response = _refusal(status, error.code, str(error))
    if status == HTTPStatus.UNAUTHORIZED:
        response.headers["WWW-Authenticate"] = "Bearer"
    return response


def _refusal(status: HTTPStatus, code: str, sentence: str) -> Response:
    return JSONResponse({"detail": sentence, "code": code}, status)


def _token(headers: Headers, query: QueryParams) -> str | None:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer" and token.strip():
        return token.strip()
    if COOKIE in (cookies := SimpleCookie(headers.get("cookie", ""))):
        return cookies[COOKIE].value
    return query.get("token")


def is_loopback(host: str | None) -> bool:
    """Whether an address or a name means the machine itself."""
    if host is None or host == "localhost":
        return host is not None
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host.endswith(".localhost")


def _is_of_this_machine(host: str | None) -> bool:
    """Whether a name can mean nobody else's: a number, or localhost."""
    try:
        return host is not None and bool(ip_address(host))
    except ValueError:
        return is_loopback(host)


def _peer(scope: Scope) -> str:
    return scope["client"][0] if scope.get("client") else "somebody"


def _with_headers(send: Send, *, is_secure: bool) -> Send:
    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
            if is_secure:
                headers.setdefault("Strict-Transport-Security", ONLY_TLS)
        await send(message)

    return sending
