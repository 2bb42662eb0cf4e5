"""A run as JUnit XML, which every continuous integration shows."""

from pathlib import Path
from xml.sax.saxutils import quoteattr

from agent_server.errors import InvalidInput
from agent_server.qa.result import CaseResult, Check, Run


def write_junit(run: Run, path: Path) -> None:
    """Write one test suite a recording, and one test an expectation.

    Raises:
        InvalidInput: If the file cannot be written.
    """
    suites = [_suite(case) for case in run.cases]
    if run.limits:
        tests = "".join(_test(run.suite, check) for check in run.limits)
        failures = sum(not check.passed for check in run.limits)
        suites.append(_tag("testsuite", tests, name=run.suite, tests=len(run.limits),
                           failures=failures, errors=0, skipped=0, time="0"))  # fmt: skip
    text = _tag("testsuites", "".join(suites), name=run.suite)
    try:
        path.write_text(f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n', "utf-8")
    except OSError as error:
        raise InvalidInput(f"{path} cannot be written: {error.strerror or error}") from error


def _suite(case: CaseResult) -> str:
    tests = "".join(_test(case.name, check) for check in case.checks)
    if case.status == "error":
        said = _tag("error", message=case.error or "")
        tests = _tag("testcase", said, classname=case.name, name="replay")
    elif case.status == "skipped":
        said = _tag("skipped", message="it has no labels, and the suite expects nothing of it")
        tests = _tag("testcase", said, classname=case.name, name="replay")
    return _tag(
        "testsuite",
        tests,
        name=case.name,
        tests=max(len(case.checks), 1),
        failures=sum(not check.passed for check in case.checks),
        errors=int(case.status == "error"),
        skipped=int(case.status == "skipped"),
        time=f"{case.seconds:.3f}",
    )


def _test(owner: str, check: Check) -> str:
    failure = "" if check.passed else _tag("failure", message=check.detail)
    return _tag("testcase", failure, classname=owner, name=check.name)


def _tag(tag: str, content: str = "", /, **attributes: object) -> str:
    written = "".join(f" {key}={quoteattr(str(value))}" for key, value in attributes.items())
    return f"<{tag}{written}>{content}</{tag}>\n" if content else f"<{tag}{written}/>\n"
