"""Strangers: whoever may not come in is refused with the code that says why."""

import asyncio
import gzip
import logging
import socket
import ssl
import subprocess
import time
import zlib

import httpx
import jwt
import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from agent_server.client.link import Options
from agent_server.client.once import ConnectionFailed
from agent_server.client.renderer import Renderer
from agent_server.config import AccessSettings, ServerSettings, Settings
from agent_server.errors import ConfigError
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.codes import CLOSE_FULL, CLOSE_NOT_ADMITTED, CLOSE_TOO_LARGE
from agent_server.service.auth import ANYBODY, RIGHTS, Access, NotAdmitted, digest_of, issue
from agent_server.service.secrets import load_access, new_key, new_secret
from agent_server.transports.server import check_exposure
from tests.support.live import live
from tests.support.patience import patience

SECRET = "for tests alone, and long enough for it"  # noqa: S105
KEY = "a key of an operator, long enough too"
ACCESS = Access({digest_of(KEY): ANYBODY}, SECRET)
JSON = CODECS[m.SUBPROTOCOL_JSON]


def token(*roles, sessions=("s",), secret=SECRET, lifetime_s=60):
    return issue(secret, "tester", roles or RIGHTS, sessions, lifetime_s)


def unsigned():
    claims = {"aud": "agent-server", "sub": "x", "exp": time.time() + 9, "roles": list(RIGHTS)}
    return jwt.encode(claims, None, algorithm="none")


async def end_of(url, role="monitor", said=None, session="s", **options):
    """Error code and close code that a client gets."""
    address = f"{url.replace('http', 'ws', 1)}/v1/sessions/{session}/{role}"
    async with connect(address, compression=None, proxy=None, **options) as websocket:
        await websocket.send(JSON.encode(m.Hello(m.PROTOCOL, "stranger", token=said)))
        answer = JSON.decode_server(await websocket.recv())
        if isinstance(answer, m.Welcome):
            return "welcome", None
        with pytest.raises(ConnectionClosed):
            await websocket.recv()
        return answer.code, websocket.close_code


async def test_who_may_not_come_in_is_told_why():
    refused = {
        "no_token": None,
        "bad_token": "guessed",
        "token_expired": token(lifetime_s=-5),
        "not_allowed": token("sensor"),
    }
    async with live(access=ACCESS) as server:
        for code, said in refused.items():
            assert await end_of(server.url, said=said) == (code, CLOSE_NOT_ADMITTED)
        for said in (
            token(secret=SECRET.upper()),
            unsigned(),
            token()[:-4] + "AAAA",
        ):
            assert await end_of(server.url, said=said) == ("bad_token", CLOSE_NOT_ADMITTED)
        other = token(sessions=["t"])
        assert await end_of(server.url, said=other) == ("not_allowed", CLOSE_NOT_ADMITTED)
        assert server.hub.sessions == {}, "nobody who is refused opens a session"
        for said in (token(), token(sessions=None), KEY):
            assert (await end_of(server.url, said=said))[0] == "welcome"
        assert (await end_of(server.url, said=token("sensor"), role="sensor"))[0] == "welcome"


async def test_a_token_may_come_in_the_header_or_in_the_address():
    async with live(access=ACCESS) as server:
        header = {"Authorization": f"Bearer {token()}"}
        assert (await end_of(server.url, additional_headers=header))[0] == "welcome"
        assert (await end_of(server.url, role=f"monitor?token={token()}"))[0] == "welcome"
        wrong = {"Authorization": "Bearer guessed"}
        assert (await end_of(server.url, said=token(), additional_headers=wrong))[0] == "welcome"


async def test_a_client_that_is_sent_away_does_not_come_back_by_itself():
    async with live(access=ACCESS) as server:
        renderer = Renderer(Options(server.url, "s", "tester", token=SECRET))
        with pytest.raises(ConnectionFailed, match="not valid"):
            async with patience():
                await renderer.link.run()


async def test_a_token_that_expires_ends_the_visit():
    settings = Settings(server=ServerSettings(heartbeat_s=0.1))
    async with live(settings=settings, access=ACCESS) as server:
        hello = m.Hello(m.PROTOCOL, "tester", token=token(lifetime_s=1))
        async with server.join("monitor", hello=hello) as client, patience():
            with pytest.raises(ConnectionFailed, match=str(CLOSE_NOT_ADMITTED)):
                async for _ in client:
                    pass


