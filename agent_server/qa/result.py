"""What a run of a suite came to, as it is kept on disk, compared and reported.

Everything but ``seconds`` is a function of recordings, models, rules and settings: the same
run gives the same values, whatever the number of processes. Times are milliseconds on the
recording's time line.
"""

from pathlib import Path
from typing import Literal

import msgspec

from agent_server.errors import InvalidInput

RUN_VERSION = 1
Status = Literal["passed", "failed", "skipped", "error"]
CheckKind = Literal["reaction", "quiet", "absent", "limit"]
HORIZONS_MS = (80, 160, 400, 560, 1000, 2000)
"""How far ahead forecasts are compared with what came."""


class Stretch(msgspec.Struct, frozen=True):
    """A label of the recording: who does what from ``onset_ms`` to ``offset_ms``."""

    gesture: str
    onset_ms: int
    offset_ms: int
    expected: str | None
    quiet: bool


class Step(msgspec.Struct, frozen=True, array_like=True):
    """One decision, in short.

    Attributes:
        window: Index of its window.
        at_ms: End of the window; under faults, when what completed the window came in.
        best: The most probable gesture ...
        probability: ... and its probability.
        gesture: The gesture that is held to be going on, or the candidate.
        outcome: What it came to.
        reaction: The reaction that it caused, or None.
        valence: Of the gate's face, or None.
        arousal: Of the gate's face, or None.
        reason: The sentence, where a gesture was going on and had not been answered.
    """

    window: int
    at_ms: int
    best: str
    probability: float
    gesture: str
    outcome: str
    reaction: str | None
    valence: float | None
    arousal: float | None
    reason: str = ""


class Check(msgspec.Struct, frozen=True):
    """One expectation and whether it was met.

    Attributes:
        kind: What is expected.
        name: What is expected, in words; unique in its recording.
        at_ms: Where on the recording; None for all of it.
        passed: Whether it was met.
        detail: What was found, in words.
        gesture: The gesture that asks for the reaction, where one does.
        expected: The reaction that is expected, for the kind ``reaction``.
        got: The reaction that came instead or in time, or None.
        delay_ms: From onset to that reaction, or None without one.
    """

    kind: CheckKind
    name: str
    at_ms: int | None
    passed: bool
    detail: str
    gesture: str | None = None
    expected: str | None = None
    got: str | None = None
    delay_ms: int | None = None


class ForecastError(msgspec.Struct, frozen=True):
    """Sums of joint errors at ``HORIZONS_MS``, over the windows whose future was seen.

    Attributes:
        windows: Number of windows a horizon.
        live: Sum of the forecasts' mean joint distances, in mm.
        zero_velocity: The same if the last pose is held.
    """

    windows: list[int]
    live: list[float]
    zero_velocity: list[float]


class Moment(msgspec.Struct, frozen=True):
    """Poses around a decision, to be drawn; mm from the navel, axes as the camera's.

    Attributes:
        at_ms: End of the window.
        title: Why it is shown.
        seen: Poses of the window, (pose, joint, axis).
        predicted: The forecast.
        truth: What came, as long as it was seen; a pose may be empty.
    """

    at_ms: int
    title: str
    seen: list[list[list[int]]]
    predicted: list[list[list[int]]]
    truth: list[list[list[int]]]


class CaseResult(msgspec.Struct, frozen=True):
    """What one recording came to.

    Attributes:
        name: Its file, relative to the suite.
        sha256: Of the file.
        status: ``skipped`` where nothing is expected, ``error`` where it cannot be replayed.
        error: Why it cannot, or None.
        origin: Where the recording comes from, by its own words.
        duration_ms: Its length.
        judged_ms: Of it, where a reaction would be a false one.
        checks: All expectations.
        false_at_ms: Times of reactions that nothing asks for.
        labels: Ground truth.
        steps: All decisions.
        forecast: Errors of the forecasts: in gestures, and elsewhere.
        moments: Poses worth seeing.
        recorded_latency_ms: From frame to decision, as a live server noted it.
        refused: Inputs that the core refused; only faults make any.
        seconds: How long the replay took.
    """

    name: str
    sha256: str
    status: Status
    error: str | None = None
    origin: str = ""
    duration_ms: int = 0
    judged_ms: int = 0
    checks: list[Check] = []
    false_at_ms: list[int] = []
    labels: list[Stretch] = []
    steps: list[Step] = []
    forecast: dict[str, ForecastError] = {}
    moments: list[Moment] = []
    recorded_latency_ms: list[float] = []
    refused: int = 0
    seconds: float = 0.0


class FaultResult(msgspec.Struct, frozen=True):
    """What the suite came to under one fault; the first row of a table is without any.

    Attributes:
        name: The fault with its size.
        right: Reactions that came as expected.
        asked: Reactions that were expected.
        false: Reactions that nothing asked for.
        hours: In which they would have been false.
        delay_p50_ms: Median delay of the right ones, or None.
        refused: Inputs that the core refused.
    """

    name: str
    right: int
    asked: int
    false: int
    hours: float
    delay_p50_ms: float | None
    refused: int


class Thresholds(msgspec.Struct, frozen=True):
    """When the gate opens: below this valence, above this size of arousal; on [-10, 10]."""

    valence: float
    arousal: float


class Run(msgspec.Struct, frozen=True):
    """A run of a suite.

    Attributes:
        suite: Its name.
        server_version: Version of the server.
        models: Bundle name -> first 12 hexadecimal digits of its hash.
        rules: Rule file, with the first 12 hexadecimal digits of its hash.
        gate: When its gate opens.
        cases: One a recording, by name.
        limits: Expectations over the whole suite.
        faults: The robustness table, empty unless it was asked for.
        version: Layout of the file.
    """

    suite: str
    server_version: str
    models: dict[str, str]
    rules: str
    gate: Thresholds
    cases: list[CaseResult]
    limits: list[Check] = []
    faults: list[FaultResult] = []
    version: int = RUN_VERSION

    @property
    def has_errors(self) -> bool:
        """Whether there is no verdict on a recording because it could not be replayed."""
        return any(case.status == "error" for case in self.cases)

    @property
    def passed(self) -> bool:
        """Whether every expectation was met and every recording could be replayed."""
        cases = all(case.status in ("passed", "skipped") for case in self.cases)
        return cases and all(check.passed for check in self.limits)


def save_run(run: Run, path: Path) -> None:
    """Write a run as JSON.

    Raises:
        InvalidInput: If the file cannot be written.
    """
    try:
        path.write_bytes(msgspec.json.encode(run) + b"\n")
    except OSError as error:
        raise InvalidInput(f"{path} cannot be written: {error.strerror or error}") from error


def load_run(path: Path) -> Run:
    """Read a run that was saved.

    Raises:
        InvalidInput: If the file is no run, or of another version.
    """
    try:
        run = msgspec.json.decode(path.read_bytes(), type=Run)
    except OSError as error:
        raise InvalidInput(f"{path} cannot be read: {error.strerror or error}") from error
    except msgspec.DecodeError as error:
        raise InvalidInput(
            f"{path} is no run of a suite ({error}): name a run.json that qa --out has written"
        ) from error
    if run.version != RUN_VERSION:
        raise InvalidInput(
            f"{path} has version {run.version}, this server reads {RUN_VERSION}: run the suite "
            "anew on the older state to have a baseline"
        )
    return run
