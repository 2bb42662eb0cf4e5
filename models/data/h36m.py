"""Human3.6M joint positions at 25 Hz, with global translation and rotation removed.

``h36m/h36m_25fps.npz`` holds an int16 array a sequence, shape (frames, 32 joints, 3 axes), in
tenths of a millimetre; the key ``S5__walking_1`` names subject, action and take. Use is limited to
academic evaluation, so no weights that were trained on it ship.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import numpy as np

from agent_server.domain.arrays import Float32, frozen
from agent_server.errors import InvalidInput

SOURCE = "h36m"
LICENCE = "academic evaluation only"
JOINTS = 32
SUBJECTS = {
    "train": ("S1", "S6", "S7", "S8", "S9"),
    "validation": ("S11",),
    "test": ("S5",),
}
"""Split of the motion-prediction literature."""

Split = Literal["train", "validation", "test"]


def read_h36m(data: Path, split: Split) -> Mapping[str, Float32]:
    """Sequences of a split by key, in the order of their names.

    Args:
        data: Folder that holds ``h36m/``.
        split: ``train``, ``validation`` or ``test``.

    Returns:
        Key -> positions, shape (T, 32, 3), read-only, mm.

    Raises:
        InvalidInput: If the file is not there or an array does not fit the layout.
    """
    path = data / SOURCE / "h36m_25fps.npz"
    if not path.is_file():
        raise InvalidInput(f"{path} is missing: give the folder that holds {SOURCE}/ as --data")
    subjects = SUBJECTS[split]
    with np.load(path, allow_pickle=False) as archive:
        keys = sorted(key for key in archive.files if key.partition("__")[0] in subjects)
        sequences = {key: archive[key] for key in keys}
    for key, sequence in sequences.items():
        if sequence.ndim != 3 or sequence.shape[1:] != (JOINTS, 3):
            raise InvalidInput(f"{path}, {key}: shape {sequence.shape}, expected (T, {JOINTS}, 3)")
    return {key: frozen(array * 0.1, (None, JOINTS, 3)) for key, array in sequences.items()}


def complete_actions(sequences: Mapping[str, Float32]) -> dict[str, tuple[Float32, Float32]]:
    """Actions of which both takes are there, in alphabetical order: action -> its two takes."""
    pairs = {}
    for key in sequences:
        subject, _, rest = key.partition("__")
        action, _, take = rest.rpartition("_")
        second = f"{subject}__{action}_2"
        if take == "1" and second in sequences:
            pairs[action] = (sequences[key], sequences[second])
    return pairs
