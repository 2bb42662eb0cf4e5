"""What one decision costs, stage by stage, on one thread."""

import time
from collections import defaultdict
from dataclasses import dataclass

from agent_server.bench.figures import Percentiles, percentiles
from agent_server.bench.stream import recorded_events
from agent_server.config import Settings
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks
from agent_server.domain.inputs import SensorInput
from agent_server.domain.motion import BodyLost
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.scene.rulebook import Rules
from agent_server.service.core import Core
from agent_server.service.models import Models
from agent_server.stages.classify import classify
from agent_server.stages.futures import draw_futures
from agent_server.stages.predict import predict


@dataclass(frozen=True, slots=True)
class DecisionResult:
    """Time from the frame that completes a window to its decision.

    Attributes:
        p50_ms: Median of all stages together.
        p95_ms: Their 95th percentile.
        p99_ms: Their 99th percentile.
        stages: Percentiles of ``window`` (ingest of the last frame and the window), ``predict``
            , ``futures`` (what draws
            several, nothing where there is one), ``classify`` and ``decide`` (gate,
            hysteresis and room); and of ``affect``, which reads a face when one comes.
        decisions: How many were measured.
    """

    p50_ms: float
    p95_ms: float
    p99_ms: float
    stages: dict[str, Percentiles]
    decisions: int


def measure_decisions(models: Models, rules: Rules, rounds: int) -> DecisionResult:
    """Run a synthetic stream through the core, again and again; the first round warms up."""
    events = recorded_events("demo")
    times: dict[str, list[float]] = {}
    for index in range(rounds + 1):
        if index == 1:
            times = defaultdict(list)
        _run(models, rules, events, times if index else defaultdict(list))
    total = percentiles(times.pop("total"))
    return DecisionResult(
        p50_ms=total.p50_ms,
        p95_ms=total.p95_ms,
        p99_ms=total.p99_ms,
        stages={stage: percentiles(values) for stage, values in times.items()},
        decisions=len(times["predict"]),
    )


def _run(
    models: Models, rules: Rules, events: list[SensorInput], times: dict[str, list[float]]
) -> None:
    core = Core("bench", Settings(), rules, models)
    for event in events:
        if isinstance(event, FaceLandmarks | FaceBlendshapes):
            began = time.perf_counter_ns()
            core.look(event)
            times["affect"].append((time.perf_counter_ns() - began) / 1e6)
        if not isinstance(event, SkeletonFrame):
            continue
        marks = [time.perf_counter_ns()]
        jobs = core.observe(event)
        for job in jobs:
            if isinstance(job, BodyLost):
                core.lose_body(job)
                continue
            marks.append(time.perf_counter_ns())
            forecasts = predict(models.predictor, [job.window])
            marks.append(time.perf_counter_ns())
            if (drawing := models.drawing) is not None:
                forecasts = draw_futures(
                    drawing.sampler, drawing.count, drawing.least_quality, [job.window], forecasts
                )
            marks.append(time.perf_counter_ns())
            classification = classify(models.classifier, [job.window], forecasts)[0]
            marks.append(time.perf_counter_ns())
            core.decide(job, forecasts[0], classification)
            marks.append(time.perf_counter_ns())
            for stage, begin, end in zip(
                ("window", "predict", "futures", "classify", "decide"),
                marks,
                marks[1:],
                strict=False,
            ):
                times[stage].append((end - begin) / 1e6)
            times["total"].append((marks[-1] - marks[0]) / 1e6)
