"""Rewrites of tflite graphs: what is computed stays, what costs time goes."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("tflite", reason="needs the train extra")
onnx = pytest.importorskip("onnx", reason="needs the train extra")
import onnxruntime as ort  # noqa: E402
from hypothesis import given, settings  # noqa: E402
from hypothesis import strategies as st  # noqa: E402

from models.export.tflite.operators import convert_operator  # noqa: E402
from models.export.tflite.reader import Graph, Operator, Tensor  # noqa: E402
from models.export.tflite.rewrite import (  # noqa: E402
    LAYER_NORM,
    merge_layer_norms,
    split_narrow_prelus,
)
from models.export.tflite.writer import NATURAL, GraphWriter  # noqa: E402

CONV = {
    "StrideH": 1, "StrideW": 1, "Padding": 0, "FusedActivationFunction": 0,
    "DilationHFactor": 1, "DilationWFactor": 1,
}  # fmt: skip
EPSILON = np.float32(1e-3).reshape(())


class Builder:
    """Tensors and operators of a small graph, put together step by step."""

    def __init__(self, shape):
        self.tensors = [Tensor("x", shape)]
        self.steps = []

    def weight(self, value):
        self.tensors.append(Tensor(f"w{len(self.tensors)}", value.shape, value))
        return len(self.tensors) - 1

    def step(self, kind, inputs, shape, options=None):
        self.tensors.append(Tensor(f"t{len(self.tensors)}", shape))
        self.steps.append(Operator(kind, inputs, (len(self.tensors) - 1,), options or {}))
        return len(self.tensors) - 1

    def graph(self, *outputs):
        return Graph(tuple(self.tensors), tuple(self.steps), (0,), outputs)


def bottleneck(rng, channels, stride=1, dtype=np.float32):
    """A convolution to few channels, a PRelu, a depthwise one, and a convolution back to 16."""
    build = Builder((1, 8, 6, 16))

    def normal(*shape):
        return build.weight(rng.normal(size=shape).astype(dtype))

    side = (1, 8 // stride, 6 // stride)
    down = build.step(
        "CONV_2D", (0, normal(channels, 1, 1, 16), normal(channels)), (1, 8, 6, channels), CONV
    )
    bent = build.step("PRELU", (down, normal(1, 1, channels)), (1, 8, 6, channels))
    spread = build.step(
        "DEPTHWISE_CONV_2D",
        (bent, normal(1, 3, 3, channels), normal(channels)),
        (*side, channels),
        {**CONV, "StrideH": stride, "StrideW": stride},
    )
    up = build.step("CONV_2D", (spread, normal(16, 1, 1, channels), normal(16)), (*side, 16), CONV)
    return build.graph(up)


def layer_norm(rng, axis=3):
    """Ten operators that are a layer normalisation, if ``axis`` is the last."""
    shape = (1, 1, 7, 5)
    less = tuple(1 if place == axis else length for place, length in enumerate(shape))
    build = Builder(shape)
    axes = build.weight(np.array([axis], np.int32))
    epsilon = build.weight(EPSILON)
    scale = build.weight(rng.normal(size=5).astype(np.float32))
    keep = {"KeepDims": 1}
    mean = build.step("MEAN", (0, axes), less, keep)
    minus = build.step("NEG", (mean,), less)
    squares = build.step("SQUARED_DIFFERENCE", (0, mean), shape)
    variance = build.step("MEAN", (squares, axes), less, keep)
    raised = build.step("ADD", (variance, epsilon), less)
    inverse = build.step("RSQRT", (raised,), less)
    factor = build.step("MUL", (inverse, scale), shape)
    scaled = build.step("MUL", (0, factor), shape)
    shift = build.step("MUL", (minus, factor), shape)
    return build.graph(build.step("ADD", (scaled, shift), shape))


def run(graph, x):
    writer = GraphWriter(graph)
    writer.put(0, NATURAL, "given")
    for operator in graph.operators:
        convert_operator(writer, operator)
    model = writer.finish("case", {"given": 0}, {"y": graph.outputs[0]})
    session = ort.InferenceSession(model.SerializeToString(), providers=["CPUExecutionProvider"])
    return session.run(None, {"given": x})[0]


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    channels=st.integers(1, 8),
    stride=st.sampled_from((1, 2)),
    dtype=st.sampled_from((np.float16, np.float32)),
)
def test_a_split_prelu_gives_what_the_whole_one_gave(seed, channels, stride, dtype):
    rng = np.random.default_rng(seed)
    graph = bottleneck(rng, channels, stride, dtype)
    split = split_narrow_prelus(graph)
    assert [step.kind for step in split.operators] == ["CONV_2D", "DEPTHWISE_CONV_2D", "CONV_2D"]
    x = rng.normal(size=graph.tensors[0].shape).astype(np.float32)
    expected = run(graph, x)
    # Both sum the same hundred or so products, in another order.
    np.testing.assert_allclose(run(split, x), expected, atol=1e-5 * np.abs(expected).max())


def test_a_prelu_that_fills_its_block_or_goes_elsewhere_too_stays():
    wide = bottleneck(np.random.default_rng(0), 9)
    assert split_narrow_prelus(wide).operators == wide.operators
    narrow = bottleneck(np.random.default_rng(0), 4)
    for step in narrow.operators[:3]:
        shared = replace(narrow, outputs=(*narrow.outputs, *step.outputs))
        assert split_narrow_prelus(shared).operators == narrow.operators


def test_a_prelu_between_activations_stays():
    graph = bottleneck(np.random.default_rng(0), 4)
    for place in (0, 2):
        steps = list(graph.operators)
        options = {**steps[place].options, "FusedActivationFunction": 1}
        steps[place] = replace(steps[place], options=options)
        bent = replace(graph, operators=tuple(steps))
        assert split_narrow_prelus(bent).operators == bent.operators


def test_ten_operators_are_one_layer_norm():
    rng = np.random.default_rng(3)
    graph = layer_norm(rng)
    merged = merge_layer_norms(graph)
    assert [step.kind for step in merged.operators] == [LAYER_NORM]
    x = rng.normal(size=(1, 1, 7, 5)).astype(np.float32)
    apart = x - x.mean(axis=-1, keepdims=True)
    expected = apart / np.sqrt((apart**2).mean(axis=-1, keepdims=True) + EPSILON)
    np.testing.assert_allclose(run(merged, x), expected * graph.tensors[3].value, atol=1e-5)


def test_what_only_looks_like_a_layer_norm_stays():
    rng = np.random.default_rng(3)
    other_axis = layer_norm(rng, axis=2)
    assert merge_layer_norms(other_axis).operators == other_axis.operators
    graph = layer_norm(rng)
    kept = replace(graph, outputs=(*graph.outputs, *graph.operators[0].outputs))
    assert merge_layer_norms(kept).operators == graph.operators
    steps = list(graph.operators)
    steps[8] = replace(steps[8], inputs=steps[7].inputs)
    crossed = replace(graph, operators=tuple(steps))
    assert merge_layer_norms(crossed).operators == crossed.operators
