"""How fast clients came back: from the last cut on, by the connection that was welcomed."""

from types import SimpleNamespace

import pytest

from tests.support.connection_figures import Restart, resumes, spread, unforced, welcomes
from tests.support.console_clients import Line
from tests.support.fault_proxy import Connection, Cut
from tests.support.faults import How, Where

MS = 1_000_000


def lane(cuts=(), connections=(), told=()):
    """Cuts, (welcomed, ended, by) of connections and lines of welcome, in milliseconds."""
    return SimpleNamespace(
        proxy=SimpleNamespace(
            cuts=[Cut(at * MS, 0, Where.BETWEEN, How.FIN) for at in cuts],
            connections=[
                Connection(index, 0, welcomed and welcomed * MS, by, ended * MS)
                for index, (welcomed, ended, by) in enumerate(connections)
            ],
        ),
        console=SimpleNamespace(
            lines=[
                Line(at * MS, {"event": "welcome", "ledger": ledger, "resumed": resumed})
                for at, ledger, resumed in told
            ]
        ),
    )


def said(*times):
    return [(at, "a", index > 0) for index, at in enumerate(times)]


def test_the_time_runs_from_the_last_cut_to_the_line_of_the_connection_that_was_welcomed():
    one = lane(
        cuts=(100, 200, 900),
        connections=[(10, 100, "cut"), (None, 200, "cut"), (350, 900, "cut"), (950, 0, "")],
        # The first welcome was read after its connection had been cut.
        told=said(101, 360, 955),
    )
    figures = resumes([one], [])
    assert figures["resume_ms"] == {"count": 2, "p50": 107.5, "p95": 154.8, "max": 160.0}
    assert figures["restart_resume_ms"] == {"count": 0}


def test_a_restart_counts_from_where_the_server_is_there_again():
    one = lane(
        cuts=(100,),
        connections=[(10, 100, "cut"), (None, 300, "refused"), (700, 0, "")],
        told=said(11, 705),
    )
    figures = resumes([one], [Restart(150 * MS, 500 * MS)])
    assert figures["resume_ms"] == {"count": 0}
    assert figures["restart_resume_ms"]["max"] == pytest.approx(205)


def test_ends_that_nobody_forced_are_told():
    one = lane(
        connections=[
            (10, 100, "cut"),
            (110, 200, "server"),
            (210, 300, "server"),
            (310, 400, "client"),
            (410, 500, "client"),
        ]
    )
    # The second one ended with the server, and the last one by the client's goodbye.
    assert unforced([one], [Restart(195 * MS, 205 * MS)]) == {"server None": 1, "client None": 1}


def test_a_client_that_lost_its_ledger_is_told():
    figures = welcomes([lane(told=[(1, "a", False), (2, "a", True), (3, "b", False)])])
    assert figures == {"welcomes": 3, "ledgers": 2, "not_resumed": 1}


def test_percentiles_are_rounded():
    assert spread([1.26, 1.26]) == {"count": 2, "p50": 1.3, "p95": 1.3, "max": 1.3}
