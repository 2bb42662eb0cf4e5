"""Each tflite operator as ONNX nodes, one function an operator."""

from collections.abc import Callable, Mapping

import numpy as np

from models.export.tflite.reader import Array, Operator
from models.export.tflite.rewrite import LAYER_NORM
from models.export.tflite.writer import CHANNELS_FIRST, NATURAL, GraphWriter

Convert = Callable[[GraphWriter, Operator], None]
_SAME = 0
_NO_ACTIVATION, _RELU, _RELU6 = 0, 1, 3
_AXES_FIRST = (0, 2, 3, 1)
"""Where tflite's axes of an image lie when channels come first."""


def convert_operator(writer: GraphWriter, operator: Operator) -> None:
    """Add the nodes of one operator.

    Raises:
        NotImplementedError: If nothing here knows the operator.
    """
    convert = CONVERTERS.get(operator.kind)
    if convert is None:
        raise NotImplementedError(f"the operator {operator.kind} is not known")
    convert(writer, operator)


def _conv(writer: GraphWriter, operator: Operator) -> None:
    source, kernel, *bias = operator.inputs
    is_depthwise = operator.kind == "DEPTHWISE_CONV_2D"
    weight = writer.weight(kernel)
    # tflite: (out, h, w, in), depthwise (1, h, w, out); ONNX: (out, in, h, w).
    weight = weight.transpose((3, 0, 1, 2) if is_depthwise else (0, 3, 1, 2))
    options = operator.options
    size = weight.shape[2:]
    strides = (options["StrideH"], options["StrideW"])
    is_pointwise = size == strides == (1, 1) and not is_depthwise
    if is_pointwise and not writer.is_known(source, CHANNELS_FIRST):
        _matrix(writer, operator)
        return
    dilations = (options["DilationHFactor"], options["DilationWFactor"])
    inputs = [writer.get(source, CHANNELS_FIRST), writer.constant(weight)]
    inputs += [writer.constant(writer.weight(index)) for index in bias if index >= 0]
    height_width = writer.tensor(source).shape[1:3]
    result = writer.add(
        "Conv",
        inputs,
        kernel_shape=size,
        strides=strides,
        dilations=dilations,
        group=writer.tensor(source).shape[3] if is_depthwise else 1,
        pads=_pads(options["Padding"], height_width, size, strides, dilations),
    )
    writer.put(operator.outputs[0], CHANNELS_FIRST, _activated(writer, result, operator))


def _matrix(writer: GraphWriter, operator: Operator) -> None:
    """A convolution of single points as a product of matrices, with the channels left last."""
    source, kernel, *bias = operator.inputs
    weight = writer.weight(kernel)
    product = writer.constant(np.ascontiguousarray(weight.reshape(len(weight), -1).T))
    result = writer.add("MatMul", [writer.get(source, NATURAL), product])
    for index in bias:
        if index >= 0:
            result = writer.add("Add", [result, writer.constant(writer.weight(index))])
    writer.put(operator.outputs[0], NATURAL, _activated(writer, result, operator))


def _pool(writer: GraphWriter, operator: Operator) -> None:
    (source,) = operator.inputs
    options = operator.options
    size = (options["FilterHeight"], options["FilterWidth"])
    strides = (options["StrideH"], options["StrideW"])
    kind = "MaxPool" if operator.kind == "MAX_POOL_2D" else "AveragePool"
    pads = _pads(options["Padding"], writer.tensor(source).shape[1:3], size, strides, (1, 1))
    result = writer.add(
        kind,
        [writer.get(source, CHANNELS_FIRST)],
        kernel_shape=size,
        strides=strides,
        pads=pads,
    )
    writer.put(operator.outputs[0], CHANNELS_FIRST, _activated(writer, result, operator))


def _prelu(writer: GraphWriter, operator: Operator) -> None:
    """``x + (1 - a) relu(-x)``, which is ``x`` above 0 and ``a x`` below.

    onnxruntime makes two depthwise convolutions of it, the first with the activation in it and
    the second with the sum; together they take less than half the time of its PRelu.
    """
    source, slope = operator.inputs
    slopes = writer.weight(slope).astype(np.float32).reshape(-1, 1, 1, 1)
    given = writer.get(source, CHANNELS_FIRST)
    below = writer.add("Relu", [_scaled(writer, given, -np.ones_like(slopes))])
    result = writer.add("Add", [given, _scaled(writer, below, 1 - slopes)])
    writer.put(operator.outputs[0], CHANNELS_FIRST, result)


def _scaled(writer: GraphWriter, given: str, factors: Array) -> str:
    """Every channel times its own factor, shape (channels, 1, 1, 1)."""
    weight = writer.constant(factors)
    return writer.add("Conv", [given, weight], kernel_shape=(1, 1), group=len(factors))


