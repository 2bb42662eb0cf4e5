"""Torch -> ONNX, and the checks that the file computes the same."""

import logging
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from torch import nn

from agent_server.domain.arrays import Float32
from agent_server.errors import BundleError
from models.ops.session import OnnxModel

OPSET = 18
TOLERANCE = 1e-4
LARGEST_BATCH = 16


def write_onnx(
    network: nn.Module, example: torch.Tensor, path: Path, input_name: str, output_name: str
) -> None:
    """Export a network with one input and one output, batch axis free, weights inside.

    Args:
        network: In evaluation mode.
        example: A batch of at least two rows, so that the batch axis is not taken as fixed.
        path: The file to write.
        input_name: Name of the input.
        output_name: Name of the output.
    """
    batch = torch.export.Dim("batch", min=1, max=4096)
    write_graph(network, (example,), path, [input_name], [output_name], ({0: batch},))


def write_graph(
    network: nn.Module,
    examples: tuple[torch.Tensor, ...],
    path: Path,
    inputs: Sequence[str],
    outputs: Sequence[str],
    shapes: Sequence[dict[int, Any]],
) -> None:
    """Export a network of any inputs, weights inside.

    Args:
        network: In evaluation mode.
        examples: An input each; a free axis has at least two.
        path: The file to write.
        inputs: Names of the inputs.
        outputs: Names of the outputs.
        shapes: For each input its free axes.
    """
    with _quiet():
        program = torch.onnx.export(
            network,
            examples,
            dynamo=True,
            opset_version=OPSET,
            input_names=inputs,
            output_names=outputs,
            dynamic_shapes=tuple(shapes),
            verbose=False,
        )
    if program is None:
        raise BundleError(f"the exporter gave no program for {path}")
    program.optimize()
    path.write_bytes(_plain(program.model_proto).SerializeToString())


@contextmanager
def _quiet() -> Iterator[None]:
    """Without the exporter's words on packages that it does not need, and on its own future."""
    log = logging.getLogger("torch.onnx")
    level = log.level
    log.setLevel(logging.ERROR)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)
            warnings.filterwarnings("ignore", "# The axis name", UserWarning)  # it is shared
            yield
    finally:
        log.setLevel(level)


def _plain(model: onnx.ModelProto) -> onnx.ModelProto:
    """Without the exporter's notes, which hold source paths: equal weights give equal bytes."""
    graph = model.graph
    noted = (model, graph, *graph.node, *graph.initializer, *graph.value_info)
    for part in (*noted, *graph.input, *graph.output):
        del part.metadata_props[:]
        part.doc_string = ""
    return model


@torch.no_grad()
def round_weights(network: nn.Module) -> None:
    """Round to what 16 bits hold, so that :func:`store_halves` makes the file half as large."""
    for weight in network.parameters():
        weight.copy_(weight.half().float())


def store_halves(path: Path) -> None:
    """Keep in 16 bits, in place, what 16 bits hold exactly; it is computed with as before.

    A network whose weights were rounded (``parameter.half().float()``) becomes half as large and
    gives the same output.
    """
    model = onnx.load(path)
    graph, casts = model.graph, []
    for initializer in graph.initializer:
        values = onnx.numpy_helper.to_array(initializer)
        if values.dtype != np.float32 or values.ndim == 0:
            continue
        with np.errstate(over="ignore"):
            halves = values.astype(np.float16)
        if not np.array_equal(halves.astype(np.float32), values):
            continue
        name, half = initializer.name, f"{initializer.name}_half"
        initializer.CopyFrom(onnx.numpy_helper.from_array(halves, half))
        casts.append(onnx.helper.make_node("Cast", [half], [name], to=onnx.TensorProto.FLOAT))
    nodes = [*casts, *graph.node]
    del graph.node[:]
    graph.node.extend(nodes)
    path.write_bytes(model.SerializeToString())


def check_parity(network: nn.Module, model: OnnxModel, values: Float32) -> float:
    """Largest difference of torch and ONNX on ``values`` (N, ...).

    Raises:
        BundleError: If it is above 1e-4.
    """
    with torch.no_grad():
        expected = network(torch.from_numpy(values)).numpy()
    worst = float(np.abs(model.batched(values) - expected).max())
    return require_close(worst)


def require_close(worst: float, unit: str = "") -> float:
    """Give the largest difference by torch and ONNX back if it is small enough.

    Raises:
        BundleError: If it is above 1e-4 or not a number.
    """
    if not worst <= TOLERANCE:
        raise BundleError(
            f"torch and ONNX differ by {worst:.2g}{unit}, more than {TOLERANCE}: look for an "
            "operator that the exporter translates differently"
        )
    return worst


def is_batch_exact(model: OnnxModel, values: Float32) -> bool:
    """Whether every row of batches of 1 to 16 has the bits that it has alone.

    Args:
        model: The exported model.
        values: At least 16 rows.
    """
    alone = [model(values[i : i + 1])[0] for i in range(LARGEST_BATCH)]
    return all(
        np.array_equal(model(values[:size])[i], alone[i])
        for size in range(1, LARGEST_BATCH + 1)
        for i in range(size)
    )
