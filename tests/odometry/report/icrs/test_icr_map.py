import numpy as np
import pytest

from odometry.icrs.measured import MeasuredIcrs
from odometry.recording.run import Robot
from odometry.report.icrs.icr_map import TURN_STYLES, frame_of, plot_icrs
from odometry.report.icrs.icr_picture import save_icr_picture

ROBOT = Robot(track_width=0.5, length=0.9, width=0.6)
FITTED = np.array([0.45, -0.36, 0.06])


def measured(count, omega=1.0):
    rng = np.random.default_rng(3)
    return MeasuredIcrs(
        np.arange(count, dtype=float),
        np.ones(count),
        np.full(count, "one", dtype=object),
        np.full(count, "$mud", dtype=object),
        np.column_stack([np.ones(count), np.zeros(count), np.full(count, omega)]),
        np.ones((count, 2)),
        FITTED + 0.02 * rng.normal(size=(count, 3)),
        np.tile(0.01 * np.eye(3), (count, 1, 1)),
    )


def points_of(axes, colour):
    return np.concatenate([line.get_xydata() for line in axes.lines if line.get_color() == colour])


def test_left_is_left_and_forward_is_up(axes):
    plot_icrs(axes, measured(20), ROBOT, FITTED)
    left, right = axes.transData.transform([[0.45, 0.06], [-0.36, 0.06]])
    behind = axes.transData.transform([0.45, -0.1])
    assert left[0] < right[0]
    assert behind[1] < left[1]


def test_points_and_medians_of_a_side_have_its_colour(axes):
    icrs = measured(20, omega=-1.0)
    plot_icrs(axes, icrs, ROBOT)
    drawn = points_of(axes, TURN_STYLES["right"]["color"])
    np.testing.assert_allclose(drawn[:20], icrs.icrs[:, [0, 2]])
    np.testing.assert_allclose(drawn[20:40], icrs.icrs[:, [1, 2]])
    assert len(drawn) == 40 + 2 * (2 + 2 + 1)  # two bars and a median for each tread
    assert len(axes.patches) == 3 + 2  # the body, its treads, and two ellipses


def test_too_few_points_have_no_median(axes):
    plot_icrs(axes, measured(9), Robot(track_width=0.5))
    assert len(points_of(axes, TURN_STYLES["left"]["color"])) == 18
    assert len(axes.patches) == 2  # treads alone: no size of the body is stated


def test_the_frame_holds_robot_and_fit_but_not_every_point():
    icrs = np.vstack([np.tile(FITTED, (30, 1)), [[9.0, -9.0, 5.0]]])
    frame = frame_of(icrs, ROBOT, np.array([1.5, -1.4, 0.0]))
    assert frame.left > 1.5
    assert frame.right < -1.4
    assert frame.front > 0.45
    assert frame.back < -0.45
    assert frame.holds(icrs).tolist() == [True] * 30 + [False]


@pytest.mark.parametrize("terrains", [1, 4])
def test_the_same_picture_has_the_same_bytes(tmp_path, terrains):
    icrs = {f"$mud_{number}": measured(5 * number) for number in range(terrains)}
    first, second = (
        save_icr_picture(tmp_path / name, icrs, ROBOT, {"$mud_0": FITTED}, source="made by: it\n")
        for name in ("1.png", "2.png")
    )
    assert first.read_bytes() == second.read_bytes()
    assert b"made by: it\n" in first.read_bytes()
