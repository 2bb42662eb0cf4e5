"""Building an ONNX graph: nodes, weights, and each tensor in the layout that is asked for."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from models.export.tflite.reader import Array, Graph, Tensor

OPSET = 18
IR_VERSION = 9
NATURAL = "natural"
"""The axes as tflite has them: channels last."""
CHANNELS_FIRST = "channels_first"
"""(batch, channels, height, width), which ONNX convolutions take."""
TO_FIRST = (0, 3, 1, 2)
TO_LAST = (0, 2, 3, 1)


class GraphWriter:
    """Collects the nodes of an ONNX graph.

    Args:
        graph: What is converted; names of nodes count up, so that the same graph gives the same
            bytes.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._nodes: list[onnx.NodeProto] = []
        self._weights: list[onnx.TensorProto] = []
        self._names: dict[tuple[int, str], str] = {}

    def tensor(self, index: int) -> Tensor:
        """A tensor of the tflite graph."""
        return self._graph.tensors[index]

    def weight(self, index: int) -> Array:
        """What a weight holds."""
        value = self.tensor(index).value
        if value is None:
            raise ValueError(f"{self.tensor(index).name} is not a weight")
        return value

    def add(self, kind: str, inputs: list[str], **attributes: Any) -> str:
        """Add a node with one output and give its name."""
        name = f"{kind.lower()}_{len(self._nodes)}"
        self._nodes.append(helper.make_node(kind, inputs, [name], name=name, **attributes))
        return name

    def constant(self, value: Array) -> str:
        """Add a weight. Half floats stay halves in the file and are floats in the graph."""
        name = f"weight_{len(self._weights)}"
        self._weights.append(numpy_helper.from_array(np.ascontiguousarray(value), name))
        if value.dtype == np.float16:
            return self.add("Cast", [name], to=TensorProto.FLOAT)
        return name

    def integers(self, values: Any) -> str:
        """Add a list of integers, as shapes and axes are given."""
        return self.constant(np.array(values, dtype=np.int64))

    def is_known(self, index: int, layout: str) -> bool:
        """Whether a tensor is there in a layout already."""
        return (index, layout) in self._names

    def put(self, index: int, layout: str, name: str) -> None:
        """Say which node gives a tensor."""
        self._names[index, layout if len(self.tensor(index).shape) == 4 else NATURAL] = name

    def get(self, index: int, layout: str) -> str:
        """The node that gives a tensor in a layout; axes are swapped if need be."""
        tensor = self.tensor(index)
        if len(tensor.shape) != 4:
            layout = NATURAL
        name = self._names.get((index, layout))
        if name is None:
            if tensor.value is not None:
                swap = layout == CHANNELS_FIRST
                name = self.constant(tensor.value.transpose(TO_FIRST) if swap else tensor.value)
            elif layout == CHANNELS_FIRST:
                name = self.add("Transpose", [self._names[index, NATURAL]], perm=TO_FIRST)
            else:
                name = self.add("Transpose", [self._names[index, CHANNELS_FIRST]], perm=TO_LAST)
            self._names[index, layout] = name
        return name

    def finish(self, name: str, inputs: dict[str, int], outputs: dict[str, int]) -> onnx.ModelProto:
        """The model, checked.

        Args:
            name: Name of the graph.
            inputs: Name -> tensor.
            outputs: Name -> tensor.
        """
        for output, index in outputs.items():
            self._nodes.append(
                helper.make_node("Identity", [self.get(index, NATURAL)], [output], name=output)
            )
        nodes, weights = self._needed(outputs)
        graph = helper.make_graph(
            nodes,
            name,
            [self._info(given, index) for given, index in inputs.items()],
            [self._info(given, index) for given, index in outputs.items()],
            weights,
        )
        opset = [helper.make_opsetid("", OPSET)]
        model = helper.make_model(graph, opset_imports=opset, ir_version=IR_VERSION)
        onnx.checker.check_model(model, full_check=True)
        return model

    def _needed(
        self, outputs: Iterable[str]
    ) -> tuple[list[onnx.NodeProto], list[onnx.TensorProto]]:
        """The nodes and weights that the outputs depend on."""
        needed = set(outputs)
        nodes = []
        for node in reversed(self._nodes):
            if needed.intersection(node.output):
                needed.update(node.input)
                nodes.append(node)
        return nodes[::-1], [weight for weight in self._weights if weight.name in needed]

    def _info(self, name: str, index: int) -> onnx.ValueInfoProto:
        return helper.make_tensor_value_info(name, TensorProto.FLOAT, self.tensor(index).shape)
