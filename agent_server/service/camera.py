"""Images of a face: looked at off the event loop, and of each person always the latest."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from agent_server.domain.face import FaceLandmarks
from agent_server.face.image import decode_jpeg, use_one_thread
from agent_server.face.tracker import FaceTracker
from agent_server.protocol.faces import round_points
from agent_server.service.audience import Client
from agent_server.service.models import FaceNetworks


class Eyes:
    """One thread that finds faces in images for all sessions.

    Args:
        networks: What finds them.
    """

    def __init__(self, networks: FaceNetworks) -> None:
        self._networks = networks
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="eyes", initializer=use_one_thread)

    def tracker(self) -> FaceTracker:
        """A tracker for one person."""
        return FaceTracker(self._networks.detector, self._networks.mesh)

    async def look(self, tracker: FaceTracker, jpeg: bytes, stamp_ns: int) -> FaceLandmarks | None:
        """Find the face in an image when the thread is free.

        Raises:
            InvalidInput: If it is no image that can be used.
            InferenceError: If a network fails.
        """
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._thread, _look, tracker, jpeg, stamp_ns)

    def close(self) -> None:
        """Take nothing any more."""
        self._thread.shutdown(wait=False, cancel_futures=True)


@dataclass(frozen=True, slots=True)
class WaitingImage:
    """An image that nobody has looked at yet."""

    client: Client
    jpeg: bytes
    stamp_ns: int
    arrival_ns: int


class Camera:
    """The images of one session.

    Args:
        eyes: What finds faces.
    """

    def __init__(self, eyes: Eyes) -> None:
        self._eyes = eyes
        self._tracker = eyes.tracker()
        self._latest: WaitingImage | None = None
        self._wake = asyncio.Event()

    def push(self, client: Client, jpeg: bytes, stamp_ns: int, arrival_ns: int) -> bool:
        """Take an image; tells whether one that still waited was given up for it."""
        was_waiting = self._latest is not None
        self._latest = WaitingImage(client, jpeg, stamp_ns, arrival_ns)
        self._wake.set()
        return was_waiting

    async def take(self) -> WaitingImage:
        """Wait for the next image."""
        while self._latest is None:
            self._wake.clear()
            await self._wake.wait()
        image, self._latest = self._latest, None
        return image

    async def look(self, image: WaitingImage) -> FaceLandmarks | None:
        """Find the face in an image.

        Raises:
            InvalidInput: If it is no image that can be used.
            InferenceError: If a network fails.
        """
        return await self._eyes.look(self._tracker, image.jpeg, image.stamp_ns)


def _look(tracker: FaceTracker, jpeg: bytes, stamp_ns: int) -> FaceLandmarks | None:
    image = decode_jpeg(jpeg)
    found = tracker.look(image)
    if found is None:
        return None
    points = round_points(found.points.astype(np.float64)).astype(np.float32)
    height, width = image.shape[:2]
    return FaceLandmarks(stamp_ns, found.layout, points, width, height)
