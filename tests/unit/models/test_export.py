from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("onnxscript", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES  # noqa: E402
from agent_server.errors import BundleError  # noqa: E402
from agent_server.inference.manifest import (  # noqa: E402
    GOLDEN_FILE,
    MODEL_FILE,
    MotionManifest,
    read_manifest,
)
from models.export.bundle import Export, write_bundle  # noqa: E402
from models.export.calibration import fit_temperature  # noqa: E402
from models.export.onnx import check_parity, is_batch_exact, write_onnx  # noqa: E402
from models.interformer.config import NetworkConfig as ClassifierConfig  # noqa: E402
from models.interformer.network import Calibrated, Classifier  # noqa: E402
from models.ma_wgan.config import NetworkConfig  # noqa: E402
from models.ma_wgan.network import Predictor  # noqa: E402
from models.ops.session import OnnxModel  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore")  # the exporter's own deprecations

INFO = {"command": "train", "seed": 1, "wall_s": 2.0, "hardware": "a machine"}


def windows(frames: int, count: int = 20) -> np.ndarray:
    rng = np.random.default_rng(0)
    return (0.3 * rng.standard_normal((count, frames, 9, 3))).astype(np.float32)


def generator(output: str = "curve") -> Predictor:
    torch.manual_seed(0)
    reference = torch.nn.functional.normalize(torch.randn(9, 150), dim=1)
    network = Predictor(NetworkConfig(channels=32, blocks=2, output=output), reference)
    for parameter in network.parameters():
        torch.nn.init.normal_(parameter, std=0.1)
    return network.eval()


@pytest.fixture(scope="module", params=["curve", "tangent"])
def predictor(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Predictor, OnnxModel]:
    path = tmp_path_factory.mktemp("onnx") / "model.onnx"
    network = generator(request.param)
    write_onnx(network, torch.from_numpy(windows(25)[:2]), path, "seen", "future")
    return network, OnnxModel(path)


def test_onnx_computes_what_torch_does(predictor: tuple[Predictor, OnnxModel]) -> None:
    network, model = predictor
    assert check_parity(network, model, windows(25)) < 1e-4
    assert (model.input, model.output) == ("seen", "future")
    assert model(windows(25, 1)).shape == (1, 50, 9, 3)


def test_a_file_holds_no_trace_of_where_it_was_made(tmp_path: Path) -> None:
    path = tmp_path / "model.onnx"
    write_onnx(generator(), torch.from_numpy(windows(25)[:2]), path, "seen", "future")
    data = path.read_bytes()
    assert b".py" not in data
    assert b"stack_trace" not in data
    other = tmp_path / "other.onnx"
    write_onnx(generator(), torch.from_numpy(windows(25)[:2]), other, "seen", "future")
    assert other.read_bytes() == data


def test_another_network_is_found_out(predictor: tuple[Predictor, OnnxModel]) -> None:
    network, model = predictor
    with torch.no_grad():
        network.generator.out.bias += 1.0
    try:
        with pytest.raises(BundleError, match="differ by"):
            check_parity(network, model, windows(25))
    finally:
        with torch.no_grad():
            network.generator.out.bias -= 1.0


def test_rows_of_a_batch_have_the_bits_of_a_batch_of_one(
    predictor: tuple[Predictor, OnnxModel],
) -> None:
    network, model = predictor
    if network.config.output == "curve":  # what the server runs
        assert is_batch_exact(model, windows(25))


def test_a_body_that_stands_still_stays_finite(predictor: tuple[Predictor, OnnxModel]) -> None:
    still = np.repeat(windows(25)[:, :1], 25, axis=1)
    assert np.isfinite(predictor[1](still)).all()
    assert np.isfinite(predictor[1](np.zeros_like(still))).all()


def test_a_bundle_is_checked_and_complete(tmp_path: Path) -> None:
    torch.manual_seed(0)
    config = ClassifierConfig(layers=1)
    export = Export(
        name="tiny",
        version="0.0.1",
        task="classify",
        network=Calibrated(Classifier(config), 1.5).eval(),
        windows=windows(75),
        output_frames=0,
        labels=GESTURES,
        info=INFO,
    )
    seen: list[MotionManifest] = []

    def card(manifest: MotionManifest) -> str:
        seen.append(manifest)
        return f"# {manifest.name}\n"

    write_bundle(export, tmp_path / "tiny", lambda path: {"size": path.stat().st_size}, card)
    manifest = read_manifest(tmp_path / "tiny")
    assert manifest.results["size"] > 0
    assert manifest.labels == list(GESTURES)
    assert [s.synthetic for s in manifest.training.data] == [True, False]
    assert seen[0].training.seed == 1
    model = OnnxModel(tmp_path / "tiny" / MODEL_FILE)
    with np.load(tmp_path / "tiny" / GOLDEN_FILE) as golden:
        np.testing.assert_array_equal(model(golden["motion"]), golden["probabilities"])
    assert (tmp_path / "tiny" / GOLDEN_FILE).stat().st_size < 200_000


def test_the_temperature_undoes_a_scaling() -> None:
    rng = torch.Generator().manual_seed(0)
    logits = 2 * torch.randn(4000, 3, generator=rng)
    labels = torch.multinomial(torch.softmax(logits, -1), 1, generator=rng)[:, 0]
    assert fit_temperature(3 * logits, labels) == pytest.approx(3.0, rel=0.15)
