"""The bias of a gyroscope from positions alone, and the shape of a path, piece by piece."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.windows.config import WindowConfig
from odometry.windows.recorded.gyroscope_yaw import PathShape, yaw_rates_of
from odometry.windows.recorded.record import position_record_of
from tests.odometry.positions_drives import drive, emptied

LENGTH_M = 5.0


@pytest.mark.parametrize(("seed", "noise_m"), [(0, 0.02), (1, 0.3), (2, 1.0)])
def test_the_bias_is_found_through_noise_of_the_positions(seed, noise_m):
    """Pieces of 10 m leave 0.003 rad/s under 0.3 m of noise, and 0.01 under 1 m."""
    run = drive(seed, noise_m=noise_m, gyroscope=True, bias_rad_s=0.02, duration_s=300.0)
    record = position_record_of(emptied(run), WindowConfig())
    rates = yaw_rates_of(record)
    yaw_rad = np.append(0.0, np.cumsum(rates[:-1] * np.diff(record.stamps_s)))
    turned = np.diff(yaw_rad[record.pose_samples[[0, -1]]])[0]
    driven = run.pose["yaw"][-1] - run.pose["yaw"][0]
    lasted_s = record.pose_s[-1] - record.pose_s[0]
    assert (turned - driven) / lasted_s == pytest.approx(0.0, abs=6e-4)


def test_a_run_without_gyroscope_has_no_yaw_rates():
    assert yaw_rates_of(position_record_of(emptied(drive(1)), WindowConfig())) is None


def test_distances_of_pieces_are_those_of_least_squares():
    """Each piece by itself: ahead, aside by the turn, and a place, by NumPy's least squares."""
    record = position_record_of(emptied(drive(2, noise_m=0.1)), WindowConfig())
    breaks = record.breaks.copy()
    breaks[len(breaks) // 3] = "gap"
    record = replace(record, breaks=breaks)
    speeds_m_s = record.inputs.tread_speeds_m_s.mean(axis=1)
    rates_rad_s = 0.3 * np.sin(0.2 * record.stamps_s)
    shape = PathShape(record, (LENGTH_M,))
    ((sums_m, counts),) = shape.of_pieces(speeds_m_s, shape.turned(rates_rad_s))

    ahead, turning = _stepped(record.stamps_s, speeds_m_s, rates_rad_s)[:, record.pose_samples]
    travel_m = record.travel_m[record.pose_samples]
    numbers = np.floor(travel_m / LENGTH_M) + 1e6 * record.stretch
    for place, number in enumerate(np.unique(numbers)):
        inside = numbers == number
        columns = np.column_stack([ahead, turning, np.ones_like(ahead)])[inside]
        measured = record.poses[inside, :2] @ [1.0, 1j]
        fitted = columns @ np.linalg.lstsq(columns, measured, rcond=None)[0]
        assert counts[place] == inside.sum()
        assert sums_m[place] == pytest.approx(np.abs(measured - fitted).sum(), abs=1e-8)


def _stepped(stamps_s, speeds_m_s, rates_rad_s):
    """Paths (2, N) in the complex plane, of the speeds and of the turn alone, step by step."""
    paths, yaw_rad = np.zeros((2, len(stamps_s)), dtype=complex), 0.0
    for step, lasts_s in enumerate(np.diff(stamps_s)):
        turn_rad = rates_rad_s[step] * lasts_s
        arc = (np.exp(1j * turn_rad) - 1) / (1j * turn_rad) if turn_rad else 1.0
        moved = np.array([speeds_m_s[step], rates_rad_s[step]]) * lasts_s
        paths[:, step + 1] = paths[:, step] + moved * arc * np.exp(1j * yaw_rad)
        yaw_rad += turn_rad
    return paths
