"""Read-only arrays of a known shape, so that frozen values really are frozen."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float32 = NDArray[np.float32]
Float64 = NDArray[np.float64]


def frozen(values: ArrayLike, shape: tuple[int | None, ...]) -> Float32:
    """A read-only float32 array of ``shape``, where None stands for any length.

    Raises:
        ValueError: If the shape does not fit.
    """
    array = np.asarray(values, dtype=np.float32)
    if array.ndim != len(shape) or any(
        want is not None and want != got for want, got in zip(shape, array.shape, strict=True)
    ):
        wanted = "x".join("any" if n is None else str(n) for n in shape)
        raise ValueError(f"expected an array of shape {wanted}, got {array.shape}")
    if array.flags.writeable:
        array = array.view()
        array.flags.writeable = False
    return array
