"""The HTML page of a gesture classifier: its numbers, its words, and that it stands alone."""

import json
import re
from dataclasses import dataclass, replace
from html import unescape
from pathlib import Path

import pytest

pytest.importorskip("torch", reason="needs the train extra")

from matplotlib import pyplot
from typer.testing import CliRunner

from agent_server.domain.gesture import IDLE
from agent_server.errors import InvalidInput
from models.__main__ import app
from models.data.windows import Recording, Stretch
from models.evaluation.figures.gestures import percent
from models.evaluation.gesture_findings import verdict_sentences, verdict_title
from models.evaluation.gesture_measures import GestureMeasures, figures_of, measure
from models.evaluation.gesture_page import show_measures, write_gesture_page
from models.evaluation.gestures import hold_last
from models.evaluation.readings import HELD, PREDICTED, TRUE
from tests.support.raised_hands import CLASSES, by_last_frame, moving_on, raised, resting

TAKES = [
    *(raised("wave", onset, person="v01") for onset in range(40, 70)),
    *(raised("point", onset, person="v02") for onset in range(40, 60)),
    *(resting(person="v03") for _ in range(3)),
]


def text_of(markup: str) -> str:
    return unescape(re.sub(r"<[^>]+>", "", markup)).replace("\u00a0", " ")


@dataclass(frozen=True)
class Page:
    """What a reader finds on a page."""

    markup: str

    @property
    def titles(self) -> list[str]:
        return [text_of(title) for title in re.findall(r"<h2>(.*?)</h2>", self.markup)]

    def row(self, table: int, name: str) -> dict[str, str]:
        """Key -> text of a row of one of the tables."""
        rows = re.findall(r"<tbody>(.*?)</tbody>", self.markup)[table]
        row = re.search(rf'<tr data-model="{re.escape(name)}">(.*?)</tr>', rows)
        assert row is not None
        cells = re.findall(r'<td data-key="([^"]+)">(.*?)</td>', row[1])
        return {key: text_of(text) for key, text in cells}

    def bold(self, table: int) -> set[str]:
        rows = re.findall(r"<tbody>(.*?)</tbody>", self.markup)[table]
        return set(re.findall(r'data-key="([^"]+)"><b>', rows))


@pytest.fixture(scope="module")
def measured() -> GestureMeasures:
    return measure(by_last_frame, moving_on, TAKES, CLASSES)


@pytest.fixture(scope="module")
def page(measured: GestureMeasures, tmp_path_factory: pytest.TempPathFactory) -> Page:
    folder = tmp_path_factory.mktemp("page") / "deep" / "report"
    path = show_measures(folder, "SYNTHETIC benchmark: `a<b>` on virtual people", measured)
    assert [found.name for found in folder.rglob("*")] == ["index.html"]
    return Page(path.read_text(encoding="utf-8"))


def test_tables_hold_the_figures(page: Page, measured: GestureMeasures) -> None:
    figures = figures_of(measured)
    for reading in (PREDICTED, HELD, TRUE):
        row, given = page.row(0, reading), figures[reading]
        assert float(row["accuracy"]) == pytest.approx(100 * given["accuracy"], abs=0.06)
        assert float(row["balanced"]) == pytest.approx(100 * given["balanced_accuracy"], abs=0.06)
        assert float(row["ece"]) == pytest.approx(100 * given["ece"], abs=0.06)
        assert float(row["accepted"]) == pytest.approx(100 * given["rejecting"]["accepted"])
    for reading in (PREDICTED, HELD):
        row, given = page.row(1, reading), figures["decisions"][reading]
        assert float(row["right"]) == pytest.approx(100 * given["right"], abs=0.06)
        assert float(row["p50"]) == pytest.approx(given["delay_s_p50"], abs=0.006)
        assert float(row["false"]) == pytest.approx(given["false_per_10_minutes"], abs=0.06)
    for name in CLASSES:
        row = page.row(2, name)
        assert int(row["windows"].replace(",", "")) == int(measured.of(name).sum())
        for reading in (PREDICTED, HELD, TRUE):
            recall = figures[reading]["recall"][name]
            assert float(row[reading]) == pytest.approx(100 * recall, abs=0.06)
    assert page.row(2, "wave")["p"] == "< 0.001"
    assert (page.row(2, IDLE)["decided"], page.row(2, "wave")["decided"]) == ("\u2013", "100")


