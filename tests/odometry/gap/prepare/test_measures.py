"""A gap that headings or the gyroscope show, and positions do not."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.gap import find_gap
from odometry.gap.prepare.measures import measures_of
from odometry.gap.prepare.statistic import Measure
from odometry.gap.show.files import content_of
from odometry.gap.show.lead import lead
from odometry.report.gap.gap_tables import closing_grid

ROUGH_M = 0.06  # of a measured position


@pytest.fixture(scope="module")
def rough(make_scene):
    """A run whose positions are noisy and whose headings are not, with a gyroscope."""

    def make(seed, *, turns=1.0, gyroscope=1.0):
        driven = {}

        def planted(_, twist):
            driven["twist"] = twist * np.array([1.0, 1.0, turns])
            return driven["twist"]

        run = make_scene(seed, planted, duration_s=100.0, name=f"run_{seed}").run
        rng = np.random.default_rng(seed)
        noisy = {name: run.pose[name] + rng.normal(0, ROUGH_M, len(run.pose)) for name in "xy"}
        gyro_z = gyroscope * driven["twist"][:, 2] + rng.normal(0, 0.003, len(run.odometry))
        return replace(
            run,
            pose=replace(run.pose, columns={**run.pose.columns, **noisy}),
            odometry=replace(run.odometry, columns={**run.odometry.columns, "gyro_z": gyro_z}),
        )

    return make


def found_of(rough, **changed):
    calibration = [rough(11), rough(12)]
    return find_gap([rough(13, **changed)], calibration, [rough(14, **changed)])


@pytest.fixture(scope="module")
def less_turn(rough):
    return found_of(rough, turns=0.85)


@pytest.mark.slow
def test_a_robot_that_turns_less_is_no_model_as_it_is(less_turn):
    assert less_turn.verdict == "terrain"
    fitted, held_out = less_turn.turns
    assert held_out.before.measure is fitted.before.measure is Measure.HEADING
    assert held_out.share_closed > 0.9
    assert less_turn.holdout.after.value <= less_turn.holdout.before.value


def test_without_a_measured_yaw_positions_decide(less_turn):
    scenes = less_turn.measured_scenes, less_turn.holdout_scenes
    of = partial(measures_of, less_turn.calibration, *scenes, GapConfig())
    assert of(has_yaw=True) == (Measure.HEADING,)
    found = of(has_yaw=False)
    assert found[-1] is Measure.POSITION


def test_the_page_has_rows_of_both(less_turn):
    rows = closing_grid(less_turn, None).rows
    assert [row[0] for row in rows] == [
        "held out",
        "measured, fitted",
        "held out, heading error",
        "measured, heading error",
    ]


def test_the_words_and_the_file_say_by_what(less_turn):
    _, how_sure, _ = lead(less_turn)
    assert how_sure.startswith("Positions hardly show it within")
    assert "The heading error on held-out data falls from" in how_sure
    assert " rad " in how_sure
    turns = content_of(less_turn)["turns"]
    assert turns["holdout"]["unit"].startswith("rad, RMS heading error")
    assert turns["holdout"]["share_closed"] > 0.9


@pytest.mark.slow
def test_a_gyroscope_at_fault_moves_no_position(rough):
    found = found_of(rough, gyroscope=1.15)
    assert found.verdict == "gyroscope_error"
    assert found.turns[1].before.measure is Measure.GYROSCOPE
    assert found.effects[0].added.values[0] == pytest.approx(1.15, abs=0.01)


def test_without_a_change_nothing_is_missing(rough):
    found = found_of(rough)
    assert found.verdict == "none"
    assert found.turns is None
    assert content_of(found)["turns"] is None


@pytest.mark.slow
def test_a_gyroscope_at_fault_as_measured_is_not_none(rough):
    """It was not on the runs held out: nothing is named, and nothing is "none"."""
    found = find_gap([rough(13, gyroscope=1.15)], [rough(11), rough(12)], [rough(14)])
    assert found.verdict == "unknown"
    assert found.turns[0].before.measure is Measure.GYROSCOPE
    missing, how_sure, to_do = lead(found)
    assert "on the measured runs (unknown), and held-out data do not show it" in missing
    assert "on the measured runs 0." in how_sure
    assert to_do.startswith("Hold out whole runs")
