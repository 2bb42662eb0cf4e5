"""The way of a frame to its decision, gone a few times before anybody is waiting for it."""

import numpy as np

from agent_server.config import Settings
from agent_server.domain.skeleton import CORE_JOINT_NAMES, SkeletonFrame
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import convert
from agent_server.scene.rulebook import Rules
from agent_server.service.core import Core, PendingWindow
from agent_server.service.worker import InferenceWorker
from agent_server.stages.react import react

RATE_HZ = 30
SECONDS = 2
_STANDING = {
    "head": (0.0, 0.6, 2.0),
    "neck": (0.0, 0.35, 2.0),
    "navel": (0.0, 0.0, 2.0),
    "left_shoulder": (-0.18, 0.3, 2.0),
    "left_elbow": (-0.22, 0.05, 1.97),
    "left_wrist": (-0.22, -0.18, 1.9),
    "right_shoulder": (0.18, 0.3, 2.0),
    "right_elbow": (0.22, 0.05, 1.97),
    "right_wrist": (0.22, -0.18, 1.9),
}
"""Nine joints of somebody who stands before the sensor, metres in the camera frame."""


async def warm_up(worker: InferenceWorker, settings: Settings, rules: Rules) -> int:
    """Let somebody stand before a core of its own, and throw the decisions away.

    Returns:
        How many decisions were made; fewer than it should be where a model fails.

    Raises:
        InferenceError: If the classifier fails.
    """
    core = Core("warm-up", settings, rules, worker.models)
    joints = np.array([(*_STANDING[name], 1.0) for name in CORE_JOINT_NAMES], dtype=np.float32)
    decisions = 0
    for index in range(SECONDS * RATE_HZ):
        frame = SkeletonFrame(index * NS_PER_S // RATE_HZ, 0, "core9", joints)
        for job in core.observe(frame):
            if isinstance(job, PendingWindow):
                inference = await worker.infer(job.window)
                result = core.decide(job, inference.forecast, inference.classification)
                convert.decision_body(result.decision)
                decisions += 1
                reactor = worker.models.reactor
                if reactor is not None and decisions == 1:
                    making = react(reactor, job.window, inference.forecast, seed="warm-up")
                    while not (await worker.go_on(making)).is_last:
                        pass
    return decisions
