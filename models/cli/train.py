"""``python -m models train``."""

from pathlib import Path
from typing import Annotated

import torch
import typer

from models.affect.config import named
from models.affect.runs import train_run, training_faces
from models.bigraphdiff.config import CONFIGS as BIGRAPHDIFF_CONFIGS
from models.bigraphdiff.train import train as train_bigraphdiff
from models.cli.options import (
    ARTIFACTS,
    CACHE,
    AffectInputOption,
    CacheOption,
    DataOption,
    OutOption,
    SeedOption,
    configured,
    show,
)
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import TRAINED, cut, join
from models.evaluation.affect import affect_measures
from models.hp_gan.config import CONFIGS as HP_GAN_CONFIGS
from models.hp_gan.train import train as train_several
from models.interformer.config import CONFIGS as INTERFORMER_CONFIGS
from models.interformer.generator.config import CONFIGS as GENERATOR_CONFIGS
from models.interformer.generator.train import train as train_generator
from models.interformer.train import train as train_classifier
from models.ma_wgan.config import CONFIGS as MA_WGAN_CONFIGS
from models.ma_wgan.train import load_predictor
from models.ma_wgan.train import train as train_predictor
from models.simlpe.config import CONFIGS as SIMLPE_CONFIGS
from models.simlpe.train import train as train_baseline
from models.training.run import Run

app = typer.Typer(no_args_is_help=True, help="Train a model.")

ConfigOption = Annotated[str, typer.Option("--config", help="Name of the configuration.")]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with the run in --out.")]
StepsOption = Annotated[int | None, typer.Option("--steps", help="Instead of the config's.")]


def _command(model: str, config: str, seed: int, steps: int | None, extra: str = "") -> str:
    """The command for the card; folders are left to the reader."""
    count = "" if steps is None else f" --steps {steps}"
    return (
        f"python -m models train {model} --config {config} --data DIR{extra} --out RUN"
        f" --seed {seed}{count}"
    )


@app.command("ma_wgan")
def train_ma_wgan(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "server",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train a manifold-aware GAN: the server's predictor, or one of the literature's data."""
    chosen = configured(MA_WGAN_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("ma_wgan", config, seed, steps), resume)
    train_predictor(chosen, run, data, cache)


@app.command("affect")
def train_affect(
    data: DataOption,
    out: OutOption,
    source: AffectInputOption = "mesh",
    config: ConfigOption = "default",
    seed: SeedOption = 0,
    folds: Annotated[int, typer.Option(help="Of the cross-validation.")] = 5,
    cache: CacheOption = CACHE,
) -> None:
    """Train a model that reads valence and arousal off faces, after a cross-validation."""
    torch.set_num_threads(1)
    command = (
        f"python -m models train affect --input {source} --config {config} --data DIR --out RUN"
        f" --seed {seed} --folds {folds}"
    )
    chosen = named(config, source)
    run = Run(out, chosen, seed, command, resume=False)
    validated = train_run(chosen, training_faces(chosen, data, ARTIFACTS, cache), run, folds)
    show(affect_measures(validated.estimates, validated.affect), as_json=False)


@app.command("simlpe")
def train_simlpe(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "cpu",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train siMLPe, the baseline of the literature."""
    chosen = configured(SIMLPE_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("simlpe", config, seed, steps), resume)
    train_baseline(chosen, run, data, cache)


@app.command("hp_gan")
def train_hp_gan(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "server",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train a GAN that draws several futures, with the network that judges them."""
    chosen = configured(HP_GAN_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("hp_gan", config, seed, steps), resume)
    train_several(chosen, run, data, cache)


@app.command("interformer")
def train_interformer(
    data: DataOption,
    out: OutOption,
    predictor: Annotated[Path, typer.Option("--predictor", help="Run of a trained predictor.")],
    config: ConfigOption = "server",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
    cache: CacheOption = CACHE,
) -> None:
    """Train the classifier on seen and predicted frames."""
    chosen = configured(INTERFORMER_CONFIGS, config, steps)
    command = _command("interformer", config, seed, steps, " --predictor PREDICTOR_RUN")
    run = Run(out, chosen, seed, command, resume)
    training = join(
        [
            cut(synthetic_split(cache, "train", chosen.synthetic_sequences), margins=TRAINED),
            cut(cmu_split(data, "train")),
        ]
    )
    validation = join(
        [
            cut(synthetic_split(cache, "validation"), stride=5),
            cut(cmu_split(data, "validation"), stride=5),
        ]
    )
    train_classifier(chosen, run, training, validation, load_predictor(predictor))


@app.command("reaction")
def train_reaction(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "sbu",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
) -> None:
    """Train a generator of reactions on SBU's or K3HI's training split."""
    chosen = configured(GENERATOR_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("reaction", config, seed, steps), resume)
    train_generator(chosen, run, data)


@app.command("bigraphdiff")
def train_interactions(
    data: DataOption,
    out: OutOption,
    config: ConfigOption = "sbu",
    seed: SeedOption = 0,
    resume: ResumeOption = False,
    steps: StepsOption = None,
) -> None:
    """Train a generator of both people's motion on the training split of a set."""
    chosen = configured(BIGRAPHDIFF_CONFIGS, config, steps)
    run = Run(out, chosen, seed, _command("bigraphdiff", config, seed, steps), resume)
    train_bigraphdiff(chosen, run, data)
