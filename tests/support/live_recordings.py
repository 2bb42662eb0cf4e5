"""A recording as a live server would have made it, without waiting for one."""

from agent_server.config import Settings
from agent_server.domain.motion import BodyLost
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import messages as m
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.records import BodyGone, SensorChanged, WindowDone, WindowSkipped
from agent_server.recording.writer import RecordingWriter
from agent_server.stages.perceive import Perception


def write_live(source, output, session="lab-of-jane", skip=frozenset()):
    """Deal with a generated stream's inputs as a server does, and write its log of the core.

    ``skip`` are windows whose place newer ones took.
    """
    recording = open_recording(source)
    settings = Settings()
    perception = Perception(settings.window, settings.subject)
    metadata = RecordingMetadata(
        session=session,
        server_version="test",
        created="2026-05-04T09:30:00Z",
        description="Jane Doe in the lab.",
        origin="live",
    )
    with RecordingWriter(output, metadata) as writer:
        writer.append_core(SensorChanged(0, True, recording.metadata.face or "expected"))
        writer.append_output(m.SceneState("working", {"window": "open", "hifi": "high"}), 0)
        for event in recording.events():
            writer.append_input(event, (event.originating_ns + 5, event.originating_ns + 9))
            if not isinstance(event, SkeletonFrame):
                continue
            for job in perception.push(event):
                if isinstance(job, BodyLost):
                    writer.append_core(BodyGone(job.stamp_ns, job.body_id))
                elif job.index in skip:
                    writer.append_core(WindowSkipped(job.end_ns, job.index))
                else:
                    writer.append_core(WindowDone(job.end_ns, job.index))
        for label in recording.labels():
            writer.append_label(label)
