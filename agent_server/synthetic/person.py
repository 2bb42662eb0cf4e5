"""Who moves and where they are: body proportions, style, posture and place before the sensor.

Segment lengths are fractions of the stature after Drillis and Contini, *Body Segment
Parameters* (1966, as tabulated in Winter, *Biomechanics and Motor Control of Human
Movement*, 4th ed., fig. 4.1), with the landmark heights of ANSUR II (Gordon et al. 2014) for
the neck and the navel. Statures are those of ANSUR II widened by the shorter and taller
people of NCD-RisC (2016).
"""

from dataclasses import dataclass
from typing import Literal, Self

import numpy as np

Side = Literal["left", "right"]
Sex = Literal["female", "male"]
SIDES: tuple[Side, Side] = ("left", "right")
REFERENCE_HEIGHT_M = 1.75
"""Stature of the person for whom all hand positions of gestures are written."""

_STATURE_M: dict[Sex, tuple[float, float]] = {"female": (1.635, 0.070), "male": (1.760, 0.075)}
_SHOULDER_HALF: dict[Sex, float] = {"female": 0.103, "male": 0.110}
_HIP_HALF: dict[Sex, float] = {"female": 0.052, "male": 0.049}


@dataclass(frozen=True, slots=True)
class Person:
    """A body and a way of moving, kept for everything that a subject does.

    Attributes:
        subject: Name, so that people can be held out.
        sex: Which proportions were drawn.
        height_m: Stature, in metres.
        upper_arm_m: Shoulder to elbow.
        forearm_m: Elbow to wrist.
        hand_m: Wrist to fingertips.
        shoulder_half_m: From the middle of the trunk out to a shoulder joint.
        shoulder_drop_m: From the neck's base down to the height of the shoulder joints.
        lower_spine_m: Pelvis to navel.
        upper_spine_m: Navel to the neck's base.
        head_m: Neck's base to the middle of the head.
        hip_half_m: From the pelvis out to a hip joint.
        thigh_m: Hip to knee.
        shank_m: Knee to ankle.
        foot_m: Ankle to the ball of the foot.
        handedness: Which hand does what one hand can do.
        tempo: Speed of movement against the average, around 1.
        vigour: Size of movement against the average, around 1.
        liveliness: Size of involuntary movement against the average, around 1.
        asymmetry_s: Typical delay between both hands, in seconds.
    """

    subject: str
    sex: Sex
    height_m: float
    upper_arm_m: float
    forearm_m: float
    hand_m: float
    shoulder_half_m: float
    shoulder_drop_m: float
    lower_spine_m: float
    upper_spine_m: float
    head_m: float
    hip_half_m: float
    thigh_m: float
    shank_m: float
    foot_m: float
    handedness: Side
    tempo: float
    vigour: float
    liveliness: float
    asymmetry_s: float

    @property
    def scale(self) -> float:
        """Stature against the reference person's."""
        return self.height_m / REFERENCE_HEIGHT_M

    @classmethod
    def sample(cls, rng: np.random.Generator, *, subject: str) -> Self:
        """Draws a person."""
        sex: Sex = "female" if rng.random() < 0.5 else "male"
        mean, deviation = _STATURE_M[sex]
        height = float(np.clip(rng.normal(mean, deviation), 1.45, 2.02))

        def segment(fraction: float, spread: float = 0.035) -> float:
            return height * fraction * float(np.clip(rng.normal(1, spread), 0.88, 1.12))

        return cls(
            subject=subject,
            sex=sex,
            height_m=height,
            upper_arm_m=segment(0.176),
            forearm_m=segment(0.146),
            hand_m=segment(0.108),
            shoulder_half_m=segment(_SHOULDER_HALF[sex], 0.05),
            shoulder_drop_m=segment(0.030, 0.06),
            lower_spine_m=segment(0.090, 0.05),
            upper_spine_m=segment(0.218),
            head_m=segment(0.098, 0.045),
            hip_half_m=segment(_HIP_HALF[sex], 0.05),
            thigh_m=segment(0.245),
            shank_m=segment(0.246),
            foot_m=segment(0.105),
            handedness="right" if rng.random() < 0.89 else "left",
            tempo=float(np.exp(rng.normal(0.1, 0.2))),
            vigour=float(np.exp(rng.normal(0, 0.15))),
            liveliness=float(np.exp(rng.normal(0, 0.45))),
            asymmetry_s=float(abs(rng.normal(0, 0.05))),
        )


@dataclass(frozen=True, slots=True)
class Placement:
    """How and where somebody stands or sits before the sensor.

    Attributes:
        seated: Whether they sit.
        slouch_rad: Forward pitch of the trunk at rest.
        list_rad: Sideways roll of the trunk at rest.
        heading_rad: Turn of the body about the vertical; 0 faces the sensor's plane, positive
            turns to the person's left.
        distance_m: Depth of the pelvis before the sensor.
        lateral_m: x of the pelvis.
        sensor_height_m: Height of the sensor over the floor.
        sensor_tilt_rad: Pitch of the sensor; positive looks up.
        seat_m: Height of the hip joints over the floor when seated.
    """

    seated: bool
    slouch_rad: float
    list_rad: float
    heading_rad: float
    distance_m: float
    lateral_m: float
    sensor_height_m: float
    sensor_tilt_rad: float
    seat_m: float

    @classmethod
    def sample(cls, rng: np.random.Generator, *, seated: bool | None = None) -> Self:
        """Draws a placement; ``seated`` fixes the posture."""
        sits = bool(rng.random() < 0.4) if seated is None else seated
        distance = rng.uniform(1.2, 2.6) if sits else rng.triangular(1.4, 2.4, 3.5)
        turned = rng.random() < 0.3
        heading = rng.uniform(-45, 45) if turned else np.clip(rng.normal(0, 9), -45, 45)
        return cls(
            seated=sits,
            slouch_rad=float(np.radians(rng.normal(6, 6) if sits else rng.normal(2, 3))),
            list_rad=float(np.radians(rng.normal(0, 1.5))),
            heading_rad=float(np.radians(heading)),
            distance_m=float(distance),
            lateral_m=float(np.clip(rng.normal(0, 0.12), -0.35, 0.35) * distance),
            sensor_height_m=float(rng.uniform(0.6, 1.6)),
            sensor_tilt_rad=float(np.radians(rng.normal(0, 4))),
            seat_m=float(rng.uniform(0.46, 0.58)),
        )
