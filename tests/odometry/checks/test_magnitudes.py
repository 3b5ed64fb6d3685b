"""Speeds without their sign, a map that is too large, one side of another unit."""

import numpy as np
import pytest

from odometry import check_recording
from odometry.checks.findings.unit_tables import Unit, as_likely
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import positions, put, treads


def names(run):
    return [finding.name for finding in check_recording(run).findings]


def spinning(run):
    """Every fifth of the run the robot spins on the spot: one side runs backwards."""
    rows = np.arange(len(run.odometry.stamps_s)) * 20 // len(run.odometry.stamps_s) % 4 == 3
    left, right = run.odometry["v_left"], run.odometry["v_right"]
    return np.where(rows, -0.5, left), np.where(rows, 0.5, right)


def driven(run, width_m=1.8):
    """The run with spins, poses and gyroscope as a robot of this width moves."""
    left, right = spinning(run)
    t = run.odometry.stamps_s
    steps, rate = np.append(np.diff(t), 0.0), (right - left) / width_m
    yaw = np.concatenate([[0.0], np.cumsum(rate * steps)[:-1]])
    way = 0.95 * (left + right) / 2 * steps
    x, y = (np.concatenate([[0.0], np.cumsum(way * of(yaw))[:-1]]) for of in (np.cos, np.sin))
    rng = np.random.default_rng(2)
    at = {
        name: np.interp(run.pose.stamps_s, t, v) + rng.normal(0, 0.01, len(run.pose))
        for name, v in {"x": x, "y": y, "yaw": yaw}.items()
    }
    gyro_z = rate + rng.normal(0, 0.004, len(rate))
    run = put(run, "odometry", v_left=left, v_right=right, gyro_z=gyro_z)
    return put(run, "pose", **at)


def test_magnitudes_are_noticed_where_the_robot_spins():
    run = driven(winding())
    assert "treads_unsigned" not in names(run)
    lost = put(
        run,
        "odometry",
        v_left=np.abs(run.odometry["v_left"]),
        v_right=np.abs(run.odometry["v_right"]),
    )
    assert names(lost)[0] == "treads_unsigned"


def test_no_robot_goes_farther_than_its_treads():
    run = positions(driven(winding()), lambda x, y: (1.25 * x, 1.25 * y))
    assert names(run)[0] in {"scale", "tread_unit"}


@pytest.mark.parametrize("factor", [3.6, 0.4])
def test_one_side_of_another_unit_is_one_cause(factor):
    run = treads(driven(winding()), lambda left, right: (factor * left, right))
    assert [name for name in names(run) if name != "slip_episodes"] == ["treads_unequal"]


def test_positions_rounded_before_noise_are_noticed(rng):
    """The steps are no longer multiples of one step; the residues modulo it still agree."""
    run = winding()
    noise_m = 0.01 * rng.standard_normal((2, len(run.pose)))

    def coarse(x, y):
        return tuple(
            np.round(of / 0.1) * 0.1 + off for of, off in zip((x, y), noise_m, strict=True)
        )

    (found,) = [
        one for one in check_recording(positions(run, coarse)).findings if "steps of" in one.seen
    ]
    assert found.name == "coarse_positions"
    assert "0.1 m" in found.seen


def test_units_of_nearly_one_factor_are_not_distinguished():
    said = as_likely(Unit("feet per minute", 196.85), 0.3, 0.05)
    assert said == ["in degrees per second", "in feet per minute"]
