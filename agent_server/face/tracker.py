"""Following one face from image to image."""

from agent_server.domain.model import FaceNetwork
from agent_server.face.detector import FaceDetector
from agent_server.face.image import Pixels
from agent_server.face.mesh import FaceMesh, Mesh
from agent_server.face.regions import Region, region_of_points

MIN_PRESENCE = 0.5


class FaceTracker:
    """Finds the largest face and follows it.

    The region of the next image comes from the last points. When the network says that there is
    no face any more, faces are detected anew in the same image.

    Args:
        detector: A network of the role ``detector``.
        mesh: A network of the role ``mesh``.
    """

    def __init__(self, detector: FaceNetwork, mesh: FaceNetwork) -> None:
        self._detector = FaceDetector(detector)
        self._mesh = FaceMesh(mesh)
        self._region: Region | None = None

    def reset(self) -> None:
        """Forget the face that was followed."""
        self._region = None

    def look(self, image: Pixels) -> Mesh | None:
        """Find the face in the next image; None where there is none.

        Raises:
            InferenceError: If a network fails.
        """
        mesh = None if self._region is None else self._seen(image, self._region)
        mesh = mesh or self._found(image)
        self._region = None if mesh is None else region_of_points(mesh.points)
        return mesh

    def _found(self, image: Pixels) -> Mesh | None:
        """The largest face that the network agrees to be one."""
        seen = (self._seen(image, detection.region) for detection in self._detector.detect(image))
        return next((mesh for mesh in seen if mesh is not None), None)

    def _seen(self, image: Pixels, region: Region) -> Mesh | None:
        mesh = self._mesh.look(image, region)
        return mesh if mesh.presence >= MIN_PRESENCE else None
