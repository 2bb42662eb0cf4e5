"""What sensors make of a clean body: their tick, joint placement, noise and failures.

Sources of the sizes: random error of Kinect depth grows with the square of the distance
(Khoshelham and Elberink 2012); joint errors of Kinect v1 and v2 against marker systems are
some centimetres, mostly constant offsets, larger while arms occlude the trunk (Wang et al.
2015; Otte et al. 2016; Xu and McGorry 2015); the SDKs flag joints as tracked, inferred and not
tracked; the lag of the skeleton is 60 to 110 ms (Livingston et al. 2012). Marker systems are
better than 2 mm (Windolf et al. 2008). Monocular pose is several times worse in depth.
The short-time structure of the noise was tuned on Kinect v1 recordings.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64, frozen
from agent_server.domain.skeleton import CoreJoint, SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.synthetic.body import BodyMotion
from agent_server.synthetic.failures import Weakness, exposure, fail
from agent_server.synthetic.noise import low_pass, speed, wander
from agent_server.synthetic.tables import Places, native_table, place_core, place_table


@dataclass(frozen=True, slots=True)
class Sensor:
    """A sensor and its errors.

    Attributes:
        name: Its name.
        format: Joint table of its native frames, or None where only core joints are modelled.
        places: Name of the joint placement, see :mod:`tables`.
        rate_hz: Frames a second.
        tick_jitter_s: Standard deviation of a frame's time about its tick.
        lost_frames: Share of frames that never arrive.
        fit_m: Constant error of a joint's place in one recording, standard deviation.
        wander_m: Slow error of a tracked joint at 2 m, standard deviation.
        wander_s: Correlation time of the slow error.
        jitter_m: Error from frame to frame at 2 m, standard deviation.
        depth_factor: Error along z against the others.
        depth_scale: Standard deviation of a constant relative error of depth differences.
        distance_power: How errors grow with the distance.
        lag_s: Time constant of the tracker's low-pass filter.
        weakness: How it fails on joints that are hard to see; None for never.
    """

    name: str
    format: str | None
    places: Places
    rate_hz: float
    tick_jitter_s: float
    lost_frames: float
    fit_m: float
    wander_m: float
    wander_s: float
    jitter_m: float
    depth_factor: float
    depth_scale: float
    distance_power: float
    lag_s: float
    weakness: Weakness | None


MOCAP = Sensor(
    name="mocap",
    format=None,
    places="marker",
    rate_hz=100.0,
    tick_jitter_s=0.0,
    lost_frames=0.0,
    fit_m=0.008,
    wander_m=0.0008,
    wander_s=0.2,
    jitter_m=0.0003,
    depth_factor=1.0,
    depth_scale=0.0,
    distance_power=0.0,
    lag_s=0.0,
    weakness=None,
)
KINECT_V2 = Sensor(
    name="kinect_v2",
    format="kinect_v2",
    places="kinect_v2",
    rate_hz=30.0,
    tick_jitter_s=0.0015,
    lost_frames=0.006,
    fit_m=0.009,
    wander_m=0.006,
    wander_s=0.35,
    jitter_m=0.0005,
    depth_factor=1.3,
    depth_scale=0.02,
    distance_power=2.0,
    lag_s=0.030,
    weakness=Weakness(failures_hz=0.55, jump_m=(0.05, 0.15), inferred=0.85, untracked_hz=0.03),
)
KINECT_V1 = Sensor(
    name="kinect_v1",
    format="kinect_v1",
    places="kinect_v1",
    rate_hz=30.0,
    tick_jitter_s=0.0030,
    lost_frames=0.012,
    fit_m=0.012,
    wander_m=0.008,
    wander_s=0.30,
    jitter_m=0.0003,
    depth_factor=1.2,
    depth_scale=0.03,
    distance_power=2.0,
    lag_s=0.040,
    weakness=Weakness(failures_hz=0.8, jump_m=(0.05, 0.17), inferred=0.35, untracked_hz=0.01),
)
WEBCAM = Sensor(
    name="webcam",
    format=None,
    places="webcam",
    rate_hz=30.0,
    tick_jitter_s=0.004,
    lost_frames=0.02,
    fit_m=0.012,
    wander_m=0.008,
    wander_s=0.30,
    jitter_m=0.0025,
    depth_factor=4.0,
    depth_scale=0.15,
    distance_power=1.0,
    lag_s=0.040,
    weakness=Weakness(failures_hz=0.5, jump_m=(0.05, 0.15), inferred=0.7, untracked_hz=0.02),
)
REFERENCE_DISTANCE_M = 2.0
STEPS_HZ = 5.0
"""How often a stepped error changes."""
_UNSURENESS = np.array([0.9, 0.7, 0.6, 0.8, 1.0, 1.2, 0.8, 1.0, 1.2])[:, None]
"""Error of each core joint against the typical one: the trunk is surer than the arms."""
SENSORS: tuple[Sensor, ...] = (KINECT_V2, KINECT_V1, MOCAP, WEBCAM)


class Moving(Protocol):
    """What a sensor looks at, for example a clip."""

    @property
    def duration_s(self) -> float:
        """Length of the motion, which begins at 0."""
        ...

    def at(self, times_s: Float64) -> BodyMotion:
        """The clean body at ``times_s``."""
        ...


@dataclass(frozen=True, slots=True)
class CoreObservation:
    """The core joints as a sensor saw them, at its own ticks.

    Attributes:
        stamps_s: Shape (T,), ascending, from the start of the motion.
        positions: Shape (T, 9, 3), read-only, metres in the camera frame; a joint that is not
            tracked keeps its last known position.
        confidence: Shape (T, 9), read-only: 1 tracked, 0.5 inferred, 0 not tracked.
    """

    stamps_s: Float64
    positions: Float32
    confidence: Float32


def observe_core(motion: Moving, sensor: Sensor, rng: np.random.Generator) -> CoreObservation:
    """Looks at a motion with a sensor and keeps the nine core joints."""
    stamps = _ticks(motion.duration_s, sensor, rng)
    body = motion.at(stamps)
    positions, confidence = _sense(body, sensor, rng)
    return CoreObservation(
        stamps, frozen(_kept(positions, confidence), (None, 9, 3)), frozen(confidence, (None, 9))
    )


def observe_frames(
    motion: Moving, sensor: Sensor, rng: np.random.Generator, body_id: int, start_ns: int
) -> list[SkeletonFrame]:
    """Looks at a motion with a sensor that has a joint table of its own.

    The core joints of the table carry the very noise that :func:`observe_core` gives with an
    equal ``rng``. Positions are rounded to 1 mm; a joint that is not tracked is all zeros.

    Args:
        motion: What happens.
        sensor: ``KINECT_V1`` or ``KINECT_V2``.
        rng: Where the noise comes from.
        body_id: The sensor's identity of the body.
        start_ns: Capture time of the start of the motion.

    Raises:
        InvalidInput: If the sensor's native frames are not modelled.
    """
    if sensor.format is None:
        raise InvalidInput(
            f"sensor is '{sensor.name}', which has no native frames here; use kinect_v1 or "
            "kinect_v2, or observe_core",
            field="sensor",
        )
    stamps = _ticks(motion.duration_s, sensor, rng)
    body = motion.at(stamps)
    core, core_confidence = _sense(body, sensor, rng)
    table = native_table(sensor.format)
    clean = place_table(body, sensor.format, sensor.places)
    # A joint beside the core ones goes wrong as the core joint does that it hangs on, and a
    # little on its own.
    error = (core - place_core(body, sensor.places))[:, table.follows]
    smooth, _ = wander(len(stamps), len(table.follows), _period(sensor), 1.0, rng)
    own = 0.5 * sensor.wander_m * smooth
    own += sensor.jitter_m * rng.standard_normal(clean.shape)
    own[:, table.core] = 0.0
    confidence = core_confidence[:, table.follows].copy()
    hidden = _hidden_feet(clean[:, table.feet], rng)
    confidence[:, table.feet] = np.where(hidden, 0.5, confidence[:, table.feet])
    joints = np.concatenate([np.round(clean + error + own, 3), confidence[..., None]], axis=2)
    joints[..., :3] *= confidence[..., None] > 0
    return [
        SkeletonFrame(start_ns + to_ns(stamp), body_id, sensor.format, frozen(frame, (None, 4)))
        for stamp, frame in zip(stamps, joints, strict=True)
    ]


def _ticks(duration_s: float, sensor: Sensor, rng: np.random.Generator) -> Float64:
    """When frames are taken: around the tick, some missing."""
    ticks = np.arange(0.0, duration_s, 1.0 / sensor.rate_hz)
    limit = 0.3 / sensor.rate_hz
    jitter = np.clip(rng.standard_normal(len(ticks)) * sensor.tick_jitter_s, -limit, limit)
    kept = rng.random(len(ticks)) >= sensor.lost_frames
    kept[0] = True
    return np.maximum(ticks + jitter, 0.0)[kept]


def _period(sensor: Sensor) -> int:
    """Frames after which slow errors are independent."""
    return max(2, round(sensor.wander_s * sensor.rate_hz))


def _sense(body: BodyMotion, sensor: Sensor, rng: np.random.Generator) -> tuple[Float64, Float64]:
    """Core joints with all errors, shape (T, 9, 3), and their confidence, shape (T, 9)."""
    clean = place_core(body, sensor.places)
    n = len(clean)
    axes = np.array([1.0, 1.0, sensor.depth_factor])
    depth = clean[..., 2] - clean[:, CoreJoint.NAVEL, None, 2]
    seen = clean.copy()
    seen[..., 2] += sensor.depth_scale * rng.standard_normal() * depth
    seen += sensor.fit_m * rng.standard_normal((9, 3)) * _UNSURENESS * axes
    far = (clean[..., 2:] / REFERENCE_DISTANCE_M) ** sensor.distance_power
    smooth, steps = wander(n, 9, _period(sensor), STEPS_HZ / sensor.rate_hz, rng)
    exposed = exposure(clean, body)
    hidden = exposed[..., None]
    # Little at rest, more in motion; a joint that is hidden is steady but for steps.
    moving = 0.10 + 0.8 * np.clip(speed(clean, body.times_s), 0.0, 1.0)[..., None]
    error = 1.5 * (moving + 0.3 * hidden) * smooth + 0.4 * (moving + 1.1 * hidden) * steps
    seen += sensor.wander_m * error * far * _UNSURENESS * axes
    confidence = np.ones((n, 9))
    if sensor.weakness is not None:
        fail(seen, confidence, exposed, body.times_s, sensor.weakness, rng)
    if sensor.lag_s:
        seen = low_pass(seen, sensor.lag_s * sensor.rate_hz)
    seen += sensor.jitter_m * rng.standard_normal((n, 9, 3)) * far * axes
    return seen, confidence


def _kept(positions: Float64, confidence: Float64) -> Float64:
    """Positions in which a joint that is not tracked stays where it was."""
    if confidence.all():
        return positions
    rows = np.arange(len(positions))[:, None]
    last = np.maximum.accumulate(np.where(confidence > 0, rows, 0), axis=0)
    return np.asarray(positions[last, np.arange(positions.shape[1])])


def _hidden_feet(feet: Float64, rng: np.random.Generator) -> NDArray[np.bool_]:
    """Feet below the view (27 degrees half angle) are inferred, now and then a foot in view."""
    below = feet[..., 1] < -0.5 * feet[..., 2]
    return np.asarray(below | (rng.random((1, feet.shape[1])) < 0.05))