def test_the_best_that_can_be_had_live_is_bold(page: Page) -> None:
    assert "<b>" not in re.search(rf'<tr data-model="{TRUE}">.*?</tr>', page.markup)[0]  # type: ignore[index]
    assert float(page.row(1, PREDICTED)["p50"]) < float(page.row(1, HELD)["p50"])
    assert f"<b>{page.row(1, PREDICTED)['p50']}</b>" in page.markup
    assert f"<b>{page.row(1, HELD)['p50']}</b>" not in page.markup
    assert "accepted" not in page.bold(0)


def test_titles_state_what_the_numbers_say(page: Page, measured: GestureMeasures) -> None:
    accuracy = 100 * measured.gain.accuracy[PREDICTED]
    gain = 1000 * (measured.live[HELD].delay_s(50) - measured.live[PREDICTED].delay_s(50))  # type: ignore[operator]
    assert page.titles[0].startswith(f"{accuracy:.1f} % of the windows are named right")
    assert (
        page.titles[2]
        == "0.3 s seen are enough to name 9 of 10 gestures with 2 s predicted, 0.6 s with the last "
        "frame held"
    )
    assert page.titles[3].startswith("100 % of the gestures are decided right, half of these")
    assert page.titles[3].endswith(f"the prediction makes the median {gain:.0f} ms earlier")
    shows = ~measured.of(IDLE)
    before, after = (100 * measured.right[name][shows].mean() for name in (HELD, PREDICTED))
    assert before < after
    assert page.titles[7] == (
        f"The prediction helps gestures ({before:.1f} to {after:.1f} % right) and makes no sure "
        "difference to idle (100.0 to 100.0 % right)"
    )
    assert page.titles[8] == (
        "The prediction adds most at 0.3 s seen, 100 points, and there most for wave"
    )


def test_titles_follow_other_numbers(page: Page, tmp_path: Path) -> None:
    blind = write_gesture_page(tmp_path, "Blind", by_last_frame, hold_last, TAKES, CLASSES)
    titles = Page(blind.read_text(encoding="utf-8")).titles
    assert titles[2] == (
        "0.6 s seen are enough to name 9 of 10 gestures, with 2 s predicted as with the last frame "
        "held"
    )
    assert titles[3].endswith("with the last frame held the median is the same")
    assert titles[7].startswith("The prediction makes no sure difference to gestures (")
    assert titles[8] == (
        "At no time seen does the prediction name more gestures right than a held frame"
    )
    assert titles[9] == (
        "1 s ahead, predicted hands are never nearer the truth than held ones for any class"
    )


def test_words_say_where_the_prediction_helps_and_where_not(measured: GestureMeasures) -> None:
    first, over_time, by_class, *others = verdict_sentences(measured)
    assert f"Over all {len(measured.labels):,} windows" in first
    assert "p < 0.001" in first
    # From 0.3 to 0.5 s the speed tells what the height does not.
    assert "ahead beyond chance at 3 times between 0.3 and 0.5 s after the onset" in over_time
    assert "`wave`" in by_class
    assert "`point`" in by_class
    assert others == [
        "It makes no sure difference to `idle` (+0.0 points, p = 1.000): even the true 2 s change "
        "little (+0.0 points); the second that is seen names 100.0 % right already."
    ]


