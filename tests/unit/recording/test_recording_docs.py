"""docs/recordings.md names everything that a recording can hold."""

from pathlib import Path
from typing import get_args

import msgspec
import pytest

from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import CoreEntry, LabelRecord
from agent_server.recording.topics import TOPICS

TEXT = (Path(__file__).parents[3] / "docs" / "recordings.md").read_text()
FULL = RecordingMetadata(
    *("s", "0", "none", "ntu", {"NAME": "1"}, "2025-01-01", "a", "b", "c"),
    *("1f", "2e", "P07", True, 2),
).to_strings()


@pytest.mark.parametrize("topic", TOPICS)
def test_every_topic_is_documented(topic: str) -> None:
    assert f"| `{topic}` |" in TEXT


@pytest.mark.parametrize("entry", get_args(CoreEntry), ids=lambda entry: entry.__name__)
def test_every_kind_of_the_core_log_is_documented(entry: type[msgspec.Struct]) -> None:
    (line,) = [
        row for row in TEXT.splitlines() if row.startswith(f"| `{entry.__struct_config__.tag}` |")
    ]
    for field in entry.__struct_fields__:
        assert field == "stamp_ns" or f"`{field}`" in line


@pytest.mark.parametrize("name", FULL)
def test_every_name_of_the_metadata_is_documented(name: str) -> None:
    assert f"`{name}`" in TEXT


@pytest.mark.parametrize("field", LabelRecord.__struct_fields__)
def test_every_field_of_a_label_is_documented(field: str) -> None:
    assert f'"{field}"' in TEXT
