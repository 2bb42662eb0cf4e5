"""How connections ended and how fast they came back, of all sessions of a trial."""

from collections import Counter
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Restart:
    """A server that was killed, and that took connections again; on the monotonic clock."""

    killed_ns: int
    ready_ns: int


def resumes(lanes, restarts):
    """Times from the last cut, or from a server that is there again, to the next welcome."""
    cut, ready = [], []
    for lane in lanes:
        told = [line.at_ns for line in lane.console.lines if line.event == "welcome"]
        losses = [(one.at_ns, cut) for one in lane.proxy.cuts]
        losses += [(one.ready_ns, ready) for one in restarts]
        since_ns = 0
        for connection in lane.proxy.connections:
            welcomed_ns = connection.welcomed_ns
            if welcomed_ns is None:
                continue
            before = [loss for loss in losses if since_ns < loss[0] < welcomed_ns]
            heard_ns = next((at_ns for at_ns in told if at_ns >= welcomed_ns), None)
            if before and heard_ns is not None:
                lost_ns, into = max(before, key=lambda loss: loss[0])
                into.append((heard_ns - lost_ns) / 1e6)
            since_ns = welcomed_ns
    return {"resume_ms": spread(cut), "restart_resume_ms": spread(ready)}


def welcomes(lanes):
    """How often clients were welcomed, into how many ledgers, and whether they resumed."""
    said = [[line.said for line in lane.console.lines if line.event == "welcome"] for lane in lanes]
    return {
        "welcomes": sum(map(len, said)),
        "ledgers": sum(len({one["ledger"] for one in lane}) for lane in said),
        "not_resumed": sum(not one["resumed"] for lane in said for one in lane[1:]),
    }


def unforced(lanes, restarts):
    """Connections that ended though nobody cut them and no server was killed."""
    found = Counter()
    for lane in lanes:
        for one in lane.proxy.connections[:-1]:
            if one.ended_by not in ("client", "server"):
                continue
            if any(r.killed_ns <= one.ended_ns <= r.ready_ns for r in restarts):
                continue
            found[f"{one.ended_by} {one.close_code}"] += 1
    return dict(found)


def spread(times_ms):
    """Percentiles of times in milliseconds."""
    if not times_ms:
        return {"count": 0}
    p50, p95, largest = np.percentile(times_ms, (50, 95, 100))
    return {
        "count": len(times_ms),
        "p50": round(p50, 1),
        "p95": round(p95, 1),
        "max": round(largest, 1),
    }
