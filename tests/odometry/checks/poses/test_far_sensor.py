"""Antennas off the centre: where they are stated rightly, wrongly, and not at all."""

import re
from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import turning_all_round, uneven
from tests.odometry.checks.faulty import positions, put, treads

PLACES_M = [(0.5, 0.0), (-0.45, 0.15), (0.0, 0.7)]


def measured_at(run, ahead_m, left_m):
    yaw = np.unwrap(run.pose["yaw"])
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return positions(
        run,
        lambda x, y: (
            x + ahead_m * cosine - left_m * sine,
            y + ahead_m * sine + left_m * cosine,
        ),
    )


def stated(run, ahead_m, left_m):
    return replace(run, settings={"sensors": {"pose": [ahead_m, left_m, 0.4]}})


def without_yaw(run):
    return put(run, "pose", yaw=np.full(len(run.pose), np.nan))


def warned_of(run):
    return check_recording(run).at(Level.WARNING)


def place_of(finding):
    found = re.search(r"pose = \[([-.0-9]+), ([-.0-9]+), ([-.0-9]+)\]", finding.remedy)
    return tuple(map(float, found.groups()))


@pytest.fixture(scope="module", params=["yaw", "positions alone"])
def of(request):
    """What is measured beside treads and gyroscope."""
    return without_yaw if request.param == "positions alone" else lambda run: run


@pytest.mark.parametrize("place_m", PLACES_M)
def test_an_antenna_whose_place_is_stated_is_no_fault(of, place_m):
    run = stated(of(measured_at(uneven(), *place_m)), *place_m)
    assert not warned_of(run)


@pytest.mark.parametrize("place_m", PLACES_M)
def test_a_place_with_its_signs_turned_round_is_named_and_mended(of, place_m):
    run = stated(of(measured_at(uneven(), *place_m)), -place_m[0], -place_m[1])
    (found,) = warned_of(run)
    assert found.name == "far_sensor"
    assert "with its signs turned round" in found.cause
    assert place_of(found) == pytest.approx((*place_m, 0.4), abs=0.06)


def test_a_wrong_place_of_other_signs_is_named_without_them(of):
    (found,) = warned_of(stated(of(measured_at(uneven(), 0.0, 0.0)), 0.9, 0.0))
    assert found.name == "far_sensor"
    assert "signs" not in found.cause
    assert "moved from [sensors] pose = [0.9, 0.0, 0.4] to the centre" in found.line
    assert place_of(found) == pytest.approx((0.0, 0.0, 0.4), abs=0.06)


def test_a_place_that_is_not_stated_is_found_from_positions_alone():
    (found,) = warned_of(without_yaw(measured_at(uneven(), 1.1, -0.3)))
    assert found.name == "far_sensor"
    assert place_of(found) == pytest.approx((1.1, -0.3, 0.0), abs=0.08)


def test_an_antenna_ahead_of_a_robot_that_mostly_turns_left_is_placed_rightly():
    """Its course lies beside its yaw all the time, which is no other axis of the robot."""
    (found,) = warned_of(measured_at(turning_all_round(), 1.2, 0.0))
    assert found.name == "far_sensor"
    assert place_of(found) == pytest.approx((1.2, 0.0, 0.0), abs=0.08)


@pytest.mark.parametrize("fault", ["yaw_backwards", "yaw_off_by_90", "treads_both_reversed"])
def test_beside_another_fault_a_place_that_is_stated_rightly_is_none(fault):
    """What is stated is undone by the heading of the robot, not by a yaw that points elsewhere."""
    run = measured_at(uneven(), 0.6, -0.2)
    made = {
        "yaw_backwards": lambda: put(run, "pose", yaw=run.pose["yaw"] + np.pi),
        "yaw_off_by_90": lambda: put(run, "pose", yaw=run.pose["yaw"] + np.pi / 2),
        "treads_both_reversed": lambda: treads(run, lambda left, right: (-left, -right)),
    }[fault]()
    assert [found.name for found in warned_of(stated(made, 0.6, -0.2))] == [fault]
