"""What a model predicts that the sensor measures, beside dead reckoning and closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.evaluation.open_loop import open_loop
from odometry.gap.prepare.simulate import reported_of, residuals, simulated_poses
from odometry.geometry import se2
from odometry.windows.dense.dense import dense_windows_of
from odometry.windows.recorded.measured_poses import YAW_FOUND
from odometry.windows.recorded.run_inputs import inputs_of

ARM = np.array([0.4, -0.3])
WIDTH_M = 0.87  # between the ICRs of the true robot


def with_columns(run, **columns):
    odometry = {**run.odometry.columns, **columns}
    return replace(run, odometry=replace(run.odometry, columns=odometry))


@pytest.fixture
def turning(make_scene):
    """A scene of a robot that always drives with these tread speeds."""

    def make(left, right, **columns):
        run = make_scene(3, duration_s=40.0).run
        ones = np.ones(len(run.odometry))
        filled = {name: value * ones for name, value in columns.items()}
        return dense_windows_of(
            with_columns(run, v_left=left * ones, v_right=right * ones, **filled),
            2.0,
        )

    return make


def relative(poses):
    return se2.between(poses[:1], poses)


@pytest.mark.parametrize("tilted", [False, True])
def test_it_is_dead_reckoning(make_scene, known, tilted):
    scene = make_scene(5, (lambda _, twist: twist) if tilted else None, duration_s=60.0)
    assert bool(np.any(scene.inputs.roll_rad)) == tilted
    twists = known.base.model.twist(known.base.values, inputs_of(scene.run))
    reckoned = open_loop(scene.run, twists)
    expected = reckoned.plane.poses
    at = np.searchsorted(reckoned.stamps_s, scene.run.pose.stamps_s)[scene.windows]
    found = simulated_poses(known.base, (), scene)[scene.windows]
    pairs = ((poses[:, 0], poses[:, -1]) for poses in (expected[at], found))
    moved, simulated = (se2.between(*pair) for pair in pairs)
    np.testing.assert_allclose(simulated, moved, atol=2e-3)  # inputs are means over 0.1 s
    assert np.abs(expected[at]).max() > 3.0


def test_a_circle_has_a_closed_form(turning, known):
    scene = turning(0.3, 0.6)
    omega = 0.3 / WIDTH_M
    angle = omega * scene.pose_s
    forward, aside = (0.6 * 0.45 + 0.3 * 0.42) / WIDTH_M, -0.02 * omega
    # the robot's place turns about a fixed centre: i (forward + i aside) / omega from its start
    place = (forward + 1j * aside) / (1j * omega) * (np.exp(1j * angle) - 1.0)
    found = simulated_poses(known.base, (), scene)
    np.testing.assert_allclose(found, np.column_stack([place.real, place.imag, angle]), atol=1e-11)


def test_late_stamps_show_where_the_robot_was(turning, known):
    """On a straight line at 0.5 m/s an offset of 0.13 s is 6.5 cm, whatever makes it."""
    scene = turning(0.5, 0.5)
    plain = simulated_poses(known.base, (), scene)
    late = Added(TimeOffset(), np.array([0.13]))
    inner = scene.pose_s > 0.5
    moved = (plain - simulated_poses(known.base, (late,), scene))[inner]
    np.testing.assert_allclose(moved, np.array([[0.065, 0.0, 0.0]]).repeat(len(moved), 0))
    slow = replace(known.base, latency_s=0.13)
    np.testing.assert_allclose((plain - simulated_poses(slow, (), scene))[inner], moved)
    both = simulated_poses(replace(slow, latency_s=0.05), (late,), scene)
    np.testing.assert_allclose((plain - both)[inner][:, 0], 0.09)


def test_an_offset_of_whole_samples_is_the_earlier_pose(make_scene, known):
    """Poses every 0.2 s: an offset of 0.4 s shows the pose before the last."""
    scene = make_scene(5, duration_s=40.0)
    plain = simulated_poses(known.base, (), scene)
    late = simulated_poses(known.base, (Added(TimeOffset(), np.array([0.4])),), scene)
    np.testing.assert_allclose(late[2:], plain[:-2], atol=1e-12)


def test_a_sensor_off_centre_moves_on_a_circle_while_the_robot_turns_on_the_spot(turning, known):
    scene = turning(-0.45, 0.42)
    angle = scene.pose_s  # 1 rad/s about the ICR of the robot, 2 cm ahead of it
    centre = replace(known.base, values=known.base.values * [1, 1, 0, 1, 1])
    found = simulated_poses(centre, (Added(LeverArm(), ARM),), scene)
    place = complex(*ARM) * np.exp(1j * angle)
    np.testing.assert_allclose(found, np.column_stack([place.real, place.imag, angle]), atol=1e-11)


def test_a_heading_offset_turns_the_measured_path(turning, known):
    scene = turning(0.5, 0.5)
    offset = Added(HeadingOffset(), np.full(len(HeadingOffset().parameters), 0.1))
    poses = simulated_poses(known.base, (offset,), scene)[scene.windows]
    seen = se2.between(poses[:, 0], poses[:, -1])
    np.testing.assert_allclose(np.arctan2(seen[:, 1], seen[:, 0]), -0.1, atol=1e-11)


def test_uphill_the_map_shows_the_cosine_of_the_way(turning, known):
    scene = turning(0.5, 0.5, pitch=-0.3, roll=0.0)
    x = simulated_poses(known.base, (), scene)[:, 0]
    np.testing.assert_allclose(x, 0.5 * np.cos(0.3) * scene.pose_s)


def test_residuals_are_measured_less_simulated(turning, known):
    """The measured robot drives 0.5 m/s straight, the simulated one 0.4 m/s on a circle."""
    scene = turning(0.5, 0.5)
    straight = np.column_stack([0.5 * scene.pose_s, 0 * scene.pose_s, 0 * scene.pose_s])
    scene = replace(scene, poses=straight)
    off = Base(known.base.model, np.array([0.45, -0.42, 0.0, 0.8, 0.8]), known.base.robot)
    found = residuals(off, (), scene)
    after_s = scene.pose_s[scene.windows[:, 1:]] - scene.start_s[:, None]
    np.testing.assert_allclose(found[..., 0], 0.1 * after_s, atol=1e-11)
    np.testing.assert_allclose(found[..., 1:], 0.0, atol=1e-11)


def test_headings_differ_by_whole_turns_too(turning, known):
    """At 1 rad/s, simulated at 0.95 or 0.1 rad/s, over windows of 8 s."""
    spinning = turning(-0.45, 0.42)
    scene = dense_windows_of(spinning.run, 8.0)
    exact = simulated_poses(known.base, (), scene)
    after_s = scene.pose_s[scene.windows[:, 1:]] - scene.start_s[:, None]
    for share in (0.95, 0.1):
        slower = replace(known.base, values=known.base.values * [1, 1, 1, share, share])
        found = residuals(slower, (), replace(scene, poses=exact))
        np.testing.assert_allclose(found[..., 2], (1 - share) * after_s, atol=1e-11)


@pytest.mark.parametrize("yaw_rate", [None, 0.1])
@pytest.mark.parametrize("column", [YAW_FOUND, "z"])
def test_a_yaw_that_was_found_by_a_gyroscope_is_reported_as_such(make_scene, column, yaw_rate):
    scene = make_scene(3, duration_s=40.0)
    pose = scene.run.pose
    with_column = replace(pose, columns={**pose.columns, column: np.full(len(pose), 0.05)})
    rates = None if yaw_rate is None else np.full(len(scene.inputs.time_s), yaw_rate)
    scene = replace(
        scene,
        run=replace(scene.run, pose=with_column),
        inputs=replace(scene.inputs, yaw_rate_rad_s=rates),
    )
    assert reported_of(scene).yaw_is_found == (column == YAW_FOUND and yaw_rate is not None)
