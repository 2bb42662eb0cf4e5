"""The denoiser of two people's motion, on one page.

After Chopin et al., "Bipartite Graph Diffusion Model for Human Interaction Generation" (WACV
2024): a stream a person, each with efficient attention to its own frames and to the words of the
label, styled by the step of the diffusion; between the two a bipartite graph with a learned
adjacency, then a dense network.
Where this differs: a token keeps the features of a joint together, and the nodes of the graph are
the joints; the words are read by a small encoder that is trained along, and by no pretrained one;
the clean motion is predicted and not the noise, so that steps from frame to frame can be errors,
too; padding is masked, and there is no pose that means "end".
"""

import math

import torch
import torch.nn.functional as F
from torch import nn

from models.bigraphdiff.attention import NEVER, Dense, JointGraph, LinearAttention
from models.bigraphdiff.config import NetworkConfig

PEOPLE = 2


class WordEncoder(nn.Module):
    """A transformer of one layer over the words of a label."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.width
        self.heads = config.heads
        self.embed = nn.Embedding(config.vocabulary + 1, width)
        self.position = nn.Parameter(torch.randn(config.words, width) * 0.02)
        self.norm = nn.LayerNorm(width)
        self.queries_keys_values = nn.Linear(width, 3 * width)
        self.out = nn.Linear(width, width)
        self.dense = nn.Sequential(
            nn.LayerNorm(width),
            nn.Linear(width, 2 * width),
            nn.GELU(),
            nn.Linear(2 * width, width),
        )

    def forward(self, words: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Words (B, W) -> each word (B, W, D), and all of them as one (B, D)."""
        x = self.embed(words) + self.position
        counts = words > 0
        split = self.queries_keys_values(self.norm(x)).unflatten(-1, (3, self.heads, -1))
        q, k, v = split.permute(2, 0, 3, 1, 4)
        bias = torch.where(counts, 0.0, NEVER)[:, None, None]
        mixed = F.scaled_dot_product_attention(q, k, v, bias)
        x = x + self.out(mixed.transpose(1, 2).flatten(2))
        x = x + self.dense(x)
        share = counts / counts.sum(1, keepdim=True).clamp(min=1)  # a hidden label has no words
        return x, (x * share[..., None]).sum(1)


class StreamLayer(nn.Module):
    """One layer of one person's stream, without the graph, which stands between two of them."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.within, self.to_words = LinearAttention(config), LinearAttention(config)
        self.graph = JointGraph(config) if config.graph != "none" else None
        self.dense = Dense(config)

    def attend(
        self,
        x: torch.Tensor,
        mask: torch.Tensor,
        words: torch.Tensor,
        counts: torch.Tensor,
        style: torch.Tensor,
    ) -> torch.Tensor:
        """The first part: to the person's own frames, then to the words."""
        out: torch.Tensor = self.to_words(self.within(x, x, mask, style), words, counts, style)
        return out

    def forward(self, x: torch.Tensor, sender: torch.Tensor, style: torch.Tensor) -> torch.Tensor:
        """The second part: joints hear those of ``sender``, then the dense network."""
        if self.graph is not None:
            x = self.graph(x, sender)
        out: torch.Tensor = self.dense(x, style)
        return out


