"""Rewrites of a tflite graph that keep what it computes and make it cheaper to run."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from itertools import chain

import numpy as np

from models.export.tflite.reader import Array, Graph, Operator, Tensor

LAYER_NORM = "LAYER_NORM"
"""An operator that tflite lacks; its inputs are x, scale and epsilon, its axis is the last."""
BLOCK = 16
"""Channels that onnxruntime computes together; fewer cost as much as all of them."""
_RELU = 1
_NORM = (
    "MEAN", "NEG", "SQUARED_DIFFERENCE", "MEAN", "ADD", "RSQRT", "MUL", "MUL", "MUL", "ADD",
)  # fmt: skip
_BOTTLENECK = ("CONV_2D", "PRELU", "DEPTHWISE_CONV_2D", "CONV_2D")

Steps = tuple[Operator, ...]


def simplified(graph: Graph) -> Graph:
    """The same network with fewer and cheaper operators."""
    return split_narrow_prelus(merge_layer_norms(graph))


def merge_layer_norms(graph: Graph) -> Graph:
    """Make one operator of the ten with which tflite spells a layer normalisation."""

    def merged(steps: Steps) -> Steps | None:
        (x, axes), epsilon, scale = steps[0].inputs, steps[4].inputs[1], steps[6].inputs[1]
        mean, minus, squares, variance, raised, inverse, factor, scaled, shift, _ = (
            step.outputs[0] for step in steps
        )
        wired = (
            (x, axes), (mean,), (x, mean), (squares, axes), (variance, epsilon), (raised,),
            (inverse, scale), (x, factor), (minus, factor), (scaled, shift),
        )  # fmt: skip
        weights = [graph.tensors[index].value for index in (axes, epsilon, scale)]
        if tuple(step.inputs for step in steps) != wired or any(w is None for w in weights):
            return None
        last = len(graph.tensors[x].shape) - 1
        if _weight(graph, axes).reshape(-1).tolist() not in ([last], [-1]):
            return None
        return (Operator(LAYER_NORM, (x, scale, epsilon), steps[-1].outputs),)

    return replace(graph, operators=_rewritten(graph, _NORM, merged))


def split_narrow_prelus(graph: Graph) -> Graph:
    """Compute PRelus of few channels in the part of a block that would lie idle.

    ``prelu(y) = relu(y) - a relu(-y)``: a convolution that fills half a block at most gives
    ``-y`` beside ``y`` for nothing, and the convolutions behind are linear, so they take ``a``.
    """
    tensors = list(graph.tensors)

    def added(shape: tuple[int, ...], value: Array | None = None) -> int:
        tensors.append(Tensor(f"split_{len(tensors)}", shape, value))
        return len(tensors) - 1

    def weight(*parts: Array, axis: int) -> int:
        value = np.concatenate(parts, axis=axis)
        return added(value.shape, value)

    def split(steps: Steps) -> Steps | None:
        first, prelu, depthwise, last = steps
        channels = graph.tensors[first.outputs[0]].shape[-1]
        is_linear = not any(step.options["FusedActivationFunction"] for step in (first, depthwise))
        if 2 * channels > BLOCK or not is_linear:
            return None
        kernel, bias = (_weight(graph, index) for index in first.inputs[1:])
        spread, shift = (_weight(graph, index) for index in depthwise.inputs[1:])
        slopes = _weight(graph, prelu.inputs[1]).astype(np.float32).reshape(-1)
        gathered = _weight(graph, last.inputs[1])
        both = [
            added((*graph.tensors[step.outputs[0]].shape[:-1], 2 * channels))
            for step in (first, depthwise)
        ]
        return (
            Operator(
                first.kind,
                (first.inputs[0], weight(kernel, -kernel, axis=0), weight(bias, -bias, axis=0)),
                (both[0],),
                {**first.options, "FusedActivationFunction": _RELU},
            ),
            Operator(
                depthwise.kind,
                (
                    both[0],
                    weight(spread, -slopes * spread.astype(np.float32), axis=3),
                    weight(shift, 0 * shift, axis=0),
                ),
                (both[1],),
                depthwise.options,
            ),
            Operator(
                last.kind,
                (both[1], weight(gathered, gathered, axis=3), *last.inputs[2:]),
                last.outputs,
                last.options,
            ),
        )

    operators = _rewritten(graph, _BOTTLENECK, split)
    return replace(graph, tensors=tuple(tensors), operators=operators)


def _rewritten(
    graph: Graph, kinds: tuple[str, ...], rewrite: Callable[[Steps], Steps | None]
) -> Steps:
    """The operators, with something else in place of every run of ``kinds`` on its own.

    What a run computes on its way goes nowhere else, and each step takes up an earlier one.
    ``rewrite`` gives None for a run that is to stay.
    """
    uses = Counter(chain(graph.outputs, *(set(step.inputs) for step in graph.operators)))
    operators: list[Operator] = []
    at = 0
    while at < len(graph.operators):
        steps = graph.operators[at : at + len(kinds)]
        made = None
        if tuple(step.kind for step in steps) == kinds and _is_closed(steps, uses):
            made = rewrite(steps)
        operators.extend(made or steps[:1])
        at += len(kinds) if made else 1
    return tuple(operators)


def _is_closed(steps: Steps, uses: Counter[int]) -> bool:
    inside = Counter(chain(*(set(step.inputs) for step in steps)))
    return all(0 < uses[step.outputs[0]] == inside[step.outputs[0]] for step in steps[:-1])


def _weight(graph: Graph, index: int) -> Array:
    value = graph.tensors[index].value
    if value is None:
        raise ValueError(f"{graph.tensors[index].name} is not a weight")
    return value
