"""A bag read message by message, as a robot hears it."""

import numpy as np

from odometry.bags.files.messages import bag_messages
from odometry.estimation.config import IcrEkfConfig
from odometry.recording.live_frames import LiveFrames
from odometry.recording.run import Robot
from terrain.config import Config
from terrain.live.live_odometry import LiveOdometry
from terrain.main_job import run_odometry
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, TRACK_M, Bag, course, half_turn

CAUSAL = Config(filter=IcrEkfConfig(causal=True))


def test_a_bag_read_as_if_live_gives_what_its_import_gives(tmp_path):
    """Up to the rounding of numbers in files; wheels by their mean, times its radius."""
    bag = Bag("mcap")
    for k, (t_s, left, right, x, y, yaw) in enumerate(course()):
        speeds = [left / RADIUS_M, right / RADIUS_M]
        bag.joints(t_s + 0.002, ["left_wheel", "right_wheel"], [], speeds, stamp_s=t_s)
        bag.imu(t_s + 0.01, [0.0, 0.0, 0.5 * np.cos(0.7 * t_s) + 0.01], [0.0, 0.0, 9.81])
        if k % 4 == 3:
            bag.pose_stamped("/mocap/pose", t_s + 0.003, bag.pose((x, y, 0.5), half_turn(yaw)))
    path = bag.write(tmp_path / "bag")
    run, _ = imported(tmp_path / "run", path)
    expected = run_odometry(run, config=CAUSAL)
    live, frames, steps = LiveOdometry(Robot(TRACK_M), at_pose=True), LiveFrames(), []
    for topic, stamp_s, message in bag_messages(path):
        if topic == "/joint_states":
            frames.treads(stamp_s, *(RADIUS_M * message.velocity))
        elif topic == "/imu/data":
            frames.gyroscope(stamp_s, message.angular_velocity.z)
        elif topic == "/mocap/pose":
            of, turn = message.pose.position, message.pose.orientation
            frames.pose(stamp_s, of.x, of.y, 2 * np.arctan2(turn.z, turn.w))
        steps += [step for frame in frames.ready() if (step := live.step(frame)) is not None]
    assert frames.too_late == 0
    count = len(steps)
    assert count > 0.95 * len(expected.replay.estimates)
    poses = np.array([step.odometer for step in steps])
    np.testing.assert_allclose(poses, expected.replay.odometer().poses[:count], atol=1e-6)
    means = np.array([step.estimate.mean for step in steps])
    np.testing.assert_allclose(means, expected.replay.means[:count], atol=1e-6)
