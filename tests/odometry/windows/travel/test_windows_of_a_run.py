"""Windows of a run that is made here: what they measure, and what they say where there are none."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.errors import WindowError
from odometry.windows.config import WindowConfig
from odometry.windows.travel.windows import windows_of
from tests.odometry.windows.travel.test_windows import travel_between


def test_measured_is_the_end_in_the_frame_of_the_start(winding, synthetic):
    windows = windows_of([winding], WindowConfig())
    poses = winding.pose.stack("x", "y", "yaw")
    for k, (i, j) in enumerate(zip(windows.first_pose, windows.last_pose, strict=True)):
        expected = synthetic.between(poses[i], poses[j])
        steps = [synthetic.between(poses[n], poses[n + 1])[2] for n in range(i, j)]
        expected = [*expected[:2], sum(steps)]  # the turn of all steps, more than half a turn too
        np.testing.assert_allclose(windows.measured[k], expected, rtol=0, atol=1e-12)
    assert np.abs(windows.measured[:, 2]).max() > np.pi


def test_distinct_segments_share_their_ends_and_half_a_stride_overlaps(winding):
    """Baril 2020: segments of h_t, end to end (a window may be one pose longer)."""
    apart, overlapping = (
        windows_of([winding], WindowConfig(stride=stride)) for stride in (1.0, 0.5)
    )
    assert np.all(apart.first_pose[1:] >= apart.last_pose[:-1] - 1)
    assert 2 * len(apart) - 2 <= len(overlapping) <= 2 * len(apart) + 1
    assert np.all(overlapping.first_pose[1:] < overlapping.last_pose[:-1])


def test_accelerations_are_used_only_where_every_run_has_them(winding):
    columns = dict(winding.odometry.columns)
    columns |= {
        name: np.arange(len(winding.odometry), dtype=float) for name in ("accel_x", "accel_y")
    }
    measured = replace(winding, odometry=replace(winding.odometry, columns=columns))
    config = WindowConfig()
    assert windows_of([measured, winding], config).inputs.accelerations_m_s2 is None
    told = windows_of([measured, measured], config).inputs.accelerations_m_s2
    once = windows_of([measured], config).inputs.accelerations_m_s2
    np.testing.assert_array_equal(told, np.concatenate([once, once]))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"horizon_m": 500.0, "shortest": 1.0}, "500 m"),
        ({"horizon_s": 900.0, "shortest": 1.0}, "900 s"),
    ],
)
def test_no_window_tells_what_was_wanted_and_what_there_is(winding, settings, words):
    longest = travel_between(winding, 0, np.inf)
    with pytest.raises(WindowError, match=f"no window of {words} in winding") as caught:
        windows_of([winding], WindowConfig(**settings))
    assert f"{longest:.2f} m" in str(caught.value)


def test_a_run_without_poses_is_named(winding):
    blind = replace(winding, folder=Path("blind"), pose=None)
    with pytest.raises(WindowError, match=r"blind: 0 measured poses .*pose\.csv"):
        windows_of([winding, blind], WindowConfig())


def test_travel_that_no_pose_measures_is_told_apart(winding):
    """Poses of the first second alone: a shorter horizon finds windows in what these measure."""
    early = winding.pose.stamps_s < winding.pose.stamps_s[0] + 1.0
    pose = {name: of[early] for name, of in winding.pose.columns.items()}
    short = replace(winding, pose=replace(winding.pose, columns=pose))
    between = travel_between(winding, *short.pose.stamps_s[[0, -1]])
    with pytest.raises(WindowError, match="choose a shorter horizon") as caught:
        windows_of([short], WindowConfig(horizon_m=20.0))
    assert f"m of wheel travel, {between:.2f} m between poses; " in str(caught.value)


@pytest.mark.parametrize(("held", "words"), [("treads", "record a drive"), ("poses", "stuck")])
def test_no_horizon_helps_a_robot_that_stays(winding, held, words):
    table = winding.odometry if held == "treads" else winding.pose
    names = ("v_left", "v_right") if held == "treads" else ("x", "y", "yaw")
    columns = {**table.columns, **{name: np.zeros(len(table)) for name in names}}
    still = replace(table, columns=columns)
    run = replace(winding, **{"odometry" if held == "treads" else "pose": still})
    with pytest.raises(WindowError, match=words) as caught:
        windows_of([run], WindowConfig())
    assert "choose a shorter horizon" not in str(caught.value)
