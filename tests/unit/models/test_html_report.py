"""The HTML page of motion prediction: its numbers, its titles, and that it stands alone."""

import re
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from matplotlib import pyplot

from agent_server.domain.skeleton import CoreJoint
from models.data.layouts import CMU, CORE, H36M
from models.evaluation.figures.anatomy import joint_names, loose_ends, oblique_axes
from models.evaluation.figures.comparison import typical
from models.evaluation.figures.embedding import own_share
from models.evaluation.figures.style import colours
from models.evaluation.html_report import DATA, write_report
from models.evaluation.prediction import Outcome, summary
from models.evaluation.protocols import PROTOCOLS, Protocol

PROTOCOL = PROTOCOLS["server"]
ACTIONS = ("walking", "jumping")


@dataclass(frozen=True)
class Measured:
    """What ``summary`` asks of a predictor."""

    name: str
    parameters: int = 1234

    def window_ms(self) -> float:
        return 0.25


def outcomes(share: float, protocol: Protocol = PROTOCOL) -> dict[str, Outcome]:
    """Predictions that make a share of the true movement, 1 being the truth itself."""
    rng = np.random.default_rng(7)
    found = {}
    for number, action in enumerate(ACTIONS):
        joints = len(protocol.layout.joints)
        pose = np.zeros((1, 1, joints, 3))
        pose[..., CoreJoint.RIGHT_SHOULDER, 0], pose[..., CoreJoint.LEFT_SHOULDER, 0] = 200, -200
        pose[..., CoreJoint.HEAD, 1] = 500
        steps = rng.normal(0, 3 + number, (6, protocol.seen + protocol.future, joints, 3))
        motion = (pose + np.cumsum(steps, axis=1)).astype(np.float32)
        seen, true = motion[:, : protocol.seen], motion[:, protocol.seen :]
        last = seen[:, -1:]
        predicted = (last + share * (true - last)).astype(np.float32)
        found[action] = Outcome(seen, predicted, true, protocol.measure(predicted, true))
    return found


def report(folder: Path, shares: dict[str, float]) -> tuple[str, dict[str, dict[str, Any]]]:
    results = {name: outcomes(share) for name, share in shares.items()}
    summaries = {
        name: summary(Measured(name), PROTOCOL, found)  # type: ignore[arg-type]
        for name, found in results.items()
    }
    path = write_report(folder, PROTOCOL, results, summaries)
    return path.read_text(encoding="utf-8"), summaries


