"""What HP-GAN's losses do: the same short training with all of them, and with one left out."""

from pathlib import Path
from typing import Any

from agent_server.domain.arrays import Float32
from models.evaluation.sampled import drawn_figures, trained_sampler
from models.hp_gan.config import CONFIGS
from models.hp_gan.sampler import Sampler, random_vectors
from models.hp_gan.source import server_source
from models.hp_gan.train import load_hp_gan, train_on
from models.training.run import INFO, Run

ROWS = {
    "all": "short",
    "without diversity": "short_without_diversity",
    "without consistency": "short_without_consistency",
}
DRAWS = 4


def losses_report(
    folder: Path, held: dict[str, tuple[Float32, Float32]], data: Path, cache: Path, seed: int = 0
) -> dict[str, Any]:
    """Figures of each row on held-out windows; runs that are there are only measured again.

    Args:
        folder: Where the runs are kept, one folder a row.
        held: Set -> seen (N, 25, 9, 3) and true future (N, 50, 9, 3), metres.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
        seed: Of every training.
    """
    missing = [name for name in ROWS.values() if not (folder / name / INFO).exists()]
    if missing:
        source = server_source(data, cache, CONFIGS["short"].synthetic_sequences)
        for name in missing:
            command = f"python -m models train hp_gan --config {name} --data DIR --out RUN"
            run = Run(folder / name, CONFIGS[name], seed, command, resume=False)
            train_on(CONFIGS[name], run, source)
    rows: dict[str, Any] = {}
    for name, config in ROWS.items():
        generator, _, judge = load_hp_gan(folder / config)
        table = random_vectors(generator.config.noise)
        draw = trained_sampler(Sampler(generator, judge, table).eval())
        rows[name] = {
            where: drawn_figures(draw(seen, DRAWS), seen, true)
            for where, (seen, true) in held.items()
        }
    return rows