GUARDED = (
    ("GET", "/v1/sessions"),
    ("PUT", "/v1/sessions/s/objects/window?state=open"),
    ("GET", "/v1/stand-in?gesture=cold"),
    ("GET", "/v1/models/ma_wgan_server/manifest.json"),
    ("POST", "/v1/models/predictor?path=x"),
    ("GET", "/asyncapi.json"),
    ("GET", "/openapi.json"),
    ("GET", "/v1/streams/demo/about"),
    ("GET", "/v1/streams/demo/motion"),
    ("GET", "/v1/streams/demo/labels"),
    ("GET", "/protocol"),
    ("GET", "/metrics"),
    ("GET", "/nowhere"),
)


async def test_every_http_route_is_guarded():
    async with live(access=ACCESS) as server, httpx.AsyncClient(base_url=server.url) as http:
        for path in ("/healthz", "/v1/models/face_mesh/manifest.json"):
            assert (await http.get(path)).status_code == 200
        for method, path in GUARDED:
            answer = await http.request(method, path)
            assert (answer.status_code, answer.json()["code"]) == (401, "no_token"), path
            assert answer.headers["WWW-Authenticate"] == "Bearer"
        bearer = {"Authorization": f"Bearer {KEY}"}
        for method, path in GUARDED:
            answer = await http.request(method, path, headers=bearer)
            assert answer.status_code in (200, 404, 422), path
        put = "/v1/sessions/s/objects/window?state=closed"
        for said, status in ((token("monitor"), 403), (token("renderer", sessions=["t"]), 403)):
            answer = await http.put(put, headers={"Authorization": f"Bearer {said}"})
            assert (answer.status_code, answer.json()["code"]) == (status, "not_allowed")


async def test_sessions_of_others_are_not_listed():
    async with (
        live(access=ACCESS) as server,
        server.join("monitor", hello=m.Hello(m.PROTOCOL, "a", token=KEY)),
        server.join("monitor", "t", hello=m.Hello(m.PROTOCOL, "a", token=KEY)),
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        answer = await http.get("/v1/sessions", params={"token": token(sessions=["t"])})
        assert [one["id"] for one in answer.json()["sessions"]] == ["t"]


async def test_the_page_keeps_its_token_in_a_cookie_that_scripts_cannot_read():
    async with live(access=ACCESS) as server, httpx.AsyncClient(base_url=server.url) as http:
        assert (await http.get("/", params={"token": "guessed"})).status_code == 401
        answer = await http.get("/", params={"token": token(), "session": "s"})
        assert (answer.status_code, answer.headers["Location"]) == (303, "/?session=s")
        for word in ("HttpOnly", "SameSite=strict"):
            assert word in answer.headers["Set-Cookie"]
        assert (await http.get("/v1/sessions")).status_code == 200
        cookie = {"Cookie": answer.headers["Set-Cookie"].partition(";")[0]}
        assert (await end_of(server.url, additional_headers=cookie))[0] == "welcome"


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Origin": "https://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "http://rebound.example:80", "Host": "rebound.example:80"}, 403),
        ({"Host": "rebound.example"}, 403),
        ({"Origin": "http://localhost:5173"}, 200),
        ({"Origin": "https://friend.example"}, 200),
        ({}, 200),
    ],
)
async def test_pages_of_others_may_not_connect(headers, status):
    settings = Settings(access=AccessSettings(origins=("https://friend.example",)))
    async with live(settings=settings) as server, httpx.AsyncClient() as http:
        answer = await http.get(f"{server.url}/v1/sessions", headers=headers)
        assert answer.status_code == status
        if status == 403:
            assert answer.json()["code"] == "wrong_origin"
        if "Host" in headers:
            return
        if status == 200:
            assert (await end_of(server.url, additional_headers=headers))[0] == "welcome"
            return
        with pytest.raises(InvalidStatus) as caught:
            await end_of(server.url, additional_headers=headers)
        assert caught.value.response.status_code == 403


async def test_answers_say_what_a_browser_may_do_with_them():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        for path in ("/healthz", "/v1/sessions", "/protocol", "/", "/nowhere"):
            headers = (await http.get(path)).headers
            assert headers["X-Content-Type-Options"] == "nosniff", path
            assert headers["Referrer-Policy"] == "no-referrer"
            assert headers["X-Frame-Options"] == "DENY"
            assert "default-src" in headers["Content-Security-Policy"]
            assert "server" not in headers


