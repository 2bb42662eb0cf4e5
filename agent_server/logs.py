"""Logs for people, or for machines: one JSON object a line, with session and decision ids."""

import logging
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import Literal

import msgspec

LogFormat = Literal["text", "json"]

current_session: ContextVar[str | None] = ContextVar("current_session", default=None)
"""Session whose work is being done; tasks take it over from the one that starts them."""


def set_up_logs(log_format: LogFormat, *, verbose: bool) -> None:
    """Decide what is written to stderr, and how."""
    handler = logging.StreamHandler()
    handler.setFormatter(
        JsonFormatter()
        if log_format == "json"
        else logging.Formatter("%(asctime)s %(levelname)-7s %(name)s: %(message)s")
    )
    logging.basicConfig(level=logging.INFO if verbose else logging.WARNING, handlers=[handler])


class JsonFormatter(logging.Formatter):
    """Writes ``time``, ``level``, ``logger``, ``message``; ids and a traceback where there are."""

    def format(self, record: logging.LogRecord) -> str:
        """One line."""
        fields = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
            "session": getattr(record, "session", current_session.get()),
            "decision": getattr(record, "decision", None),
            "error": self.formatException(record.exc_info) if record.exc_info else None,
        }
        told = {name: value for name, value in fields.items() if value is not None}
        return msgspec.json.encode(told).decode()
