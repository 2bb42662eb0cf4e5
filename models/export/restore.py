"""A classifier's weights, out of the ONNX file of its bundle."""

from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import numpy_helper

from agent_server.errors import BundleError
from agent_server.inference.manifest import GOLDEN_FILE, MODEL_FILE, read_manifest
from models.export.onnx import TOLERANCE
from models.interformer.config import NetworkConfig
from models.interformer.network import Calibrated, Classifier

PREFIX = "classifier."


def restore_classifier(folder: Path) -> Calibrated:
    """The network of a bundle, ready to be gone on with.

    The exporter keeps the names of all weights but the matrices of dense layers, which it
    transposes; those are found by the named bias that is added to their product.

    Raises:
        BundleError: If the bundle holds another network, or the weights do not give its goldens.
    """
    manifest = read_manifest(folder)
    if manifest.task != "classify":
        raise BundleError(f"{folder} holds no classifier but a model that can {manifest.task}")
    graph = onnx.load(folder / MODEL_FILE).graph
    values = {each.name: numpy_helper.to_array(each) for each in graph.initializer}
    products = {node.output[0]: node for node in graph.node if node.op_type == "MatMul"}
    weights = {
        name.removeprefix(PREFIX): value
        for name, value in values.items()
        if name.startswith(PREFIX)
    }
    for node in graph.node:
        bias = next((name for name in node.input if name.startswith(PREFIX)), "")
        product = next((products[name] for name in node.input if name in products), None)
        if node.op_type == "Add" and bias.endswith(".bias") and product is not None:
            matrix = values[product.input[1]]
            weights[bias.removeprefix(PREFIX).removesuffix("bias") + "weight"] = matrix.T
    network = Classifier(NetworkConfig(classes=len(manifest.labels)))
    found = {name: torch.tensor(np.array(value)) for name, value in weights.items()}
    if missing := dict(network.named_parameters()).keys() - found.keys():
        raise BundleError(
            f"{folder} holds another network than this version trains: it lacks {min(missing)}"
        )
    network.load_state_dict(found, strict=False)  # what is no weight stays as it is made
    restored = Calibrated(network, float(values["temperature"])).eval()
    with np.load(folder / GOLDEN_FILE) as golden, torch.no_grad():
        given = restored(torch.from_numpy(golden["motion"])).numpy()
        worst = float(np.abs(given - golden["probabilities"]).max())
    if worst > TOLERANCE:
        raise BundleError(f"the weights of {folder} do not give its goldens (off by {worst:.1e})")
    return restored
