"""Yaw of few directions, positions on lines, and factors that change with time."""

import numpy as np
import pytest

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Level
from odometry.checks.map_lines import drawn_to_lines
from odometry.checks.recording import check_recording
from tests.odometry.checks.faulty import gyroscope, positions, put, treads, yaw
from tests.odometry.checks.test_columns_of_two_times import varied
from tests.odometry.checks.test_other_robots import winding


def names(run):
    return [finding.name for finding in check_recording(run).at(Level.WARNING)]


@pytest.mark.parametrize("degrees", [22.5, 30, 45])
def test_yaw_in_coarse_steps_is_named(degrees):
    step = np.radians(degrees)
    run = yaw(varied(), lambda angle: np.round(angle / step) * step)
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.name == "coarse_yaw"
    assert f"{degrees:.3g} degrees apart" in found.seen


def test_yaw_of_one_degree_is_not_coarse():
    step = np.radians(1.0)
    assert names(yaw(varied(), lambda angle: np.round(angle / step) * step)) == []


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


def test_a_part_of_the_size_of_the_other_tread_is_no_offset():
    run = winding()
    mixed = treads(run, lambda left, right: (left, right + 0.3 * np.abs(left)))
    assert "tread_offset" not in names(mixed)


def test_a_unit_of_the_gyroscope_that_changes_is_no_unit_of_all():
    run = put(varied(), "pose", yaw=np.full(len(varied().pose), np.nan))
    rows = np.arange(len(run.odometry))
    changed = gyroscope(run, lambda w: np.where(rows > 1500, np.degrees(w), w))
    assert "gyroscope_unit" not in names(changed)


def test_a_scale_to_and_fro_is_no_curve():
    run = varied()
    often = (run.odometry["t"] / 20).astype(int) % 2 == 1
    swings = treads(run, lambda left, right: (np.where(often, left * 0.6, left),
                                              np.where(often, right * 0.6, right)))  # fmt: skip
    assert "treads_not_proportional" not in names(swings)
    assert Evidence(swings).forward_by_mean.explained < Evidence(run).forward_by_mean.explained


def test_a_map_that_grows_is_no_constant_scale():
    run = varied()
    grows = np.linspace(1.1, 1.6, len(run.pose) - 1)
    x, y = (np.append(0.0, np.cumsum(np.diff(run.pose[n]) * grows)) for n in "xy")
    assert "scale" not in names(put(run, "pose", x=x, y=y))
