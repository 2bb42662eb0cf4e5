"""Whatever is asked over HTTP is answered: nothing that schemathesis asks breaks the server."""

import asyncio
import re
import threading
import warnings
from contextlib import contextmanager

import httpx
import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.checks import not_a_server_error

from agent_server.config import ModelSettings, Settings
from agent_server.service.auth import ANYBODY, Access, digest_of
from tests.support.live import live

KEY = "a key of an operator, long enough too"
BEARER = {"Authorization": f"Bearer {KEY}"}


@contextmanager
def serving(folder):
    """A server with one open session, on an event loop of its own, for tests that do not await."""
    ready, stop = threading.Event(), None
    found = {}

    async def run():
        nonlocal stop
        stop = asyncio.Event()
        access = Access({digest_of(KEY): ANYBODY})
        chosen = Settings(models=ModelSettings(folder=str(folder)))
        async with live(settings=chosen, access=access) as server:
            found["url"], found["loop"] = server.url, asyncio.get_running_loop()
            ready.set()
            await stop.wait()

    thread = threading.Thread(target=lambda: asyncio.run(run()), name="server")
    thread.start()
    ready.wait(60)
    try:
        yield found["url"]
    finally:
        found["loop"].call_soon_threadsafe(stop.set)
        thread.join()


@pytest.fixture(scope="module")
def url(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("bundles")) as address:
        yield address


def operations(url):
    document = httpx.get(f"{url}/openapi.json", headers=BEARER).json()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        schema = schemathesis.openapi.from_dict(document)
        schema.config.update(base_url=url)
        return [found.ok() for found in schema.get_all_operations()]


def test_no_request_is_a_server_error(url, caplog):
    found = operations(url)
    assert {one.path for one in found} >= {"/v1/sessions", "/v1/stand-in", "/v1/models/{which}"}
    for operation in found:
        asked = []

        @given(case=operation.as_strategy())
        @settings(
            max_examples=25,
            deadline=None,
            database=None,
            derandomize=True,
            phases=[Phase.explicit, Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        def ask(case):
            answer = case.call(headers=BEARER, timeout=20)
            asked.append(answer.status_code)  # noqa: B023 - it is called within this round
            # Readiness is said by a 503.
            if case.path != "/readyz":
                case.validate_response(answer, checks=(not_a_server_error,))

        ask()
        assert asked, operation.path
    assert not [one for one in caplog.records if one.exc_info]


def test_without_a_token_nothing_but_health_is_told(url):
    for operation in operations(url):
        if operation.path in ("/healthz", "/readyz"):
            continue
        path = re.sub(r"\{\w+\}", "x", operation.path)
        assert httpx.request(operation.method, url + path).status_code == 401, operation.path
