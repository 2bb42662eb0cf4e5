"""The body that every measurement watches: synthetic, seeded, Kinect v2 at 30 Hz."""

from agent_server.domain.inputs import SensorInput
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.synthetic.scenario import SCENARIOS, play


def recorded_events(name: str) -> list[SensorInput]:
    """Frames and faces of one of the generator's scenarios."""
    scenario = next(scenario for scenario in SCENARIOS if scenario.name == name)
    return list(play(scenario).events)


def recorded_frames(name: str) -> list[SkeletonFrame]:
    """Frames alone."""
    return [event for event in recorded_events(name) if isinstance(event, SkeletonFrame)]
