"""Effects on the measurement, done and undone."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added, seen_poses
from odometry.effects.measurement.measured import (
    on_measurement,
    robot_poses,
    robot_run,
    shared_measurement,
)
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.errors import ParameterError
from odometry.recording.run import Run
from tests.odometry.effects.reports import reported

ARM = Added(LeverArm(), np.array([0.3, -0.2]))
TURNED = Added(HeadingOffset(), np.array([0.7]))
LATE = Added(TimeOffset(), np.array([0.13]))
SKID = Added(LateralSkid(), np.array([0.1]))
ORDERS = [[ARM], [TURNED, ARM], [ARM, TURNED, LATE], [LATE, SKID, TURNED, TURNED, ARM, ARM]]


@pytest.mark.parametrize("effects", ORDERS)
def test_robot_poses_are_the_inverse_of_seen_ones(rng, effects):
    poses = rng.uniform(-3, 3, (40, 3))
    np.testing.assert_allclose(
        robot_poses(effects, reported(seen_poses(effects, poses, reported(poses)))),
        poses,
        atol=1e-12,
    )


@pytest.mark.parametrize("effects", ORDERS)
def test_a_run_as_seen_gives_the_run_of_the_robot_back(make_run, rng, effects):
    """Headings in (-pi, pi], stamps to their spacing; what else the table holds stays."""
    stamps_s = np.cumsum(rng.uniform(0.05, 0.2, 20))
    poses = rng.uniform(-3, 3, (20, 3))
    poses[4] = np.nan
    seen = seen_poses(effects, poses, reported(poses))
    seen[:, 2] = np.angle(np.exp(1j * seen[:, 2]))
    late_s = 0.13 * sum(added is LATE for added in effects)
    rows = [
        ",".join("" if np.isnan(v) else repr(float(v)) for v in (t, *row)) + f",{i // 5}"
        for i, (t, row) in enumerate(zip(stamps_s + late_s, seen, strict=True))
    ]
    run = Run.read(make_run(pose="\n".join(["t,x,y,yaw,window", *rows, ""])))
    found = robot_run(run, effects)
    np.testing.assert_allclose(found.pose.stack("x", "y", "yaw"), poses, atol=1e-12)
    np.testing.assert_allclose(found.pose.stamps_s, stamps_s, atol=1e-12)
    np.testing.assert_array_equal(found.pose["window"], np.arange(20) // 5)
    np.testing.assert_array_equal(run.pose["t"], stamps_s + late_s)  # untouched
    assert found.odometry is run.odometry


def test_a_run_whose_sensor_is_as_it_should_be_is_itself(make_run):
    run = Run.read(make_run(pose="t,x,y,yaw\n0,0,0,0\n0.1,1,0,0\n"))
    assert robot_run(run, []) is run
    assert robot_run(run, [SKID]) is run
    assert robot_run(replace(run, pose=None), [ARM]).pose is None


def test_terrains_share_one_sensor():
    assert on_measurement([SKID, ARM, LATE]) == (ARM, LATE)
    assert shared_measurement([[SKID, ARM], [ARM]]) == (ARM,)
    assert shared_measurement([[SKID], []]) == ()
    assert shared_measurement([]) == ()
    longer = Added(LeverArm(), np.array([0.4, -0.2]))
    for other in ([longer], [], [ARM, TURNED]):
        with pytest.raises(ParameterError, match=r"lever_arm.*expected those of one sensor"):
            shared_measurement([[ARM], other])
