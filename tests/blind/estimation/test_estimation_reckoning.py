"""The loops of the estimation studies against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import with_poses_withheld, without_gyroscope
from tests.studies.main_job.estimation_reckoning import (
    Path,
    at,
    error_per_metre,
    gyroscope_drive,
    ideal_drive,
    position_errors_m,
    reference_path,
    wheel_travel_m,
)


@pytest.fixture
def circle(make_run):
    """A circle of radius 2 m at 1 m/s; the treads of a width of 1 m, the gyroscope 10 % more."""
    rows = "\n".join(f"{k / 100},0.75,1.25,0.55" for k in range(1257))
    poses = "\n".join(
        f"{k / 10},{2 * math.sin(k / 20)},{2 - 2 * math.cos(k / 20)},{k / 20}" for k in range(126)
    )
    return Run.read(
        make_run(
            "[robot]\ntrack_width = 1\n",
            f"t,v_left,v_right,gyro_z\n{rows}\n",
            pose=f"t,x,y,yaw\n{poses}\n",
        )
    )


def test_the_ideal_drive_drives_the_circle(circle):
    reference = reference_path(circle)
    path = ideal_drive(circle, 0.0, np.zeros(3))
    assert position_errors_m(path, reference).max() < 1e-4
    travel = wheel_travel_m(circle, reference.stamps_s)
    np.testing.assert_allclose(travel, reference.stamps_s, atol=1e-9)
    assert error_per_metre(path, reference, travel) < 1e-4


def test_the_gyroscope_drives_the_circle_that_it_measures(circle):
    path = gyroscope_drive(circle, 0.0, np.zeros(3))
    angle = 0.55 * path.stamps_s
    np.testing.assert_allclose(path.poses[:, 0], np.sin(angle) / 0.55, atol=1e-4)
    np.testing.assert_allclose(path.poses[:, 2], angle, atol=1e-9)
    reference = reference_path(circle)
    error = error_per_metre(path, reference, wheel_travel_m(circle, reference.stamps_s))
    ends = [np.array([math.sin(5 * w) / w, (1 - math.cos(5 * w)) / w]) for w in (0.5, 0.55)]
    assert error == pytest.approx(math.dist(*ends) / 5, abs=1e-4)
    assert gyroscope_drive(without_gyroscope(circle), 0.0, np.zeros(3)) is None


def test_a_window_ends_where_its_travel_is_reached():
    stamps = np.arange(11.0)
    straight = np.stack([stamps, 0 * stamps, 0 * stamps], axis=-1)
    longer = straight * [1.1, 1, 1]
    assert error_per_metre(Path(stamps, longer), Path(stamps, straight), stamps) == pytest.approx(
        0.1
    )
    assert math.isnan(error_per_metre(Path(stamps, longer), Path(stamps, straight), stamps / 3))


def test_yaw_is_interpolated_along_the_shorter_way():
    path = Path(np.array([0.0, 1.0]), np.array([[0, 0, 3.0], [0, 0, -3.0]]))
    assert at(path, np.array([0.5]))[0, 2] == pytest.approx(math.pi)


def test_every_second_second_of_poses_is_withheld(circle):
    fewer, withheld = with_poses_withheld(circle)
    assert withheld.sum() + len(fewer.pose) == len(circle.pose)
    assert {int(t) % 2 for t in fewer.pose.stamps_s} == {0}
    np.testing.assert_array_equal(replace(circle, pose=fewer.pose).pose["x"], fewer.pose["x"])
