"""Labels from tables and from ELAN."""

import pytest

from agent_server.domain.label import Label
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.qa.tools.elan import read_elan
from agent_server.recording.label_table import read_label_table

EAF = """<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT AUTHOR="" DATE="2026-01-01T00:00:00+01:00" FORMAT="3.0" VERSION="3.0">
 <HEADER MEDIA_FILE="" TIME_UNITS="milliseconds"/>
 <TIME_ORDER>
  <TIME_SLOT TIME_SLOT_ID="ts1" TIME_VALUE="4000"/>
  <TIME_SLOT TIME_SLOT_ID="ts2" TIME_VALUE="7500"/>
  <TIME_SLOT TIME_SLOT_ID="ts3" TIME_VALUE="10000"/>
  <TIME_SLOT TIME_SLOT_ID="ts4" TIME_VALUE="16000"/>
  <TIME_SLOT TIME_SLOT_ID="ts5" TIME_VALUE="12000"/>
  <TIME_SLOT TIME_SLOT_ID="ts6" TIME_VALUE="13000"/>
 </TIME_ORDER>
 <TIER LINGUISTIC_TYPE_REF="default" TIER_ID="gesture@anna">
  <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="ts1" TIME_SLOT_REF2="ts2">
   <ANNOTATION_VALUE>cold</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
  <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a4" TIME_SLOT_REF1="ts5" TIME_SLOT_REF2="ts6">
   <ANNOTATION_VALUE>loud</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
 </TIER>
 <TIER LINGUISTIC_TYPE_REF="child" PARENT_REF="gesture@anna" TIER_ID="expected">
  <ANNOTATION><REF_ANNOTATION ANNOTATION_ID="a2" ANNOTATION_REF="a1">
   <ANNOTATION_VALUE>close_window</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION>
 </TIER>
 <TIER LINGUISTIC_TYPE_REF="default" TIER_ID="Quiet">
  <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a3" TIME_SLOT_REF1="ts3" TIME_SLOT_REF2="ts4">
   <ANNOTATION_VALUE/></ALIGNABLE_ANNOTATION></ANNOTATION>
 </TIER>
 <TIER LINGUISTIC_TYPE_REF="default" TIER_ID="notes">
  <ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID="a9" TIME_SLOT_REF1="ts3" TIME_SLOT_REF2="ts4">
   <ANNOTATION_VALUE>sneezes</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION>
 </TIER>
</ANNOTATION_DOCUMENT>
"""


def table(tmp_path, text):
    path = tmp_path / "labels.csv"
    path.write_text(text, "utf-8")
    return path


def eaf(tmp_path, text=EAF):
    path = tmp_path / "labels.eaf"
    path.write_text(text, "utf-8")
    return path


def test_a_table_gives_labels(tmp_path):
    path = table(
        tmp_path,
        "gesture,onset_s,offset_s,subject,expected,quiet\n"
        "cold,4,7.5,anna,close_window,\n"
        ",8,10,anna,,yes\n",
    )
    assert read_label_table(path) == [
        Label("cold", to_ns(4), to_ns(7.5), "anna", "close_window", False),
        Label("idle", to_ns(8), to_ns(10), "anna", None, True),
    ]


def test_a_spreadsheet_may_write_semicolons_and_a_byte_order_mark(tmp_path):
    path = tmp_path / "labels.csv"
    path.write_text("gesture;onset_s;offset_s\nhot;1;2\n", "utf-8-sig")
    assert [label.gesture for label in read_label_table(path)] == ["hot"]


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("cold,four,5,,", "line 2: onset_s is 'four'"),
        ("cold,5,4,,", "line 2: onset_s is 5 and offset_s 4"),
        ("cold,1,2,,maybe", "line 2: quiet is 'maybe'"),
        ("cold,1,2,close_window,yes", "expects close_window and asks for quiet"),
        (",1,2,,", "line 2: gesture is empty"),
        ("cold,nan,2,,", "onset_s is 'nan'"),
    ],
)
def test_a_mistake_in_a_table_is_named(tmp_path, row, words):
    path = table(tmp_path, f"gesture,onset_s,offset_s,expected,quiet\n{row}\n")
    with pytest.raises(InvalidInput) as caught:
        read_label_table(path)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("gesture,onset_s\ncold,1\n", "lacks offset_s"),
        ("gesture,onset_s,offset_s,mood\n", "has mood"),
        ("gesture,onset_s,offset_s\n", "holds no label"),
        ("", "lacks gesture, onset_s, offset_s"),
    ],
)
def test_a_table_with_other_columns_is_refused(tmp_path, text, words):
    with pytest.raises(InvalidInput) as caught:
        read_label_table(table(tmp_path, text))
    assert words in str(caught.value)


def test_elan_gives_labels_with_reactions_quiet_and_subjects(tmp_path):
    assert read_elan(eaf(tmp_path)) == [
        Label("cold", to_ns(4), to_ns(7.5), "anna", "close_window", False),
        Label("loud", to_ns(12), to_ns(13), "anna", None, True),
    ]


def test_quiet_that_covers_no_gesture_is_a_label_of_its_own(tmp_path):
    moved = EAF.replace('"12000"', '"17000"').replace('"13000"', '"18000"')
    labels = read_elan(eaf(tmp_path, moved))
    assert Label("idle", to_ns(10), to_ns(16), "", None, True) in labels
    assert Label("loud", to_ns(17), to_ns(18), "anna", None, False) in labels


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("ANNOTATION_DOCUMENT", "OTHER", "is no ELAN file"),
        ("TIER_ID=", "TIER_NAME=", "has no annotation on a tier"),
        ('TIME_SLOT_ID="ts1"', 'TIME_SLOT_ID="tsX"', "annotation a1: it has no time"),
        ('ANNOTATION_REF="a1"', 'ANNOTATION_REF="a2"', "annotation a2: it has no time"),
        ("</TIME_ORDER>", "", "cannot be read"),
    ],
)
def test_a_mistake_in_an_elan_file_is_named(tmp_path, old, new, words):
    with pytest.raises(InvalidInput) as caught:
        read_elan(eaf(tmp_path, EAF.replace(old, new)))
    assert words in str(caught.value)


def test_a_reaction_that_no_gesture_asks_for_is_refused(tmp_path):
    text = EAF.replace('<REF_ANNOTATION ANNOTATION_ID="a2" ANNOTATION_REF="a1">', (
        '<ALIGNABLE_ANNOTATION ANNOTATION_ID="a2" TIME_SLOT_REF1="ts2" TIME_SLOT_REF2="ts3">'
    )).replace("</REF_ANNOTATION>", "</ALIGNABLE_ANNOTATION>")  # fmt: skip
    with pytest.raises(InvalidInput, match="expected where no gesture is"):
        read_elan(eaf(tmp_path, text))


def test_entities_of_xml_are_refused(tmp_path):
    bomb = '<!DOCTYPE a [<!ENTITY b "x">]>\n'
    text = EAF.replace("<ANNOTATION_DOCUMENT", bomb + "<ANNOTATION_DOCUMENT", 1)
    with pytest.raises(InvalidInput, match="cannot be read as an ELAN file"):
        read_elan(eaf(tmp_path, text))
