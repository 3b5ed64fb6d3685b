"""What is left once a cause is undone, and what no recording of a robot shows."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.checks.treads.sides import sides
from odometry.checks.treads.tread_samples import peaks_often
from odometry.checks.turns.constancy import uneven_map, uneven_yaw
from odometry.checks.unexplained.disagreement import lasting_disagreements
from odometry.checks.unexplained.little_explained import little_explained
from odometry.checks.unexplained.repeated_rows import repeated_rows
from tests.odometry.checks.answers import UNKNOWN, seen, warnings
from tests.odometry.checks.drives import to_and_fro, turning_all_round
from tests.odometry.checks.faulty import gyroscope, positions, put, treads


@pytest.fixture(scope="module")
def fro():
    return to_and_fro()


@pytest.fixture(scope="module")
def round_about():
    return turning_all_round()


def left_of(run):
    return " ".join(little_explained(Evidence(run)))


def without_poses(run):
    return replace(run, pose=None)


def shuffled(values, rows=40):
    parts = np.array_split(np.arange(len(values)), len(values) // rows)
    return np.concatenate([values[np.random.default_rng(4).permutation(part)] for part in parts])


def test_what_was_recorded_explains_itself(fro, round_about):
    for run in (fro, round_about):
        evidence = Evidence(run)
        said = (uneven_yaw(evidence), uneven_map(evidence), repeated_rows(evidence))
        assert not any(said)
        assert not peaks_often(evidence)
        assert not left_of(run)


def test_a_gyroscope_that_is_weak_to_one_side_has_no_bias(round_about):
    run = gyroscope(round_about, lambda rate: np.where(rate > 0, 0.75 * rate, rate))
    assert warnings(run) == UNKNOWN
    assert "in left turns" in seen(run)


def test_a_gyroscope_that_reads_too_little_in_slow_turns_is_said(fro):
    run = gyroscope(fro, lambda rate: rate - np.clip(rate, -0.15, 0.15))
    assert "in slow turns" in uneven_yaw(Evidence(run))


def test_a_map_that_shrinks_towards_its_border_is_said(round_about):
    def lens(x, y):
        x, y = x - x.mean(), y - y.mean()
        shrunk = 1 - 0.35 * (x**2 + y**2) / np.max(x**2 + y**2)
        return x * shrunk, y * shrunk

    run = positions(round_about, lens)
    assert "at its border" in uneven_map(Evidence(run))
    assert "at its border" in seen(run)


def test_poses_of_mixed_rows_are_explained_by_nothing(round_about):
    columns = {name: shuffled(round_about.pose[name]) for name in ("x", "y", "yaw")}
    words = left_of(put(round_about, "pose", **columns))
    assert "the treads explain" in words
    assert "the gyroscope explains" in words


def test_the_way_is_compared_where_turns_agree(round_about):
    """A scale that wanders from moment to moment, of both treads."""
    times = np.repeat(np.random.default_rng(2).choice([0.2, 1.0, 3.0], 200), 20)
    run = treads(round_about, lambda left, right: (times * left, times * right))
    assert "of the measured way" in left_of(run)


def test_turns_against_the_treads_are_said(fro):
    rows = np.arange(4000) % 1000 < 250
    run = treads(fro, lambda *of: tuple(np.where(rows, v, w) for v, w in (of, of[::-1])))
    assert "of the sharp turns are against" in left_of(run)


def test_a_gyroscope_that_turns_nowhere_is_said_without_poses(fro):
    noise = 0.005 * np.random.default_rng(1).standard_normal(4000)
    run = gyroscope(without_poses(fro), lambda _: noise)
    assert "of a robot without slip" in left_of(run)
    assert warnings(run) != []
    assert not left_of(without_poses(fro))


def test_rows_that_were_written_again_are_said(fro):
    def again(speed):
        return np.concatenate([speed[:2000], speed[1700:1900], speed[2200:]])

    run = treads(fro, lambda left, right: (again(left), again(right)))
    assert "200 rows of odometry.csv repeat" in " ".join(lasting_disagreements(Evidence(run)))
    same = put(run, "odometry", gyro_z=again(run.odometry["gyro_z"]))
    assert not repeated_rows(Evidence(without_poses(same)))


def test_single_samples_that_often_go_out_and_back_are_said(fro):
    rows = np.random.default_rng(0).random((2, 4000)) < 0.02
    wild = np.random.default_rng(3).uniform(-2.0, 2.0, (2, 4000))
    run = treads(
        fro, lambda *of: tuple(np.where(r, w, v) for r, w, v in zip(rows, wild, of, strict=True))
    )
    assert "single samples" in peaks_often(Evidence(run))
    assert warnings(run) == UNKNOWN


def test_an_offset_explains_what_the_treads_do_not(round_about):
    weak = treads(round_about, lambda left, right: (left, np.where(left > 0.9, 0.7, 1) * right))
    assert "tread_offset" not in [finding.name for finding in sides(Evidence(weak))]


def test_whole_numbers_may_be_ticks(fro):
    run = replace(fro, robot=replace(fro.robot, wheel_radius=None))
    ticks = treads(run, lambda *of: tuple(np.round(97.0 * v) for v in of))
    (found,) = check_recording(ticks).at(Level.WARNING)
    assert "cm/s" in found.cause
    assert "encoder ticks" in found.cause
    assert Evidence(found.mend(ticks)).metres_per_metre == pytest.approx(0.93, abs=0.01)
    speeds = treads(run, lambda *of: tuple(100.0 * v for v in of))
    assert "ticks" not in check_recording(speeds).at(Level.WARNING)[0].cause


def test_a_gap_after_stamps_that_are_too_close_may_be_none(round_about):
    t = round_about.odometry["t"]
    early = put(round_about, "odometry", t=np.where((t > 60) & (t < 80), 60 + 0.7 * (t - 60), t))
    (found,) = (f for f in check_recording(early).findings if f.name == "odometry_gap")
    assert found.cause.startswith("Either the stamps are wrong")


def test_rows_that_were_lost_and_numbered_are_as_clocks_apart(round_about):
    rows = np.flatnonzero(np.random.default_rng(0).random(4000) > 0.03)
    table = round_about.odometry.rows(rows)
    even = 0.05 * np.arange(len(rows))
    run = replace(round_about, odometry=replace(table, columns={**table.columns, "t": even}))
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "clocks_apart"
    assert "made up at an even pace" in found.cause