def _elementwise(writer: GraphWriter, operator: Operator) -> None:
    layout = _common_layout(writer, operator)
    kind = {"ADD": "Add", "SUB": "Sub", "MUL": "Mul", "DIV": "Div"}[operator.kind]
    inputs = [writer.get(index, layout) for index in operator.inputs]
    result = _activated(writer, writer.add(kind, inputs), operator)
    writer.put(operator.outputs[0], layout, result)


def _unary(writer: GraphWriter, operator: Operator) -> None:
    layout = _common_layout(writer, operator)
    given = writer.get(operator.inputs[0], layout)
    kind = {"RELU": "Relu", "LOGISTIC": "Sigmoid", "SQRT": "Sqrt"}[operator.kind]
    writer.put(operator.outputs[0], layout, writer.add(kind, [given]))


def _layer_norm(writer: GraphWriter, operator: Operator) -> None:
    source, scale, epsilon = operator.inputs
    result = writer.add(
        "LayerNormalization",
        [writer.get(source, NATURAL), writer.get(scale, NATURAL)],
        axis=-1,
        epsilon=float(writer.weight(epsilon)),
    )
    writer.put(operator.outputs[0], NATURAL, result)


def _pad(writer: GraphWriter, operator: Operator) -> None:
    source, amounts = operator.inputs
    layout = _common_layout(writer, operator)
    given = writer.get(source, layout)
    pairs = writer.weight(amounts).reshape(-1, 2)
    if layout == CHANNELS_FIRST:
        channels = writer.tensor(source).shape[3]
        if pairs.tolist() == [[0, 0], [0, 0], [0, 0], [0, channels]]:
            # onnxruntime reorders an image for a Pad, and does not for a Concat.
            zeros = _scaled(writer, given, np.zeros((channels, 1, 1, 1), np.float32))
            result = writer.add("Concat", [given, zeros], axis=1)
            writer.put(operator.outputs[0], layout, result)
            return
        pairs = pairs[[0, 3, 1, 2]]
    pads = writer.integers(np.concatenate([pairs[:, 0], pairs[:, 1]]))
    writer.put(operator.outputs[0], layout, writer.add("Pad", [given, pads], mode="constant"))


def _reshape(writer: GraphWriter, operator: Operator) -> None:
    target = operator.outputs[0]
    given = writer.get(operator.inputs[0], NATURAL)
    shape = writer.integers(writer.tensor(target).shape)
    writer.put(target, NATURAL, writer.add("Reshape", [given, shape]))


def _transpose(writer: GraphWriter, operator: Operator) -> None:
    source, order = operator.inputs
    perm = writer.weight(order).reshape(-1).tolist()
    result = writer.add("Transpose", [writer.get(source, NATURAL)], perm=perm)
    writer.put(operator.outputs[0], NATURAL, result)


def _concatenation(writer: GraphWriter, operator: Operator) -> None:
    layout = _common_layout(writer, operator)
    rank = len(writer.tensor(operator.outputs[0]).shape)
    axis = operator.options["Axis"] % rank
    if layout == CHANNELS_FIRST:
        axis = _AXES_FIRST[axis]
    inputs = [writer.get(index, layout) for index in operator.inputs]
    writer.put(operator.outputs[0], layout, writer.add("Concat", inputs, axis=axis))


def _resize(writer: GraphWriter, operator: Operator) -> None:
    batch, height, width, channels = writer.tensor(operator.outputs[0]).shape
    mode = "asymmetric"
    if operator.options["AlignCorners"]:
        mode = "align_corners"
    elif operator.options["HalfPixelCenters"]:
        mode = "half_pixel"
    given = writer.get(operator.inputs[0], CHANNELS_FIRST)
    sizes = writer.integers((batch, channels, height, width))
    result = writer.add(
        "Resize",
        [given, "", "", sizes],
        mode="linear",
        coordinate_transformation_mode=mode,
    )
    writer.put(operator.outputs[0], CHANNELS_FIRST, result)


def _depth_to_space(writer: GraphWriter, operator: Operator) -> None:
    given = writer.get(operator.inputs[0], CHANNELS_FIRST)
    block = operator.options["BlockSize"]
    result = writer.add("DepthToSpace", [given], blocksize=block, mode="DCR")
    writer.put(operator.outputs[0], CHANNELS_FIRST, result)


def _fully_connected(writer: GraphWriter, operator: Operator) -> None:
    source, kernel, *bias = operator.inputs
    weight = writer.weight(kernel)
    given = writer.get(source, NATURAL)
    rows = writer.add("Reshape", [given, writer.integers((-1, weight.shape[1]))])
    inputs = [rows, writer.constant(weight)]
    inputs += [writer.constant(writer.weight(index)) for index in bias if index >= 0]
    result = _activated(writer, writer.add("Gemm", inputs, transB=1), operator)
    writer.put(operator.outputs[0], NATURAL, result)


