"""Yaw that is turned a little against the positions, and positions that are stretched a little."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.poses.position_frame import position_frame
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import drive, turning_all_round, uneven
from tests.odometry.checks.faulty import positions, put, yaw
from tests.odometry.checks.poses.test_far_sensor import measured_at, without_yaw


def warnings(run):
    return check_recording(run).at(Level.WARNING)


@pytest.mark.parametrize("offset_rad", [0.08, -0.1, 0.2])
def test_a_yaw_that_is_turned_a_little_is_named_and_turned_back(offset_rad):
    run = turning_all_round()
    turned = yaw(run, lambda angle: angle + offset_rad)
    (found,) = warnings(turned)
    assert found.name == "yaw_offset"
    assert "sensor is turned a little" in found.cause
    off = np.angle(np.exp(1j * (found.mend(turned).pose["yaw"] - run.pose["yaw"])))
    np.testing.assert_allclose(off, 0.0, atol=0.01)


@pytest.mark.parametrize("change", [lambda x, y: (1.1 * x, y), lambda x, y: (x, 0.92 * y)])
@pytest.mark.parametrize("read", [lambda run: run, without_yaw])
def test_a_map_that_is_stretched_a_little_is_named_with_its_axis(change, read):
    run = read(turning_all_round())
    stretched = positions(run, change)
    (found,) = warnings(stretched)
    assert found.name == "positions_stretched"
    sizes = np.ptp(stretched.pose.stack("x", "y"), axis=0), np.ptp(run.pose.stack("x", "y"), axis=0)
    mended = np.ptp(found.mend(stretched).pose.stack("x", "y"), axis=0) / sizes[1]
    assert mended[0] / mended[1] == pytest.approx(1.0, abs=0.02)


def sliding_downhill(run, share):
    """Each metre of way moves the robot along -y as well, wherever it points."""
    way_m = np.append(0.0, np.cumsum(np.hypot(np.diff(run.pose["x"]), np.diff(run.pose["y"]))))
    return positions(run, lambda x, y: (x, y - share * way_m))


def late(run, delay_s):
    t = run.pose.stamps_s
    return positions(run, lambda x, y: tuple(np.interp(t - delay_s, t, of) for of in (x, y)))


RIGHT = {
    "as it is": lambda run: run,
    "a yaw that is mounted by eye": lambda run: yaw(run, lambda angle: angle + 0.03),
    "a map of nearly one scale": lambda run: positions(run, lambda x, y: (1.03 * x, y)),
    "an antenna ahead and aside": lambda run: measured_at(run, 0.35, -0.3),
    "a slope": lambda run: sliding_downhill(run, 0.15),
    "positions that are late": lambda run: late(run, 0.2),
}


@pytest.mark.parametrize("change", RIGHT.values(), ids=RIGHT)
@pytest.mark.parametrize("made", [turning_all_round, uneven])
def test_what_moves_a_robot_aside_is_no_turned_frame(made, change):
    assert not {"yaw_offset", "positions_stretched"} & {of.name for of in warnings(change(made()))}


def test_one_heading_does_not_tell_a_turned_yaw_from_a_slope():
    at_s = 0.05 * np.arange(3000)
    straight = drive(0.8 + 0.3 * np.sin(at_s / 5), 0.05 * np.sin(at_s / 3))
    turned = yaw(straight, lambda angle: angle + 0.1)
    frame = position_frame(Evidence(turned))
    assert frame is None or abs(frame.turned_rad) < 4 * frame.turned_sd_rad
    empty = put(turned, "pose", x=np.full(len(turned.pose), np.nan))
    assert position_frame(Evidence(empty)) is None
