"""Predicted and true futures laid out on a plane, the closer the more alike."""

import numpy as np
from sklearn.manifold import TSNE

from agent_server.domain.arrays import Float32, Float64
from models.evaluation.figures.comparison import Comparison
from models.evaluation.figures.style import INK, QUIET, RULE, Plot, figure, png, text_colour
from models.evaluation.prediction import Outcome

WINDOWS = 300
COLUMNS = 3
"""Panels side by side, at most."""
SEED = 0
PERPLEXITY = 30


def embedding_plot(comparison: Comparison) -> Plot:
    """t-SNE (van der Maaten and Hinton, 2008) of what moves after the last seen pose.

    The shares in the titles are counted in the full space; the plane is for the eye.
    """
    true = _movements(comparison, comparison.subject, of_truth=True)
    predicted = {
        model: _movements(comparison, model, of_truth=False) for model in comparison.models
    }
    shares = {model: own_share(rows, true) for model, rows in predicted.items()}
    plane = _plane(np.concatenate([true, *predicted.values()]))
    places = np.split(plane, len(predicted) + 1)

    rows = -(-len(predicted) // COLUMNS)
    made = figure(0.5 + 3.8 * rows)
    grid = made.subplots(rows, -(-len(predicted) // rows), squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, model, spots in zip(grid.flat, predicted, places[1:], strict=False):
        axes.set_axis_on()
        axes.set_xticks([])
        axes.set_yticks([])
        axes.spines[:].set_color(RULE)
        axes.set_xlabel("t-SNE 1, no unit", color=QUIET, fontsize=9)
        axes.set_ylabel("t-SNE 2, no unit", color=QUIET, fontsize=9)
        axes.scatter(*places[0].T, s=13, color="#b9bfc7", linewidths=0, label="true")
        colour = comparison.colours[model]
        axes.scatter(*spots.T, s=15, color=colour, linewidths=0, alpha=0.8, label="predicted")
        axes.set_title(
            f"{model}: {shares[model]:.0f} % nearest their own",
            color=text_colour(colour),
            fontsize=10,
            fontweight="bold",
            loc="left",
            pad=12,
        )
        legend = axes.legend(
            loc="lower right",
            fontsize=8.5,
            framealpha=0.9,
            edgecolor="none",
            handletextpad=0.1,
            borderpad=0.2,
        )
        for text in legend.get_texts():
            text.set_color(INK)
    others = [f"`{m}` {shares[m]:.0f} %" for m in comparison.models[1:]]
    aside = f" ({', '.join(others)})" if others else ""
    return Plot(
        "Likeness of predicted and true motion",
        f"{shares[comparison.subject]:.0f} % of what `{comparison.subject}` predicts is nearest to "
        f"its own true future{aside}",
        f"t-SNE, seed {SEED}, of {len(true)} windows spread evenly over the actions. A dot is a "
        "future as offsets of all joints from the last seen pose; grey dots are the true ones, the "
        "same in each panel. The shares are counted among the shown windows in the full space, not "
        "on this plane, whose axes and distances have no unit. A model that always stands still "
        "has one dot.",
        png(made),
    )


def own_share(predicted: Float32, true: Float32) -> float:
    """Percent of the predictions whose nearest true row is their own; both (N, D).

    A prediction that is as near to another true row as to its own does not count.
    """
    squares = np.square(true.astype(np.float64)).sum(1)
    distance = squares - 2 * predicted.astype(np.float64) @ true.T.astype(np.float64)
    own = distance.diagonal().copy()
    np.fill_diagonal(distance, np.inf)
    return float(100 * (own < distance.min(axis=1)).mean())


def _movements(comparison: Comparison, model: str, *, of_truth: bool) -> Float32:
    """Offsets of the futures of evenly chosen windows from their last seen poses, (N, D) mm."""
    outcomes = comparison.results[model].values()
    rows = np.concatenate([_offsets(outcome, of_truth) for outcome in outcomes])
    chosen = np.linspace(0, len(rows) - 1, min(WINDOWS, len(rows))).round().astype(int)
    kept: Float32 = rows[chosen]
    return kept


def _offsets(outcome: Outcome, of_truth: bool) -> Float32:
    future = outcome.true if of_truth else outcome.predicted
    offsets: Float32 = future - outcome.seen[:, -1:]
    return offsets.reshape(len(future), -1)


def _plane(rows: Float32) -> Float64:
    """Places (N, 2); equal rows share one, else copies would push each other apart."""
    different, which = np.unique(rows, axis=0, return_inverse=True)
    perplexity = min(PERPLEXITY, (len(different) - 1) / 3)
    embed = TSNE(perplexity=perplexity, init="pca", random_state=SEED, n_jobs=1)
    places: Float64 = embed.fit_transform(different)[which]
    return places