def _softmax(writer: GraphWriter, operator: Operator) -> None:
    given = writer.get(operator.inputs[0], NATURAL)
    writer.put(operator.outputs[0], NATURAL, writer.add("Softmax", [given], axis=-1))


def _reduce(writer: GraphWriter, operator: Operator) -> None:
    source, axes = operator.inputs
    kind = {"MEAN": "ReduceMean", "SUM": "ReduceSum"}[operator.kind]
    inputs = [writer.get(source, NATURAL), writer.integers(writer.weight(axes).reshape(-1))]
    result = writer.add(kind, inputs, keepdims=operator.options["KeepDims"])
    writer.put(operator.outputs[0], NATURAL, result)


def _strided_slice(writer: GraphWriter, operator: Operator) -> None:
    options = operator.options
    if options["EllipsisMask"] or options["NewAxisMask"]:
        raise NotImplementedError("STRIDED_SLICE with an ellipsis or a new axis is not known")
    source, *limits = operator.inputs
    begin, end, stride = (writer.weight(index).reshape(-1).astype(np.int64) for index in limits)
    begin, end = begin.copy(), end.copy()
    for axis in range(len(begin)):
        if options["BeginMask"] >> axis & 1:
            begin[axis] = 0
        if options["EndMask"] >> axis & 1:
            end[axis] = np.iinfo(np.int32).max
        if options["ShrinkAxisMask"] >> axis & 1:
            end[axis] = begin[axis] + 1 if begin[axis] != -1 else np.iinfo(np.int32).max
    given = writer.get(source, NATURAL)
    axes = range(len(begin))
    parts = [writer.integers(list(part)) for part in (begin, end, axes, stride)]
    cut = writer.add("Slice", [given, *parts])
    target = operator.outputs[0]
    shape = writer.integers(writer.tensor(target).shape)
    writer.put(target, NATURAL, writer.add("Reshape", [cut, shape]))


def _common_layout(writer: GraphWriter, operator: Operator) -> str:
    """Channels first where every image that goes in is there that way, or is a weight."""
    tensors = [writer.tensor(index) for index in operator.inputs]
    if len(writer.tensor(operator.outputs[0]).shape) != 4:
        return NATURAL
    fits = [
        len(tensor.shape) in (0, 4)
        and (tensor.value is not None or writer.is_known(index, CHANNELS_FIRST))
        for index, tensor in zip(operator.inputs, tensors, strict=True)
        if operator.kind != "PAD" or tensor.value is None
    ]
    return CHANNELS_FIRST if all(fits) else NATURAL


def _activated(writer: GraphWriter, name: str, operator: Operator) -> str:
    """The activation that tflite has inside another operator."""
    activation = operator.options.get("FusedActivationFunction", _NO_ACTIVATION)
    if activation == _NO_ACTIVATION:
        return name
    if activation == _RELU:
        return writer.add("Relu", [name])
    if activation == _RELU6:
        limits = [writer.constant(np.array(value, np.float32)) for value in (0, 6)]
        return writer.add("Clip", [name, *limits])
    raise NotImplementedError(f"the activation {activation} is not known")


def _pads(
    padding: int,
    lengths: tuple[int, ...],
    size: tuple[int, ...],
    strides: tuple[int, ...],
    dilations: tuple[int, ...],
) -> list[int]:
    """Padding before and after each axis; tflite puts the odd one behind."""
    if padding != _SAME:
        return [0, 0, 0, 0]
    before, after = [], []
    for length, kernel, stride, dilation in zip(lengths, size, strides, dilations, strict=True):
        reach = (kernel - 1) * dilation + 1
        total = max((-(-length // stride) - 1) * stride + reach - length, 0)
        before.append(total // 2)
        after.append(total - total // 2)
    return [*before, *after]


CONVERTERS: Mapping[str, Convert] = {
    "CONV_2D": _conv,
    "DEPTHWISE_CONV_2D": _conv,
    "MAX_POOL_2D": _pool,
    "AVERAGE_POOL_2D": _pool,
    "PRELU": _prelu,
    "ADD": _elementwise,
    "SUB": _elementwise,
    "MUL": _elementwise,
    "DIV": _elementwise,
    "RELU": _unary,
    "LOGISTIC": _unary,
    "SQRT": _unary,
    LAYER_NORM: _layer_norm,
    "PAD": _pad,
    "RESHAPE": _reshape,
    "TRANSPOSE": _transpose,
    "CONCATENATION": _concatenation,
    "RESIZE_BILINEAR": _resize,
    "DEPTH_TO_SPACE": _depth_to_space,
    "FULLY_CONNECTED": _fully_connected,
    "SOFTMAX": _softmax,
    "MEAN": _reduce,
    "SUM": _reduce,
    "STRIDED_SLICE": _strided_slice,
}
"""tflite's name of an operator -> what converts it."""
