from pathlib import Path

from agent_server.protocol.codes import CLOSE_CODES, ERROR_CODES
from agent_server.protocol.schema.csharp import csharp
from agent_server.protocol.schema.csharp_text import literal, parameter, pascal, text
from agent_server.protocol.schema.model import protocol

CORE = Path(__file__).parents[3] / "unity_bridge" / "Runtime" / "Core"


def test_the_files_in_the_package_are_those_that_are_generated():
    files = csharp()
    found = {f"Generated/{path.name}" for path in (CORE / "Generated").glob("*.cs")}
    assert found == set(files)
    for name, content in files.items():
        assert (CORE / name).read_text("utf-8") == content, name


def test_every_record_has_a_class_of_its_own():
    files = csharp()
    for record in protocol().records.values():
        base = "" if record.tag is None else " : Message"
        content = files[f"Generated/{record.name}.cs"]
        assert f"public sealed class {record.name}{base}\n" in content
        for field in record.fields:
            assert f"{pascal(field.name)} {{ get; }}" in content


def test_fields_say_sentence_unit_and_range():
    content = csharp()["Generated/CommandMessage.cs"]
    assert "It is not to be started later than this after it was issued. Unit: ms." in content
    assert "Command that is cut short by this one. Range: 1 to 160 characters. May be null." in (
        " ".join(content.replace("///", "").split())
    )


def test_codes_come_with_their_retry():
    content = csharp()["Generated/CloseCodes.cs"]
    for code in CLOSE_CODES:
        assert f"public const int {pascal(code.name)} = {code.code};" in content
        assert f"Retry.{pascal(code.retry)})," in content
    content = csharp()["Generated/ErrorCodes.cs"]
    assert content.count("new ErrorCode(") == len(ERROR_CODES)


def test_names_and_literals():
    assert pascal("max_message_bytes") == "MaxMessageBytes"
    assert parameter("object") == "@object"
    assert parameter("body_id") == "bodyId"
    assert literal(True) == "true"
    assert literal(-3.0) == "-3.0"
    assert literal(7) == "7"
    assert text('a"\\\n') == '"a\\"\\\\\\n"'
