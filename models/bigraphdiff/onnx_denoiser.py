"""An exported denoiser, run the way a real-time program would: one thread."""

from pathlib import Path

import numpy as np
import torch

from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.bigraphdiff.diffusion import Denoise, Normaliser
from models.bigraphdiff.generate import Generator
from models.bigraphdiff.manifest import NORMALISER_FILE, InteractionManifest
from models.bigraphdiff.words import tokens
from models.ops.session import open_session

INPUTS = ("noisy", "lengths", "step", "words")
OUTPUT = "clean"


def open_denoiser(path: Path) -> Denoise:
    """The graph in a file, as :meth:`models.bigraphdiff.network.Denoiser.forward`."""
    session = open_session(path)

    def denoise(
        noisy: torch.Tensor, lengths: torch.Tensor, step: torch.Tensor, words: torch.Tensor
    ) -> torch.Tensor:
        values = zip(INPUTS, (noisy, lengths, step, words), strict=True)
        (clean,) = session.run([OUTPUT], {name: value.numpy() for name, value in values})
        return torch.from_numpy(clean)

    return denoise


def read_generator(bundle: Path) -> tuple[Generator, InteractionManifest]:
    """The generator of a bundle that is whole, and its manifest.

    Raises:
        BundleError: If it is not whole, or no generator of interactions.
    """
    manifest = read_manifest(bundle, InteractionManifest)
    with np.load(bundle / NORMALISER_FILE) as scale:
        normaliser = Normaliser(*(torch.from_numpy(scale[name]) for name in ("mean", "deviation")))
    generator = Generator(
        open_denoiser(bundle / MODEL_FILE),
        normaliser,
        tokens(manifest.labels),
        manifest.frames,
        manifest.steps,
        manifest.drawn_steps,
    )
    return generator, manifest