def test_words_turn_with_the_numbers(measured: GestureMeasures) -> None:
    rows = measured.probabilities
    swapped = replace(
        measured,
        probabilities={PREDICTED: rows[HELD], HELD: rows[PREDICTED], TRUE: rows[TRUE]},
        seen=replace(
            measured.seen,
            right={
                PREDICTED: measured.seen.right[HELD],
                HELD: measured.seen.right[PREDICTED],
                TRUE: measured.seen.right[TRUE],
            },
        ),
    )
    assert verdict_title(swapped).startswith("The prediction hurts gestures (")
    said = verdict_sentences(swapped)
    assert "the prediction is behind at 3 times between 0.3 and 0.5 s" in said[1]
    for name in ("wave", "point"):
        words = next(sentence for sentence in said if sentence.startswith(f"It hurts `{name}`"))
        assert words.endswith("more of its windows are taken for `idle`.")


def test_figures_are_json_without_what_json_lacks(measured: GestureMeasures) -> None:
    figures = json.loads(json.dumps(figures_of(measured), allow_nan=False))
    assert figures["people"] == 3
    assert figures["time_seen"]["gestures"][0] == 50
    assert figures["time_seen"][PREDICTED][0] == 1
    assert figures["time_seen"][HELD][0] == 0
    assert figures["prediction"]["verdict"] == "helps"
    assert set(figures["prediction"]["classes"]) == set(CLASSES)
    assert sum(figures["reliability"]["windows"]) == figures[PREDICTED]["windows"]


def test_the_page_stands_alone_and_every_picture_is_described(page: Page) -> None:
    markup = re.sub(r'data:image/png;base64,[^"]+', "PICTURE", page.markup)
    assert re.findall(r'(?:src|href)="([^"]*)"', markup) == ["PICTURE"] * 8
    assert not re.search(r"https?:|//|@import|<script|<link|<iframe|url\(", markup)
    described = re.findall(r'<img alt="([^"]*)"', markup)
    assert len(set(described)) == 8
    assert {text_of(alt) for alt in described} <= set(page.titles)
    assert pyplot.get_fignums() == []


def test_titles_are_escaped(page: Page) -> None:
    assert "a<b>" not in page.markup
    assert "<title>SYNTHETIC benchmark: a&lt;b&gt; on virtual people</title>" in page.markup


def test_gestures_too_short_for_a_curve_leave_it_out_whatever_they_are_called(
    tmp_path: Path,
) -> None:
    """A stretch of 0.68 s shows the gesture for no longer than it takes to count."""

    def briefly(gesture: str) -> Recording:
        whole = raised(gesture)
        return Recording(whole.observed, whole.clean, (Stretch(f"<{gesture}>", 70, 86),), "v01")

    takes = [briefly("wave"), briefly("point"), resting()]
    classes = ("<wave>", "<point>", IDLE)
    written = write_gesture_page(tmp_path, "Brief", by_last_frame, moving_on, takes, classes)
    page = Page(written.read_text(encoding="utf-8"))
    assert page.markup.count("<figure>") == 6
    assert "too short to compare" in page.markup
    assert "<wave>" not in page.markup
    assert "<code>&lt;wave&gt;</code>" in page.markup


def test_only_the_synthetic_benchmark_has_a_page(tmp_path: Path) -> None:
    words = ["evaluate", "gestures", "--data", ".", "--benchmark", "live", "--report", tmp_path]
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 2
    assert "--benchmark synthetic only" in re.sub(r"[\u2502\s]+", " ", result.output)
    assert list(tmp_path.iterdir()) == []


def test_recordings_without_gestures_are_refused() -> None:
    with pytest.raises(InvalidInput, match="no recording shows a gesture"):
        measure(by_last_frame, moving_on, [resting()], CLASSES)


@pytest.mark.parametrize(
    ("share", "said"),
    [(0.0, "0 %"), (0.004, "0.4 %"), (0.5, "50 %"), (0.996, "99.6 %"), (1, "100 %")],
)
def test_percentages_never_round_to_all_or_nothing(share: float, said: str) -> None:
    assert percent(share) == said
