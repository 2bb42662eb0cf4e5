"""Products of matrices in bfloat16 while training.

Recent CPUs and GPUs multiply bfloat16 several times faster than float32. Weights, sums,
normalisations and everything outside the product stay in float32.
"""

import torch
import torch.nn.functional as F


def product(weight: torch.Tensor, x: torch.Tensor, half: bool) -> torch.Tensor:
    """Weight @ x, in float32; multiplied in bfloat16 if ``half``."""
    return (weight.bfloat16() @ x.bfloat16()).float() if half else weight @ x


def dense(x: torch.Tensor, layer: torch.nn.Linear, half: bool) -> torch.Tensor:
    """A linear layer with a bias, over the last axis; its result stays in bfloat16 if ``half``."""
    if not half:
        out: torch.Tensor = layer(x)
        return out
    return F.linear(x.bfloat16(), layer.weight.bfloat16(), layer.bias.bfloat16())
