"""The engine-free C# client: its own tests, and what keeps it free."""

import re

from tests.unity.build import (
    CORE,
    CORE_TESTS,
    NUNIT,
    compiled,
    core,
    needs_mono,
    run_nunit,
    sources,
)

SHARED_ATTRIBUTES = {"Test", "TestFixture", "SetUp"}
"""What NUnit 2.6 and the NUnit of Unity mean alike."""
SHARED_ASSERTIONS = {"AreEqual", "IsTrue", "Throws"}


@needs_mono
def test_the_nunit_tests_pass():
    library = compiled("AgentServer.Core.Tests.dll", sources(CORE_TESTS), (core(), NUNIT))
    assert "Failures: 0" in run_nunit(library)


def test_core_knows_no_engine_and_uses_no_reflection():
    text = "\n".join(path.read_text() for path in sources(CORE))
    for word in (
        "UnityEngine",
        "UnityEditor",
        "System.Reflection",
        "GetType()",
        "typeof(",
        "dynamic ",
    ):
        assert word not in text, word


def test_tests_use_only_what_both_versions_of_nunit_share():
    text = "\n".join(path.read_text() for path in sources(CORE_TESTS))
    attributes = set(re.findall(r"^\s*\[(\w+)\]\s*$", text, re.MULTILINE))
    assert attributes == SHARED_ATTRIBUTES
    assert set(re.findall(r"\bAssert\.(\w+)", text)) == SHARED_ASSERTIONS