async def raw(url, *parts, gap_s=0.0):
    """Send parts of bytes; gives what came back, and after how long the connection ended."""
    host, port = url.removeprefix("http://").split(":")
    start = time.monotonic()
    reader, writer = await asyncio.open_connection(host, int(port))
    try:
        for part in parts:
            writer.write(part)
            await asyncio.sleep(gap_s)
        async with patience():
            answer = await reader.read()
    except ConnectionError:
        answer = b""
    finally:
        writer.close()
    return answer, time.monotonic() - start


@pytest.mark.parametrize(
    "parts",
    [
        (),
        (b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n",),
        (b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n", b"GET /he"),
        (b"PUT /healthz HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n", b"1"),
    ],
)
async def test_a_slow_handshake_is_cut(parts):
    settings = Settings(server=ServerSettings(handshake_timeout_s=0.4))
    async with live(settings=settings) as server:
        _, took_s = await raw(server.url, *parts, gap_s=0.05)
        assert took_s < 2.0


async def test_connections_of_one_address_are_counted_and_given_back():
    settings = Settings(
        server=ServerSettings(max_connections_per_address=3),
        access=AccessSettings(trusted_proxies=()),
    )
    async with live(settings=settings) as server:
        async with server.join("monitor"), server.join("sensor"), server.join("renderer"):
            answer, _ = await raw(server.url)
            assert answer.startswith(b"HTTP/1.1 429 ")
        for _ in range(10):
            async with httpx.AsyncClient() as http:
                assert (await http.get(f"{server.url}/healthz")).status_code == 200


async def test_a_full_server_and_a_full_session_say_so():
    settings = Settings(server=ServerSettings(max_sessions=1, max_clients=2, max_connections=3))
    async with live(settings=settings) as server, server.join("monitor"):
        assert await end_of(server.url, session="t") == ("full", CLOSE_FULL)
        async with server.join("monitor"):
            assert await end_of(server.url) == ("full", CLOSE_FULL)
            async with connect(server.url.replace("http", "ws") + "/v1/sessions/s/monitor"):
                answer, _ = await raw(server.url)
                assert answer.startswith(b"HTTP/1.1 429 ")


async def test_frames_that_are_too_large_or_pretend_to_be_small_are_refused():
    async with live() as server:
        address = server.url.replace("http", "ws") + "/v1/sessions/s/monitor"
        async with connect(address, compression=None) as websocket:
            with pytest.raises(ConnectionClosed):
                await websocket.send("x" * (2 * 512 * 1024 + 1))
                await websocket.recv()
            assert websocket.close_code == CLOSE_TOO_LARGE
        # The server speaks no compression, so that none can hide a bomb.
        async with connect(address, compression="deflate") as websocket:
            assert websocket.protocol.extensions == []
            bomb = zlib.compressobj(9, wbits=-15)
            data = bomb.compress(bytes(10**8)) + bomb.flush()
            size = len(data).to_bytes(8, "big")
            websocket.transport.write(b"\xc2\xff" + size + bytes(4) + data)
            with pytest.raises(ConnectionClosed):
                await websocket.recv()
            assert websocket.close_code == 1002
        async with httpx.AsyncClient(base_url=server.url) as http:
            answer = await http.put(
                "/v1/sessions/s/objects/window?state=open",
                content=gzip.compress(bytes(10**7)),
                headers={"Content-Encoding": "gzip"},
            )
            assert answer.status_code == 404


async def test_no_secret_is_ever_logged(caplog):
    caplog.set_level(logging.DEBUG, "agent_server")
    caplog.set_level(logging.INFO)
    bad = "guessed-but-confidential"
    secrets = [KEY, SECRET, bad, token(), token("sensor")]
    async with live(access=ACCESS) as server, httpx.AsyncClient() as http:
        for said in secrets:
            await end_of(server.url, said=said)
            await end_of(server.url, role=f"monitor?token={said.replace(' ', '+')}")
            await end_of(server.url, additional_headers={"Authorization": f"Bearer {said}"})
            await http.post(
                f"{server.url}/v1/sessions", headers={"Authorization": f"Bearer {said}"}
            )
    ours = [
        record for record in caplog.records if not record.name.startswith(("httpx", "httpcore"))
    ]
    assert ours
    for record in ours:
        assert not any(one in record.getMessage() for one in secrets), record


def test_listening_beyond_this_machine_needs_tokens():
    outside = Settings(server=ServerSettings(host="0.0.0.0"))  # noqa: S104 - it is not done
    with pytest.raises(ConfigError, match="--insecure"):
        check_exposure(outside, Access({}))
    check_exposure(outside, ACCESS)
    check_exposure(
        Settings(server=outside.server, access=AccessSettings(insecure=True)), Access({})
    )
    for host in ("127.0.0.1", "::1", "localhost"):
        check_exposure(Settings(server=ServerSettings(host=host)), Access({}))


def test_secrets_come_from_files_and_the_environment(tmp_path):
    secret, keys = tmp_path / "secret", tmp_path / "keys.toml"
    new_secret(secret)
    assert secret.stat().st_mode & 0o777 == 0o600
    with pytest.raises(ConfigError, match="exists"):
        new_secret(secret)
    key = new_key(keys, "hall", ["sensor"], ["lab"])
    new_key(keys, "screen", ["monitor", "renderer"], None)
    with pytest.raises(ConfigError, match="already"):
        new_key(keys, "hall", ["sensor"], None)
    assert key not in keys.read_text()
    access = load_access(AccessSettings(str(secret), str(keys)), {"AGENT_SERVER_API_KEY": KEY})
    access.admit(key).require("lab", "sensor")
    for session, role in (("lab", "monitor"), ("hall", "sensor")):
        with pytest.raises(NotAdmitted):
            access.admit(key).require(session, role)
    access.admit(KEY).require(None, "operator")
    said = issue(secret.read_text().strip(), "x", ["monitor"], None, 9)
    assert access.admit(said).rights == {"monitor"}
    for environment in ({"AGENT_SERVER_SECRET": "short"}, {"AGENT_SERVER_API_KEY": "short"}):
        with pytest.raises(ConfigError, match="too short") as caught:
            load_access(AccessSettings(), environment)
        assert '"short"' not in str(caught.value)


def test_a_public_key_checks_what_a_private_one_has_signed(tmp_path):
    private = Ed25519PrivateKey.generate()
    public = private.public_key().public_bytes(Encoding.PEM, PublicFormat.SubjectPublicKeyInfo)
    path = tmp_path / "public.pem"
    path.write_bytes(public)
    access = load_access(AccessSettings(secret_file=str(path)), {})
    assert access.admit(token(secret=private)).sessions == {"s"}
    # The classic: the public key, which everybody knows, taken for a secret of HS256.
    head = jwt.utils.base64url_encode(b'{"alg":"HS256","typ":"JWT"}').decode()
    body = token(secret=private).split(".")[1]
    mac = jwt.algorithms.HMACAlgorithm(jwt.algorithms.HMACAlgorithm.SHA256)
    signature = jwt.utils.base64url_encode(mac.sign(f"{head}.{body}".encode(), public)).decode()
    with pytest.raises(NotAdmitted) as caught:
        access.admit(f"{head}.{body}.{signature}")
    assert caught.value.code == "bad_token"


def make_certificate(cert, key):
    made = (
        "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=localhost"
    )
    name = "subjectAltName=IP:127.0.0.1,DNS:localhost"
    command = ["openssl", *made.split(), "-keyout", key, "-out", cert, "-addext", name]
    subprocess.run(command, check=True, capture_output=True)


async def test_tls_is_spoken_directly(tmp_path):
    cert, key = tmp_path / "cert.pem", tmp_path / "key.pem"
    make_certificate(cert, key)
    settings = Settings(server=ServerSettings(tls_cert=str(cert), tls_key=str(key)))
    check_exposure(settings, Access({}))
    trust = ssl.create_default_context(cafile=cert)
    async with live(settings=settings, access=ACCESS) as server:
        assert server.url.startswith("https://")
        async with httpx.AsyncClient(base_url=server.url, verify=trust) as http:
            answer = await http.get("/", params={"token": token()})
            assert "Secure" in answer.headers["Set-Cookie"]
            assert "max-age" in answer.headers["Strict-Transport-Security"]
        assert (await end_of(server.url, said=token(), ssl=trust))[0] == "welcome"
        with pytest.raises(ssl.SSLError):
            await end_of(server.url, said=token())
    cert.write_text("nothing")
    with pytest.raises(ConfigError, match="TLS cannot be served"):
        check_exposure(settings, Access({}))


async def test_a_silent_tcp_connection_costs_nobody_a_place():
    settings = Settings(server=ServerSettings(handshake_timeout_s=0.3, max_connections=4))
    async with live(settings=settings) as server:
        host, port = server.url.removeprefix("http://").split(":")
        silent = [socket.create_connection((host, int(port))) for _ in range(4)]
        await asyncio.sleep(0.8)
        async with httpx.AsyncClient() as http:
            assert (await http.get(f"{server.url}/healthz")).status_code == 200
        for one in silent:
            one.close()
