"""Simulated drives against circles and straight lines, and over edges of terrain."""

from dataclasses import dataclass

import numpy as np
import pytest

from odometry.arrays import FloatArray
from odometry.errors import SimulationError
from odometry.simulation.commands import WeavingDriver
from odometry.simulation.drive import simulate
from odometry.simulation.ground import GroundMap

ICR = np.array([0.45, -0.35, 0.06])
FOOTPRINT = (0.5, 0.4)


@dataclass(frozen=True)
class Constant:
    """Holds its tread speeds."""

    v_left: float
    v_right: float

    def tread_speeds_m_s(self, time_s: float, pose_world: FloatArray) -> FloatArray:  # noqa: ARG002
        return np.array([self.v_left, self.v_right])


def drive(driver, ground=None, icrs=ICR[None], samples=400, start_pose=(0.0, 0.0, 0.0)):
    return simulate(
        driver,
        ground or GroundMap(np.empty(0), ("grass",)),
        icrs,
        footprint_m=FOOTPRINT,
        step_s=0.05,
        disturbances_m=np.zeros((samples, 3)),
        start_pose=start_pose,
    )


def test_constant_speeds_drive_a_circle():
    """The path is a circle about the instantaneous centre, at the closed form's rate."""
    v_left, v_right = 0.3, 0.7
    result = drive(Constant(v_left, v_right))
    rate = (v_right - v_left) / (ICR[0] - ICR[1])
    v_x = (v_right * ICR[0] - v_left * ICR[1]) / (ICR[0] - ICR[1])
    np.testing.assert_allclose(result.poses_world[:, 2], rate * result.stamps_s, atol=1e-9)
    # the start pose is zero, so that the body point (x_icr, v_x / rate) at rest is in the world too
    centre = np.array([ICR[2], v_x / rate])
    radii = np.linalg.norm(result.poses_world[:, :2] - centre, axis=1)
    np.testing.assert_allclose(radii, np.hypot(*centre), atol=1e-8)


def test_equal_speeds_drive_a_straight_line():
    result = drive(Constant(0.6, 0.6), start_pose=(1.0, 2.0, 0.4))
    distance = 0.6 * result.stamps_s
    expected = np.column_stack(
        [1 + distance * np.cos(0.4), 2 + distance * np.sin(0.4), np.full_like(distance, 0.4)]
    )
    np.testing.assert_allclose(result.poses_world, expected, atol=1e-12)


def test_standing_robot_stays():
    result = drive(Constant(0.0, 0.0), start_pose=(1.0, 2.0, 3.0))
    assert (result.poses_world == [1.0, 2.0, 3.0]).all()


def test_mirrored_drive_has_the_mirrored_path():
    one = drive(Constant(0.3, 0.6))
    other = drive(Constant(0.6, 0.3), icrs=np.array([[-ICR[1], -ICR[0], ICR[2]]]))
    np.testing.assert_allclose(other.poses_world, one.poses_world * [1, -1, -1], atol=1e-10)


def test_icrs_change_over_the_length_of_the_robot():
    """Across a straight edge the blend runs from the front's crossing to the rear's."""
    ground = GroundMap(np.array([2.0]), ("gravel", "grass"))
    icrs = np.array([[0.3, -0.25, -0.08], [0.45, -0.5, 0.05]])
    result = drive(Constant(0.5, 0.5), ground, icrs)
    x = result.poses_world[:, 0]
    share = (result.icrs_m[:, 0] - 0.3) / 0.15
    np.testing.assert_allclose(share, np.clip((x - 1.75) / 0.5, 0, 1), atol=0.5 / 15 + 1e-9)
    for column in (1, 2):
        low, high = icrs[:, column]
        np.testing.assert_allclose(result.icrs_m[:, column], low + share * (high - low), atol=1e-9)
    names = np.array(result.terrains)
    assert (names[x < 2.0] == "gravel").all()
    assert (names[x > 2.0] == "grass").all()


def test_disturbances_are_in_the_motion_and_in_the_record():
    shift = np.tile([0.05, -0.05, 0.01], (100, 1))
    result = simulate(
        Constant(0.2, 0.6),
        GroundMap(np.empty(0), ("grass",)),
        ICR[None],
        footprint_m=FOOTPRINT,
        step_s=0.05,
        disturbances_m=shift,
    )
    same = drive(Constant(0.2, 0.6), icrs=ICR[None] + shift[0], samples=100)
    np.testing.assert_allclose(result.icrs_m, same.icrs_m)
    np.testing.assert_allclose(result.poses_world, same.poses_world)


def test_drive_ends_at_the_line():
    result = simulate(
        Constant(0.5, 0.5),
        GroundMap(np.empty(0), ("grass",)),
        ICR[None],
        footprint_m=FOOTPRINT,
        step_s=0.05,
        disturbances_m=np.zeros((1000, 3)),
        end_x_m=3.0,
    )
    x = result.poses_world[:, 0]
    assert (x[:-1] <= 3.0).all()
    assert x[-1] > 3.0


@pytest.mark.parametrize("phases", [(0.0, 0.0, 0.0), (2.0, 4.0, 1.0)])
def test_weaving_driver_turns_both_ways_and_keeps_to_the_way(phases):
    result = drive(WeavingDriver(phases_rad=phases), samples=1000)
    x, y, _ = result.poses_world.T
    turn_rate = result.twists_body[:, 2]
    assert x[-1] > 25.0
    assert np.abs(y).max() < 2.0
    assert turn_rate.max() > 0.3
    assert turn_rate.min() < -0.3
    assert np.ptp(result.tread_speeds_m_s[100:].mean(axis=1)) > 0.1


def test_impossible_icrs_are_refused():
    with pytest.raises(SimulationError, match="above y_right"):
        drive(Constant(0, 0), icrs=np.array([[-0.1, 0.1, 0.0]]))
    with pytest.raises(SimulationError, match=r"1 strips need ICRs"):
        drive(Constant(0, 0), icrs=np.zeros((2, 3)))
