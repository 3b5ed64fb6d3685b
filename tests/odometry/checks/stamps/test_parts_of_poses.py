"""Positions or yaw that are late alone, and what only looks like it."""

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import driven, turning_all_round
from tests.odometry.checks.faulty import late, put, treads, without_gyroscope, yaw


def ahead(run, metres):
    angle = run.pose["yaw"]
    x, y = (run.pose[n] + metres * f(angle) for n, f in (("x", np.cos), ("y", np.sin)))
    return put(run, "pose", x=x, y=y)


def warned(run):
    return check_recording(run).at(Level.WARNING)


@pytest.mark.parametrize(
    ("names", "named", "seconds"),
    [
        *((("yaw",), "yaw_late", 0.7), (("x", "y"), "positions_late", -0.4)),
        (("x", "y"), "positions_late", 0.7),
    ],
)
def test_the_part_of_a_pose_that_is_late_is_named_with_its_delay(names, named, seconds):
    (found,) = warned(late(driven(), names, seconds))
    assert found.name == named
    assert f"{'late' if seconds > 0 else 'early'} and its" in found.cause
    assert float(found.remedy.split("subtract ")[1].split()[0]) == pytest.approx(seconds, abs=0.1)


def test_positions_of_an_antenna_ahead_are_late_as_well():
    (found,) = warned(late(ahead(driven(), 0.2), ("x", "y"), 0.7))
    assert found.name == "positions_late"


@pytest.mark.parametrize("run", [driven(), ahead(driven(1), 0.4), turning_all_round()])
def test_poses_of_one_time_are_not_parted(run):
    assert not {"yaw_late", "positions_late"} & {found.name for found in warned(run)}


@pytest.mark.parametrize(("of", "seconds"), [("along", 0.5), ("turning", -0.5)])
def test_treads_of_two_times_are_no_late_part(of, seconds):
    """As a robot that follows its treads late in one of both: positions go where yaw points."""
    run = driven()

    def moved(values):
        return np.interp(run.odometry["t"] - seconds, run.odometry["t"], values)

    def change(left, right):
        along, turning = (left + right) / 2, (right - left) / 2
        along, turning = (moved(along), turning) if of == "along" else (along, moved(turning))
        return along - turning, along + turning

    names = {found.name for found in warned(treads(run, change))}
    assert names
    assert not {"yaw_late", "positions_late"} & names


@pytest.mark.parametrize("names", [("yaw",), ("x", "y")])
def test_without_a_gyroscope_nothing_decides(names):
    named = [found.name for found in warned(without_gyroscope(late(driven(), names, 0.5)))]
    assert named
    assert not {"yaw_late", "positions_late"} & set(named)


def test_a_delay_of_yaw_in_degrees_is_not_named_before_its_unit():
    (found,) = warned(yaw(late(driven(), ("yaw",), 0.5), np.degrees))
    assert found.name != "yaw_late"
    assert "fit only when read as degrees" in found.seen
