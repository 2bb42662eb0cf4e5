"""What is generated from the messages: complete, consistent, and not stale."""

import json
from pathlib import Path

import jsonschema
import pytest
from typer.testing import CliRunner

from agent_server.cli.main import app
from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES
from agent_server.protocol.schema import files, reference
from agent_server.protocol.schema.json_schema import asyncapi, json_schema
from agent_server.protocol.schema.model import protocol

ROOT = Path(__file__).parents[3]
ENTRIES = json.loads((ROOT / "tests/fixtures/protocol/messages.json").read_text("utf-8"))
GOOD = [e for e in ENTRIES if e["outcome"] == "ok" and e["json"]]


def references(node):
    if isinstance(node, dict):
        if "$ref" in node:
            yield node["$ref"]
        for value in node.values():
            yield from references(value)
    elif isinstance(node, list):
        for value in node:
            yield from references(value)


def found(document, reference):
    node = document
    for part in reference.removeprefix("#/").split("/"):
        node = node[part]
    return node


@pytest.mark.parametrize("document", [json_schema(), asyncapi()], ids=["schema", "asyncapi"])
def test_every_reference_leads_somewhere(document):
    there = list(references(document))
    assert len(there) > 30
    for reference_ in there:
        assert found(document, reference_)


@pytest.mark.parametrize("entry", [pytest.param(e, id=e["name"]) for e in GOOD])
def test_every_good_message_is_valid_by_the_schema(entry):
    schema = json_schema()
    validator = jsonschema.Draft202012Validator(
        {"$ref": f"#/$defs/{entry['record']}", "$defs": schema["$defs"]}
    )
    assert list(validator.iter_errors(json.loads(entry["json"]))) == []


def test_the_schema_refuses_what_the_codec_refuses():
    schema = json_schema()
    bad = [e for e in ENTRIES if e["outcome"] == "error" and (e["json"] or "").startswith("{")]
    refused = 0
    for entry in bad:
        try:
            document = json.loads(entry["json"])
        except json.JSONDecodeError:
            continue
        assert not jsonschema.Draft202012Validator(schema).is_valid(document), entry["name"]
        refused += 1
    assert refused >= 8


def test_asyncapi_names_every_message_with_its_role():
    document = asyncapi()
    sent = {
        name: {ref["$ref"].rpartition("/")[2] for ref in operation["messages"]}
        for name, operation in document["operations"].items()
    }
    assert {"Hello", "Skeleton", "Image"} <= sent["sensorSends"]
    assert "Skeleton" not in sent["rendererSends"]
    assert {"AckMessage", "SceneEvent"} <= sent["rendererSends"]
    assert {"CommandMessage", "Welcome"} <= sent["rendererGets"]
    everything = set().union(*sent.values())
    assert {name for name, record in protocol().records.items() if record.tag} == everything


def test_every_code_is_in_the_documents():
    document = asyncapi()
    assert [c["code"] for c in document["x-close-codes"]] == [c.code for c in CLOSE_CODES]
    assert [c["code"] for c in document["x-error-codes"]] == [c.code for c in ERROR_CODES]
    text = reference.markdown()
    for code in CLOSE_CODES:
        assert f"| {code.code} |" in text
    for code in ERROR_CODES:
        assert f"| `{code.code}` |" in text


def test_every_code_that_the_server_uses_is_in_the_table():
    import re  # noqa: PLC0415

    known = {code.code for code in ERROR_CODES}
    used = set()
    for folder in ("protocol", "service", "transports", "stages", "face"):
        for path in (ROOT / "agent_server" / folder).rglob("*.py"):
            source = path.read_text("utf-8")
            used |= set(re.findall(r'code="([a-z_]+)"', source))
            used |= set(re.findall(r'ErrorMessage\(\s*"([a-z_]+)"', source))
    assert len(used) > 20
    # A value of the domain that is refused further in carries a code of its own kind.
    assert used - known == set()


def test_the_page_is_whole_and_escapes_what_it_shows():
    page = reference.page()
    assert page.count("<table>") == page.count("</table>") > 40
    assert "<script" not in page
    assert m.PROTOCOL in page


def test_the_files_of_the_checkout_are_what_the_messages_say():
    assert files.check(ROOT) == []


def test_the_command_says_what_is_stale_and_writes_it(tmp_path):
    run = CliRunner().invoke
    first = run(app, ["schema", "--check", "--json", "--out", str(tmp_path)])
    assert first.exit_code == 1
    assert set(json.loads(first.stdout)["stale"]) == set(files.generated())
    written = run(app, ["schema", "--json", "--out", str(tmp_path)])
    assert set(json.loads(written.stdout)["written"]) == set(files.generated())
    assert run(app, ["schema", "--check", "--out", str(tmp_path)]).exit_code == 0
    (tmp_path / "docs" / "asyncapi.json").write_text("{}")
    again = run(app, ["schema", "--check", "--json", "--out", str(tmp_path)])
    assert (again.exit_code, json.loads(again.stdout)) == (1, {"stale": ["docs/asyncapi.json"]})