class Page(HTMLParser):
    """Tables as lists of model -> key -> text, the bold cells, and the titles."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[dict[str, dict[str, str]]] = []
        self.bold: list[set[tuple[str, str]]] = []
        self.titles: list[str] = []
        self._model = self._key = self._tag = ""
        self.feed(text.replace("\u00a0", " "))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        if tag == "table":
            self.tables.append({})
            self.bold.append(set())
        elif tag == "tr":
            self._model = given.get("data-model", "")
        elif tag == "td":
            self._key = given["data-key"]
        elif tag == "b":
            self.bold[-1].add((self._model, self._key))
        elif tag == "h2":
            self.titles.append("")
        if tag in {"td", "h2"}:
            self._tag = tag

    def handle_endtag(self, tag: str) -> None:
        if tag == self._tag:
            self._tag = ""

    def handle_data(self, data: str) -> None:
        if self._tag == "td":
            self.tables[-1].setdefault(self._model, {})[self._key] = data
        elif self._tag == "h2":
            self.titles[-1] += data


SHARES = {"server": 0.6, "one_fc": 0.3, "zero_velocity": 0.0}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("page") / "deep" / "report"
    text, summaries = report(folder, SHARES)
    return folder, text, summaries


def test_tables_hold_the_figures_of_every_model(written: tuple[Path, str, dict[str, Any]]) -> None:
    _, text, summaries = written
    average, motion, *by_action = Page(text).tables
    assert list(average) == list(motion) == list(SHARES)
    for model, given in summaries.items():
        assert {ms: float(cell) for ms, cell in average[model].items()} == {
            ms: pytest.approx(error, abs=0.051) for ms, error in given["average"]["mpjpe"].items()
        }
        for table, action in zip(by_action, ACTIONS, strict=True):
            for ms, error in given["actions"][action]["mpjpe"].items():
                assert float(table[model][ms]) == pytest.approx(error, abs=0.051)
        expected = given["average"]
        assert float(motion[model]["mpjs_error"]) == pytest.approx(expected["mpjs_error"])
        assert float(motion[model]["jump_mm"]) == pytest.approx(expected["jump_mm"], abs=0.051)
        assert float(motion[model]["bone_error_mm"]) == pytest.approx(expected["bone_error_mm"])
        assert motion[model]["parameters"] == "1,234"
        assert motion[model]["ms_per_window"] == "0.25"


def test_the_best_of_each_column_is_bold(written: tuple[Path, str, dict[str, Any]]) -> None:
    average, motion, *_ = Page(written[1]).bold
    assert average == {("server", str(ms)) for ms in PROTOCOL.horizons_ms}
    assert {("server", "mpjs_error"), ("server", "jump_mm")} <= motion


def test_titles_state_what_the_numbers_say(written: tuple[Path, str, dict[str, Any]]) -> None:
    titles = Page(written[1]).titles
    # Errors are those of the share of movement that is missing.
    assert titles[1].startswith("server is 60 % under zero_velocity at 80 ms and 60 % under it at")
    assert titles[1].endswith("ahead of one_fc at 8 of 8 horizons")
    assert (
        titles[2] == "server moves at 60 % of the true speed; its first step is 40 % shorter "
        "than the true one"
    )
    assert "walking" in titles[4]
    assert "jumping" in titles[5]


def test_titles_follow_other_numbers(
    tmp_path: Path, written: tuple[Path, str, dict[str, Any]]
) -> None:
    worse, _ = report(tmp_path, {"server": -0.25, "one_fc": 0.3, "zero_velocity": 0.0})
    before, after = Page(written[1]).titles, Page(worse).titles
    assert after[1].startswith("server is 25 % over zero_velocity at 80 ms")
    assert after[1].endswith("ahead of one_fc at 0 of 8 horizons")
    assert all(old != new for old, new in zip(before[1:], after[1:], strict=True))


def test_a_lone_baseline_is_reported_in_millimetres(tmp_path: Path) -> None:
    text, summaries = report(tmp_path, {"zero_velocity": 0.0})
    errors = summaries["zero_velocity"]["average"]["mpjpe"]
    assert Page(text).titles[1] == (
        f"zero_velocity is {errors['80']:.1f} mm off at 80 ms and {errors['2000']:.1f} mm at 2 s"
    )


def test_the_page_stands_alone_in_its_folder(written: tuple[Path, str, dict[str, Any]]) -> None:
    folder, text, _ = written
    assert [path.name for path in folder.parent.rglob("*") if path.is_file()] == ["index.html"]
    markup = re.sub(r'data:image/png;base64,[^"]+', "PICTURE", text)
    assert re.findall(r'(?:src|href)="([^"]*)"', markup) == ["PICTURE"] * 6
    assert not re.search(r"https?:|//|@import|<script|<link|<iframe|url\(", markup)


def test_the_lead_says_what_was_measured(tmp_path: Path, written: tuple[Path, str, Any]) -> None:
    lead = re.sub(r"<[^>]+>", "", re.search(r'class="lead">(.*?)</p>', written[1])[1])  # type: ignore[index]
    lead = lead.replace("\u00a0", " ")
    assert "Protocol server: 12 windows of 2 actions; 1 s are seen and 2 s predicted" in lead
    assert "MPJPE" in lead
    assert "CMU" in lead


def test_level_models_are_both_bold_and_neither_is_ahead(tmp_path: Path) -> None:
    text, _ = report(tmp_path, {"server": 0.5, "one_fc": 0.5})
    page = Page(text)
    assert {model for model, _ in page.bold[0]} == {"server", "one_fc"}
    assert page.titles[1].endswith("ahead of one_fc at 0 of 8 horizons")


def test_every_protocol_says_where_its_windows_come_from() -> None:
    said = {name: DATA.get(name) or DATA[protocol.data] for name, protocol in PROTOCOLS.items()}
    for name in ("h36m-256", "h36m-rms"):
        assert "Weights trained on Human3.6M are for research only" in said[name]


def test_names_are_escaped(tmp_path: Path) -> None:
    text, _ = report(tmp_path, {"a<b>&c": 0.5})
    assert "a<b>" not in text
    assert "a&lt;b&gt;&amp;c" in text


def test_figures_leave_no_global_state(written: tuple[Path, str, dict[str, Any]]) -> None:
    assert written[1].count("<figure>") == 6
    assert pyplot.get_fignums() == []


@pytest.mark.parametrize("layout", [H36M, CMU, CORE], ids=lambda layout: layout.name)
def test_names_of_joints_mirror_as_the_layout_does(layout: Any) -> None:
    names = joint_names(layout)
    assert len(set(names)) == len(layout.joints)
    other = {"left": "right", "right": "left"}
    for name, counterpart in zip(names, layout.mirror, strict=True):
        side, _, part = name.partition(" ")
        assert names[counterpart] == (f"{other[side]} {part}" if side in other else name)


def test_only_layouts_without_a_pelvis_have_loose_ends() -> None:
    assert loose_ends(CORE) == []
    assert [joint_names(H36M)[at] for at in loose_ends(H36M)] == [
        "right knee",
        "left knee",
        "spine",
    ]
    names = [joint_names(CMU)[at] for at in loose_ends(CMU)]
    assert names == ["left knee", "right knee", "lower back"]


@pytest.mark.parametrize("turn", [0.0, 1.1, 3.0])
def test_a_body_is_seen_from_its_front_however_it_stands(turn: float) -> None:
    facing_sensor = np.zeros((9, 3))
    facing_sensor[CoreJoint.RIGHT_SHOULDER] = (0.2, 0.4, 2.0)
    facing_sensor[CoreJoint.LEFT_SHOULDER] = (-0.2, 0.4, 2.0)
    facing_sensor[CoreJoint.HEAD] = (0, 0.7, 2.0)
    facing_sensor[CoreJoint.LEFT_WRIST] = (-0.2, 0.4, 1.4)  # stretched forward
    cos, sin = np.cos(turn), np.sin(turn)
    turned = facing_sensor @ np.array([[cos, 0, -sin], [0, 1, 0], [sin, 0, cos]])
    drawn = turned @ oblique_axes(turned, CORE).T
    assert drawn[CoreJoint.RIGHT_SHOULDER, 0] < drawn[CoreJoint.LEFT_SHOULDER, 0]
    assert drawn[CoreJoint.HEAD, 1] > drawn[CoreJoint.LEFT_SHOULDER, 1]
    # A reader who looks from a little above sees what is nearer lower.
    assert drawn[CoreJoint.LEFT_WRIST, 1] < drawn[CoreJoint.LEFT_SHOULDER, 1]
    still = facing_sensor @ oblique_axes(facing_sensor, CORE).T
    assert np.allclose(drawn - drawn[0], still - still[0], atol=1e-5)


def test_own_share_counts_what_lies_nearest_to_its_own_truth() -> None:
    true = np.array([[0, 0], [10, 0], [20, 0]], np.float32)
    assert own_share(true + 1, true) == 100
    assert own_share(np.array([[1, 0], [2, 0], [19, 0]], np.float32), true) == pytest.approx(
        200 / 3
    )
    assert own_share(np.full((3, 2), 5, np.float32), true) == 0  # as near to the first two


def test_the_typical_window_has_the_median_error() -> None:
    assert typical(np.array([9, 1, 5, 3, 7], np.float32)) == 2
    assert typical(np.array([4, 1, 3, 2], np.float32)) == 3


def test_a_model_keeps_its_colour_and_no_two_share_one() -> None:
    alone, together = colours(["best"]), colours(["mine", "best", "zero_velocity", "other"])
    assert together["best"] == alone["best"]
    assert len(set(together.values())) == 4
