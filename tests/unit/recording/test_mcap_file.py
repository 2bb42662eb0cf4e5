"""The bytes of a file are those of the library's own writer, at its level."""

from io import BytesIO

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from agent_server.recording.mcap_file import McapFile

MESSAGES = [
    (channel, 1000 * (7 * index % 50), index, b"%d" % index * (index % 9))
    for index in range(60)
    for channel in ((1, 2) if index < 30 else (2,))
]


def by_library(count: int) -> bytes:
    output = BytesIO()
    writer = Writer(
        output, chunk_size=1 << 62, compression=CompressionType.ZSTD, enable_data_crcs=True
    )
    writer.start(library="x")
    writer.add_metadata("a", {"b": "c"})
    for name in ("one", "two"):
        writer.register_channel(name, "json", writer.register_schema(name, "jsonschema", b"{}"))
    for index, (channel, stamp_ns, sequence, data) in enumerate(MESSAGES[:count]):
        writer.add_message(channel, stamp_ns, data, stamp_ns, sequence)
        if index % 25 == 24:
            writer.flush()
    writer.finish()
    return output.getvalue()


def by_us(count: int, level: int = 3) -> bytes:
    output = BytesIO()
    file = McapFile(output, "x", level)
    file.metadata("a", {"b": "c"})
    for name in ("one", "two"):
        file.channel(name, "json", file.schema(name, "jsonschema", b"{}"))
    for index, message in enumerate(MESSAGES[:count]):
        file.message(*message)
        if index % 25 == 24:
            file.flush()
    file.finish()
    return output.getvalue()


@pytest.mark.parametrize("count", [0, 1, 25, 26, len(MESSAGES)])
def test_the_bytes_are_the_librarys(count: int) -> None:
    assert by_us(count) == by_library(count)


def test_another_level_holds_the_same_messages() -> None:
    reader = make_reader(BytesIO(by_us(len(MESSAGES), level=9)), validate_crcs=True)
    found = [m for _, _, m in reader.iter_messages(log_time_order=False)]
    assert [(m.channel_id, m.log_time, m.sequence, m.data) for m in found] == MESSAGES
