"""Reading a tflite file into plain values, weights included.

The layout is that of TensorFlow Lite's ``schema.fbs``. Weights stored as half floats or sparse
come out dense; ``DEQUANTIZE`` and ``DENSIFY`` of weights are done here and leave no operator.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import tflite
from numpy.typing import NDArray

Array = NDArray[Any]

_TYPES: Mapping[int, Any] = {
    tflite.TensorType.FLOAT32: np.float32,
    tflite.TensorType.FLOAT16: np.float16,
    tflite.TensorType.INT32: np.int32,
    tflite.TensorType.INT64: np.int64,
    tflite.TensorType.INT8: np.int8,
    tflite.TensorType.UINT8: np.uint8,
}
_KINDS = {
    value: name for name, value in vars(tflite.BuiltinOperator).items() if isinstance(value, int)
}
_CONV = ("StrideH", "StrideW", "Padding", "FusedActivationFunction")
_DILATED = (*_CONV, "DilationHFactor", "DilationWFactor")
_POOL = (*_CONV, "FilterHeight", "FilterWidth")
_FUSED = ("FusedActivationFunction",)
_OPTIONS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "CONV_2D": ("Conv2DOptions", _DILATED),
    "DEPTHWISE_CONV_2D": ("DepthwiseConv2DOptions", _DILATED),
    "MAX_POOL_2D": ("Pool2DOptions", _POOL),
    "AVERAGE_POOL_2D": ("Pool2DOptions", _POOL),
    "ADD": ("AddOptions", _FUSED),
    "SUB": ("SubOptions", _FUSED),
    "MUL": ("MulOptions", _FUSED),
    "DIV": ("DivOptions", _FUSED),
    "CONCATENATION": ("ConcatenationOptions", ("Axis",)),
    "RESIZE_BILINEAR": ("ResizeBilinearOptions", ("AlignCorners", "HalfPixelCenters")),
    "DEPTH_TO_SPACE": ("DepthToSpaceOptions", ("BlockSize",)),
    "FULLY_CONNECTED": ("FullyConnectedOptions", _FUSED),
    "MEAN": ("ReducerOptions", ("KeepDims",)),
    "SUM": ("ReducerOptions", ("KeepDims",)),
    "STRIDED_SLICE": (
        "StridedSliceOptions",
        ("BeginMask", "EndMask", "EllipsisMask", "NewAxisMask", "ShrinkAxisMask"),
    ),
}
"""Operator -> its table of options and which of them matter."""


@dataclass(frozen=True, slots=True)
class Tensor:
    """A tensor of the graph; ``value`` is what it holds if it is a weight.

    Activations of rank 4 are (batch, height, width, channels).
    """

    name: str
    shape: tuple[int, ...]
    value: Array | None = None


@dataclass(frozen=True, slots=True)
class Operator:
    """One step: tensors in and out by index (-1: left out), and its options by name."""

    kind: str
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    options: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Graph:
    """A network: its operators stand in the order in which they run."""

    tensors: tuple[Tensor, ...]
    operators: tuple[Operator, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]


def read_graph(data: bytes) -> Graph:
    """Read the only graph of a tflite file."""
    model = tflite.Model.GetRootAsModel(data, 0)
    graph = model.Subgraphs(0)
    tensors = [_tensor(model, graph.Tensors(i)) for i in range(graph.TensorsLength())]
    operators = []
    for i in range(graph.OperatorsLength()):
        operator = _operator(model, graph.Operators(i))
        source = tensors[operator.inputs[0]]
        if operator.kind in ("DEQUANTIZE", "DENSIFY") and source.value is not None:
            (target,) = operator.outputs
            tensors[target] = Tensor(tensors[target].name, source.shape, source.value)
        else:
            operators.append(operator)
    return Graph(
        tuple(tensors),
        tuple(operators),
        tuple(graph.InputsAsNumpy().tolist()),
        tuple(graph.OutputsAsNumpy().tolist()),
    )


def _operator(model: Any, raw: Any) -> Operator:
    code = model.OperatorCodes(raw.OpcodeIndex())
    # Old files have the operator in a byte of its own.
    kind = _KINDS[max(code.BuiltinCode(), code.DeprecatedBuiltinCode())]
    options = {}
    if kind in _OPTIONS:
        name, wanted = _OPTIONS[kind]
        table = getattr(tflite, name)()
        table.Init(raw.BuiltinOptions().Bytes, raw.BuiltinOptions().Pos)
        options = {option: int(getattr(table, option)()) for option in wanted}
    return Operator(
        kind,
        tuple(raw.InputsAsNumpy().tolist()),
        tuple(raw.OutputsAsNumpy().tolist()),
        options,
    )


def _tensor(model: Any, raw: Any) -> Tensor:
    shape = tuple(int(length) for length in np.atleast_1d(raw.ShapeAsNumpy()))
    if raw.ShapeLength() == 0:
        shape = ()
    name = raw.Name().decode()
    buffer = model.Buffers(raw.Buffer())
    if not buffer.DataLength():
        return Tensor(name, shape)
    values = np.frombuffer(buffer.DataAsNumpy().tobytes(), _TYPES[raw.Type()])
    if raw.Sparsity() is not None:
        return Tensor(name, shape, _dense(values, shape, raw.Sparsity()))
    return Tensor(name, shape, values.reshape(shape))


def _dense(values: Array, shape: tuple[int, ...], sparsity: Any) -> Array:
    """Spread out a sparse weight.

    Its axes, and those of the blocks that some are cut into, are stored from the outermost in:
    dense ones by their length, sparse ones by the segments of the indices that are there.
    """
    order = np.atleast_1d(sparsity.TraversalOrderAsNumpy()).tolist()
    has_blocks = sparsity.BlockMapLength() > 0
    blocked = np.atleast_1d(sparsity.BlockMapAsNumpy()).tolist() if has_blocks else []
    levels = [sparsity.DimMetadata(i) for i in range(sparsity.DimMetadataLength())]
    rank = len(shape)
    size = [1] * rank
    for block, axis in enumerate(blocked):
        size[axis] = levels[order.index(rank + block)].DenseSize()
    # Where each stored value lies, level by level: its position and its coordinates.
    places = [(0, [0] * rank)]
    for level, axis in zip(levels, order, strict=True):
        target, step = (axis, size[axis]) if axis < rank else (blocked[axis - rank], 1)
        places = [
            (inner, [c + index * step if i == target else c for i, c in enumerate(place)])
            for outer, place in places
            for inner, index in _children(level, outer)
        ]
    dense = np.zeros(shape, values.dtype)
    for position, place in places:
        dense[tuple(place)] = values[position]
    return dense


def _children(level: Any, outer: int) -> list[tuple[int, int]]:
    """Positions on the next level below ``outer``, each with its index along the axis."""
    if level.Format() == tflite.DimensionType.DENSE:
        length = level.DenseSize()
        return [(outer * length + index, index) for index in range(length)]
    segments = _vector(level.ArraySegmentsType(), level.ArraySegments())
    indices = _vector(level.ArrayIndicesType(), level.ArrayIndices())
    span = range(int(segments[outer]), int(segments[outer + 1]))
    return [(position, int(indices[position])) for position in span]


def _vector(kind: int, table: Any) -> Array:
    kinds = {
        tflite.SparseIndexVector.Int32Vector: tflite.Int32Vector,
        tflite.SparseIndexVector.Uint16Vector: tflite.Uint16Vector,
        tflite.SparseIndexVector.Uint8Vector: tflite.Uint8Vector,
    }
    vector = kinds[kind]()
    vector.Init(table.Bytes, table.Pos)
    values: Array = vector.ValuesAsNumpy()
    return values
