"""Yaw of few directions, positions on lines, and factors that change with time."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.poses.map_lines import drawn_to_lines
from odometry.checks.recording import check_recording
from odometry.checks.turns.constancy import uneven_way
from tests.odometry.checks.drives import drive, turning_all_round, varied, winding
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, without_gyroscope, yaw


def names(run):
    return [finding.name for finding in check_recording(run).at(Level.WARNING)]


@pytest.mark.parametrize("degrees", [22.5, 30, 45])
def test_yaw_in_coarse_steps_is_named(degrees):
    step = np.radians(degrees)
    run = yaw(varied(), lambda angle: np.round(angle / step) * step)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "coarse_yaw"
    assert f"{degrees:.3g} degrees apart" in found.seen


@pytest.mark.parametrize("as_logged", [np.asarray, np.unwrap])
def test_a_step_that_is_no_part_of_a_turn_is_named(as_logged):
    """As a yaw that goes on beyond half a turn: many directions, each of them in few rows."""
    run = yaw(turning_all_round(), lambda angle: np.round(as_logged(angle) / 0.1) * 0.1)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "coarse_yaw"
    assert "5.73 degrees apart" in found.seen


@pytest.mark.parametrize("degrees", [1, 3])
def test_yaw_of_a_few_degrees_is_not_coarse(degrees):
    step = np.radians(degrees)
    assert "coarse_yaw" not in names(yaw(varied(), lambda angle: np.round(angle / step) * step))


def drawn(x, y, apart_m=3.0):
    at_x, at_y = (np.round(of / apart_m) * apart_m for of in (x, y))
    nearer = np.abs(x - at_x) < np.abs(y - at_y)
    return np.where(nearer, at_x, x), np.where(nearer, y, at_y)


def test_positions_on_lines_of_a_map_are_no_jumps():
    assert names(positions(varied(), drawn)) == ["positions_on_lines"]


def test_rounded_positions_are_on_no_lines(rng):
    x, y = rng.normal(0, 20, (2, 2000)).cumsum(axis=1) / 20
    assert drawn_to_lines(np.stack(drawn(x, y), axis=-1))
    assert not drawn_to_lines(np.round(np.stack([x, y], axis=-1), 0))
    assert not drawn_to_lines(np.stack([x, y], axis=-1))
    assert not drawn_to_lines(rng.integers(0, 150, (2000, 2)).astype(float))


def test_a_part_of_the_size_of_the_other_tread_is_no_offset():
    at_s = 0.05 * np.arange(4000)
    run = drive(0.1 + 0.4 * np.sin(at_s / 7), np.sin(at_s / 3) + 0.2)
    mixed = treads(run, lambda left, right: (left, right + 0.3 * np.abs(left)))
    assert "tread_offset" not in names(mixed)


def test_a_unit_of_the_gyroscope_that_changes_is_no_unit_of_all():
    run = put(varied(), "pose", yaw=np.full(len(varied().pose), np.nan))
    rows = np.arange(len(run.odometry))
    changed = gyroscope(run, lambda w: np.where(rows > 1500, np.degrees(w), w))
    assert "gyroscope_unit" not in names(changed)


def test_a_scale_to_and_fro_is_no_curve():
    at_s = 0.05 * np.arange(4000)
    run = drive(0.8 + 0.25 * np.sin(at_s / 4), 0.4 * np.sign(np.sin(at_s / 5)))
    half = np.where((at_s / 20).astype(int) % 2 == 1, 0.5, 1.0)
    swings = treads(without_gyroscope(run), lambda left, right: (left * half, right * half))
    assert "treads_not_proportional" not in names(swings)


@pytest.mark.parametrize(("last", "words"), [(1.45, "at first and by"), (1.05, "")])
def test_a_map_that_grows_has_no_constant_scale(last, words):
    run = winding(4000)
    grows = np.linspace(1.05, last, len(run.pose) - 1)
    x, y = (np.append(0.0, np.cumsum(np.diff(run.pose[n]) * grows)) for n in "xy")
    found = uneven_way(Evidence(put(run, "pose", x=x, y=y)), 1.2)
    assert words in found
    assert bool(found) == bool(words)
