"""The page of a gap: every figure is drawn, every number is that of the result."""

from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from odometry.digits import three_figures
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import InBursts
from odometry.effects.measurement.reference_outliers import ReferenceOutliers
from odometry.effects.unknown.history import History
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.config import GapConfig
from odometry.gap.locate.locate import Location, Predictor
from odometry.gap.locate.variables import Variable
from odometry.gap.name.general import general_candidates
from odometry.gap.prepare.statistic import gap_of, squared_errors
from odometry.gap.show.quantities import with_interval
from odometry.gap.show.words import sentences
from odometry.report.gap.gap_figures import rolling_rms
from odometry.report.gap.gap_map import binned_rms, scale_of
from odometry.report.gap.gap_page import (
    MEASURED_NAME,
    event_grids,
    rollout,
    rollouts,
    write_gap_report,
)
from odometry.report.gap.gap_shapes import shape_of, shape_pictures
from odometry.report.gap.gap_tables import worst_grid


class Page(HTMLParser):
    """Tags, all text, and the text of cells."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.cells, self.inside = [], [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.inside = tag in {"td", "th"}

    def handle_endtag(self, tag):
        self.inside = False if tag in {"td", "th"} else self.inside

    def handle_data(self, data):
        self.texts.append(data)
        self.cells += [data] if self.inside else []


@pytest.fixture(scope="module")
def written(scaled_result, tmp_path_factory):
    out = tmp_path_factory.mktemp("gap") / "new"
    return out, write_gap_report(scaled_result, out)


@pytest.fixture(scope="module")
def page(written):
    return Page((written[0] / "report.html").read_text(encoding="utf-8"))


def test_files_are_written_and_named(written):
    out, files = written
    names = [str(file.relative_to(out)) for file in files]
    assert names == [
        "figures/gap_closing.png",
        "figures/gap_map.png",
        "figures/gap_time.png",
        "figures/gap_rollout_1.png",
        "figures/gap_evidence.png",
        "report.html",
    ]
    assert all(file.stat().st_size > 5000 for file in files)


def test_the_page_stands_alone_and_escapes_names(page, written):
    images = [attrs for tag, attrs in page.tags if tag == "img"]
    assert len(images) == 5
    assert all(image["src"].startswith("data:image/png;base64,") for image in images)
    assert all(image["alt"] for image in images)
    assert not [tag for tag, _ in page.tags if tag in {"script", "link", "iframe"}]
    assert "$hill^ & dale" in "".join(page.texts)
    assert "$hill^ & dale" not in (written[0] / "report.html").read_text(encoding="utf-8")


def test_words_and_tables_are_those_of_the_result(page, scaled_result):
    missing, sure, to_do, *others = sentences(scaled_result)
    short = (f"What is missing: {missing}", f"How sure: {sure}", f"What to do: {to_do}")
    for sentence in (*short, *others):
        assert page.texts.count(sentence) == 1
    assert min(map(page.texts.index, short)) < page.texts.index("The model")
    for closing in (scaled_result.measured, scaled_result.holdout):
        for gap in (closing.before, closing.after, closing.noise_floor):
            assert with_interval(gap) in page.cells
    for rival in scaled_result.rivals:
        assert {rival.name, f"{rival.evidence:.0f}", three_figures(rival.gap_after)} <= set(
            page.cells
        )
    for region in scaled_result.location.regions:
        assert region.words in page.cells
    assert {"0.790 to 0.820", "a free wheel", "traction_loss", "latency"} <= set(page.cells)


def test_the_same_bytes_twice_and_old_figures_go(scaled_result, none_result, written, tmp_path):
    again = write_gap_report(scaled_result, tmp_path)
    for old, new in zip(written[1], again, strict=True):
        assert old.read_bytes() == new.read_bytes()
    stray = tmp_path / "figures" / "gap_rollout_9.png"
    stray.write_bytes(b"old")
    other = tmp_path / "figures" / "mine.png"
    other.write_bytes(b"mine")
    write_gap_report(none_result, tmp_path)
    assert not stray.exists()
    assert other.exists()


def test_results_without_effects_candidates_or_variables(none_result, unknown_result, tmp_path):
    bare = replace(none_result, rivals=(), location=Location((), (), ()))
    files = write_gap_report(bare, tmp_path)
    assert [file.name for file in files] == [
        "gap_closing.png",
        "gap_time.png",
        "gap_rollout_1.png",
        "report.html",
    ]
    assert "candidate" not in Page(files[-1].read_text(encoding="utf-8")).cells
    text = write_gap_report(unknown_result, tmp_path)[-1].read_text(encoding="utf-8")
    assert "(unknown): it depends on heading" in text


def test_a_map_over_labels(scaled_result, tmp_path):
    predictors = (Predictor("turn", "", 0.01, False, 0.1, "size"),)
    location = Location(predictors, (), ("turn", "heading"))
    files = write_gap_report(replace(scaled_result, location=location), tmp_path)
    assert "gap_map.png" in [file.name for file in files]
    assert "Neither predicts it beyond chance." in files[-1].read_text(encoding="utf-8")


def test_rollouts_start_at_the_first_measured_pose(scaled_result):
    scene = scaled_result.holdout_scenes[0]
    paths = rollouts(scaled_result, scene)
    true = paths[MEASURED_NAME].poses
    for path in paths.values():
        np.testing.assert_allclose(path.poses[0, :2], true[0, :2], atol=1e-12)
    away = {n: np.hypot(*(p.poses[-1, :2] - true[-1, :2])) for n, p in paths.items()}
    assert away["after"] < 0.2 * away["before"]


def test_a_rollout_of_short_windows_is_the_simulation_of_the_gap(scaled_result, known):
    """Pieces of the path between the poses of windows are what the gap compares."""
    scene = scaled_result.measured_scenes[0]
    path = rollout(known.base, (), scene).poses
    first, last = path[scene.windows[:, 0]], path[scene.windows[:, -1]]
    start, end = scene.poses[scene.windows[:, 0]], scene.poses[scene.windows[:, -1]]

    def seen_from(pose, other):
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        x, y = (other - pose)[:, :2].T
        return np.column_stack([c * x + s * y, c * y - s * x])

    squares = ((seen_from(start, end) - seen_from(first, last)) ** 2).sum(axis=1)
    np.testing.assert_allclose(squares, squared_errors(known.base, (), scene), atol=1e-12)


def test_the_map_holds_all_windows(scaled_result, known, rng):
    scenes = scaled_result.holdout_scenes
    squares = squared_errors(known.base, (), scenes[0])
    count = len(squares)
    across = scale_of(Variable("pitch", "rad", "scalar", rng.normal(0, 0.1, count)))
    up = scale_of(Variable("turn", "", "label", rng.choice(["left", "right"], count)))
    assert across.title == "pitch [degrees]"
    assert 5 < across.edges[-1] < 25
    assert up.labels == ("left", "right")
    rms = binned_rms(squares, across, up)
    assert rms.shape == (2, len(across.edges) - 1)
    counts = np.zeros(rms.shape)
    np.add.at(counts, (up.bins, across.bins), 1)
    assert (np.isnan(rms) == (counts == 0)).all()
    total = np.sqrt(np.nansum(rms**2 * counts) / count)
    assert total == pytest.approx(gap_of(known.base, (), scenes, 10.0).value)


def test_rolling_rms_by_hand():
    time_s, squares = np.array([0.0, 2.0, 4.0, 30.0]), np.array([1.0, 4.0, 9.0, 16.0])
    expected = np.sqrt([5 / 2, 14 / 3, 13 / 2, 16.0])
    np.testing.assert_allclose(rolling_rms(time_s, squares, 4.0), expected)


def test_the_shape_of_what_is_unknown_by_hand(unknown_result):
    """0.001 cos(heading) along; across nothing, but for 0.012 and 0.006 of intervals by sines."""
    (effect,) = unknown_result.effects
    at = np.linspace(-3, 3, 7)
    shapes = shape_of(effect, at)
    sigma = 0.03 / 2 / 1.96
    np.testing.assert_allclose(shapes["v_x"], [0.001 * np.cos(at), sigma * np.abs(np.cos(at))])
    np.testing.assert_allclose(shapes["v_y"], [0 * at, sigma * np.abs(np.sin(at))], atol=1e-12)
    assert set(shapes) == {"v_x", "v_y"}


@pytest.mark.slow
def test_a_shape_of_every_smooth_function_is_drawn(unknown_result, known, tmp_path):
    candidates = general_candidates(unknown_result.measured_scenes, known.base, GapConfig())
    (tested,) = unknown_result.effects
    knots = tuple(np.linspace(0.0, 160.0, 9))
    terms = tuple((component, k) for component in ("world_x", "left") for k in range(9))
    course = ResidualOfEachRun("time", terms, "", knots, runs=2)
    for number, residual in enumerate((*candidates, History(), course)):
        values = np.linspace(-0.01, 0.02, len(residual.parameters))
        effect = replace(
            tested, added=Added(residual, values), low=values - 0.01, high=values + 0.01
        )
        folder = tmp_path / f"{number}"
        folder.mkdir()
        (picture,) = shape_pictures(replace(unknown_result, effects=(effect,)), folder)
        assert picture.file.stat().st_size > 2000


def test_worst_stretches_are_those_of_the_largest_gap(scaled_result):
    grid = worst_grid(scaled_result)
    (scene,) = scaled_result.measured_scenes
    squares = squared_errors(scaled_result.base, scaled_result.added, scene)
    pieces = (scene.start_s // 10).astype(int)
    by_piece = {int(n): np.sqrt(squares[pieces == n].mean()) for n in np.unique(pieces)}
    worst = max(by_piece, key=by_piece.get)
    assert grid.rows[0][1] == f"{10 * worst} to {10 * worst + 10}"
    assert grid.rows[0][3] == f"{by_piece[worst]:.3g}"
    assert [float(row[3]) for row in grid.rows] == sorted(
        (float(row[3]) for row in grid.rows), reverse=True
    )


def test_where_nothing_was_added_there_is_no_after(none_result, scaled_result):
    assert list(none_result.stages) == ["before"]
    assert list(scaled_result.stages) == ["before", "after"]
    scene = none_result.holdout_scenes[0]
    assert list(rollouts(none_result, scene)) == [MEASURED_NAME, "before"]


def test_events_are_listed_run_by_run(scaled_result):
    (scale, *others) = scaled_result.effects
    bursts = in_course(WheelScale(), InBursts((((1.0, 2.04),), ((4.0, 5.0), (8.5, 9.25)))))
    jumps = ReferenceOutliers(((3.0, 7.0),))
    effects = [
        replace(scale, added=Added(effect, scale.added.values)) for effect in (bursts, jumps)
    ]
    first, second = event_grids(replace(scaled_result, effects=(*effects, *others)))
    assert [row[1] for row in first.rows] == ["1.0 to 2.0", "4.0 to 5.0; 8.5 to 9.2"]
    assert first.rows[0][0] == "meadow <1>"
    assert [row[1] for row in second.rows] == ["3.0; 7.0"]
    assert event_grids(scaled_result) == []
