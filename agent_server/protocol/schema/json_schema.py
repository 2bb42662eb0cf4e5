"""The messages as JSON Schema 2020-12, and the whole protocol as an AsyncAPI 3 document."""

from typing import Any, get_args

import msgspec

from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES
from agent_server.protocol.roles import (
    CLIENT_ALWAYS,
    CLIENT_SENDS,
    SERVER_ALWAYS,
    SERVER_SENDS,
)

ABOUT = (
    "Sensors send what a person does, the server predicts, classifies and decides, and commands "
    "go to a renderer, each taking effect once. Every message is a map with a `type`; unknown "
    "fields are ignored. Times are integer nanoseconds of monotonic clocks."
)
_MESSAGES = tuple(
    dict.fromkeys(
        (
            *get_args(m.ClientMessage),
            *get_args(m.PackedClientMessage),
            *get_args(m.ServerMessage),
            *get_args(m.PackedServerMessage),
        )
    )
)


def json_schema() -> dict[str, Any]:
    """Every message and part under ``$defs``; a document is any message of the JSON coding."""
    _, schemas = msgspec.json.schema_components(_MESSAGES, ref_template="#/$defs/{name}")
    names = dict.fromkeys(
        one.__name__ for one in (*get_args(m.ClientMessage), *get_args(m.ServerMessage))
    )
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"agent-server protocol {m.PROTOCOL}",
        "description": ABOUT,
        "oneOf": [{"$ref": f"#/$defs/{name}"} for name in names],
        "$defs": dict(sorted(schemas.items())),
    }


def asyncapi() -> dict[str, Any]:
    """Channels, operations, messages and schemas, from the server's point of view."""
    _, schemas = msgspec.json.schema_components(
        _MESSAGES, ref_template="#/components/schemas/{name}"
    )
    return {
        "asyncapi": "3.0.0",
        "info": {
            "title": "agent-server",
            "version": m.PROTOCOL,
            "description": ABOUT,
            "license": {"name": "Apache-2.0"},
        },
        "defaultContentType": "application/json",
        "servers": {
            "local": {
                "host": "127.0.0.1:8765",
                "protocol": "ws",
                "description": (
                    f"Subprotocols: `{m.SUBPROTOCOL_JSON}` is text, `{m.SUBPROTOCOL_MSGPACK}` is "
                    "MessagePack; without one it is JSON."
                ),
            }
        },
        "channels": {role: _channel(role) for role in get_args(m.Role)},
        "operations": {
            f"{role}{verb}": _operation(role, action, sent[role] + always)
            for role in get_args(m.Role)
            for verb, action, sent, always in (
                ("Sends", "receive", CLIENT_SENDS, CLIENT_ALWAYS),
                ("Gets", "send", SERVER_SENDS, SERVER_ALWAYS),
            )
        },
        "components": {
            "messages": {one.__name__: _message(one) for one in _MESSAGES},
            "schemas": dict(sorted(schemas.items())),
        },
        "x-close-codes": [
            {
                "code": one.code,
                "name": one.name,
                "meaning": one.meaning,
                "advice": one.advice,
                "retry": one.retry.value,
            }
            for one in CLOSE_CODES
        ],
        "x-error-codes": [
            {"code": one.code, "meaning": one.meaning, "advice": one.advice} for one in ERROR_CODES
        ],
    }


def _channel(role: m.Role) -> dict[str, Any]:
    both = (*CLIENT_ALWAYS, *CLIENT_SENDS[role], *SERVER_ALWAYS, *SERVER_SENDS[role])
    return {
        "address": f"/v1/sessions/{{session}}/{role}",
        "description": f"The websocket of a {role}.",
        "parameters": {
            "session": {"description": "1 to 64 letters, digits, `.`, `_`, `-` of your choice."}
        },
        "messages": {
            one.__name__: {"$ref": f"#/components/messages/{one.__name__}"}
            for one in dict.fromkeys(both)
        },
    }


def _operation(role: m.Role, action: str, messages: tuple[type[m.Message], ...]) -> dict[str, Any]:
    return {
        "action": action,
        "channel": {"$ref": f"#/channels/{role}"},
        "messages": [{"$ref": f"#/channels/{role}/messages/{one.__name__}"} for one in messages],
    }


def _message(message: type[m.Message]) -> dict[str, Any]:
    is_binary = message not in get_args(m.ClientMessage) + get_args(m.ServerMessage)
    doc = (message.__doc__ or "").strip().split("\n")[0]
    return {
        "name": str(message.__struct_config__.tag),
        "title": message.__name__,
        "summary": doc,
        "contentType": "application/vnd.msgpack" if is_binary else "application/json",
        "payload": {"$ref": f"#/components/schemas/{message.__name__}"},
    }