class Layer(nn.Module):
    """Both streams: attention, then the graph, then a dense network."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.between = config.graph == "between"
        self.streams = nn.ModuleList(StreamLayer(config) for _ in range(PEOPLE))

    def forward(
        self,
        people: list[torch.Tensor],
        mask: torch.Tensor,
        words: torch.Tensor,
        counts: torch.Tensor,
        style: torch.Tensor,
    ) -> list[torch.Tensor]:
        """Tokens of each person (B, T, D) -> the same.

        Args:
            people: Of each person.
            mask: True where a frame counts, (B, T).
            words: (B, W, D).
            counts: True where a word counts, (B, W).
            style: (B, D).
        """
        streams = [stream for stream in self.streams if isinstance(stream, StreamLayer)]
        people = [
            stream.attend(x, mask, words, counts, style)
            for stream, x in zip(streams, people, strict=True)
        ]
        senders = people[::-1] if self.between else people
        return [
            stream(x, sender, style)
            for stream, x, sender in zip(streams, people, senders, strict=True)
        ]


class Denoiser(nn.Module):
    """Noisy motion of two people and the words of a label -> the clean motion."""

    times: torch.Tensor

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config, width = config, config.width
        self.words = WordEncoder(config)
        self.named = nn.Linear(width, width)
        self.step = nn.Sequential(nn.Linear(width, width), nn.SiLU(), nn.Linear(width, width))
        self.embed = nn.ModuleList(nn.Linear(3, config.features) for _ in range(PEOPLE))
        self.joint = nn.Parameter(torch.randn(PEOPLE, config.joints, config.features) * 0.1)
        self.widen = nn.ModuleList(nn.Linear(width, width) for _ in range(PEOPLE))
        self.layers = nn.ModuleList(Layer(config) for _ in range(config.layers))
        self.norm = nn.ModuleList(nn.LayerNorm(width) for _ in range(PEOPLE))
        self.out = nn.Linear(PEOPLE * width, PEOPLE * config.joints * 3)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)
        self.register_buffer("times", waves(torch.arange(config.frames), width), persistent=False)

    def forward(
        self,
        noisy: torch.Tensor,
        lengths: torch.Tensor,
        step: torch.Tensor,
        words: torch.Tensor,
    ) -> torch.Tensor:
        """Take the noise away.

        Args:
            noisy: Shape (B, 2, T, J, 3), as :class:`models.bigraphdiff.diffusion.Normaliser`
                has motions; T is at most ``frames``.
            lengths: Shape (B,), frames that count; at least one.
            step: Shape (B,), how far the diffusion has gone, from 0.
            words: Shape (B, W), as :func:`models.bigraphdiff.words.tokens` has them.

        Returns:
            The clean motion, of the shape of ``noisy``; behind an end it means nothing.
        """
        frames = noisy.shape[2]
        mask = torch.arange(frames, device=noisy.device) < lengths[:, None]
        read, name = self.words(words)
        style = self.step(waves(step, self.config.width)) + self.named(name)
        people = []
        for who in range(PEOPLE):
            x = (self.embed[who](noisy[:, who]) + self.joint[who]).flatten(2)  # (B, T, D)
            people.append(x + self.widen[who](x) + self.times[:frames])
        for layer in self.layers:
            people = layer(people, mask, read, words > 0, style)
        both = torch.cat([norm(x) for norm, x in zip(self.norm, people, strict=True)], dim=-1)
        clean: torch.Tensor = self.out(both).unflatten(-1, (PEOPLE, self.config.joints, 3))
        return clean.transpose(1, 2)


class Guided(nn.Module):
    """A denoiser that is led by the label: it goes on from what it would make without one.

    Ho and Salimans, "Classifier-Free Diffusion Guidance" (NeurIPS workshop 2021).
    """

    def __init__(self, network: Denoiser) -> None:
        super().__init__()
        self.network = network

    def forward(
        self,
        noisy: torch.Tensor,
        lengths: torch.Tensor,
        step: torch.Tensor,
        words: torch.Tensor,
    ) -> torch.Tensor:
        """As :meth:`Denoiser.forward`."""
        twice = (torch.stack([one, one]).flatten(0, 1) for one in (noisy, lengths, step))
        words = torch.stack([words, torch.zeros_like(words)]).flatten(0, 1)
        named, unnamed = self.network(*twice, words).unflatten(0, (2, -1)).unbind()
        led: torch.Tensor = unnamed + self.network.config.guidance * (named - unnamed)
        return led


def to_draw_with(network: Denoiser) -> Denoiser | Guided:
    """What takes the noise away in draws."""
    if network.config.guidance == 1:
        return network
    return Guided(network).train(network.training)


def waves(at: torch.Tensor, width: int) -> torch.Tensor:
    """Sines and cosines of numbers (N,), shape (N, width)."""
    half = width // 2
    rates = torch.exp(-math.log(10_000.0) * torch.arange(half, device=at.device) / half)
    angles = at[:, None] * rates
    return torch.cat([torch.sin(angles), torch.cos(angles)], dim=-1)
