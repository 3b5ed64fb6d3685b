"""A base that the calibration leaves open is no base: its errors would be taken for an effect."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import calibrated
from odometry.gap.prepare.determined import require_determined
from odometry.models.icr import Icr
from odometry.windows.dense.dense import dense_windows_of


def calibration_of(run):
    return calibrated([dense_windows_of(run, 2.0)], Icr(), run.robot, GapConfig())


def refusal_of(calibration, measured):
    """What is said of a base that is refused; nothing of one that is taken."""
    try:
        require_determined(calibration, measured)
    except GapError as error:
        return str(error)
    return ""


@pytest.fixture(scope="module")
def winding(make_scene):
    return make_scene(600, duration_s=60.0, top_m_s=0.5)


def test_turns_of_many_radii_determine_it(winding):
    assert refusal_of(calibration_of(winding.run), [winding]) == ""


@pytest.mark.parametrize(
    ("left", "right", "words"),
    [
        (0.0, 0.0, "the predicted motion does not depend on it"),
        (0.4, 0.4, "y_left"),
        (-0.4, 0.4, "y_left"),
        (0.3, 0.4, "y_left"),
    ],
)
def test_a_drive_of_one_kind_does_not(winding, left, right, words):
    """It stands, goes straight on, spins, or drives one circle; as measured run it may."""
    run = winding.run
    rng, t, pose_s = np.random.default_rng(1), run.odometry.stamps_s, run.pose.stamps_s
    turn_rad_s, speed_m_s = (right - left) / 0.87, (left + right) / 2
    yaw = turn_rad_s * pose_s
    across = speed_m_s / turn_rad_s if turn_rad_s else 0.0
    x = across * np.sin(yaw) if turn_rad_s else speed_m_s * pose_s
    columns = {"x": x, "y": across * (1 - np.cos(yaw)), "yaw": yaw}
    pose = {name: of + rng.normal(0, 0.01, len(of)) for name, of in columns.items()}
    treads = {"v_left": np.full(len(t), left), "v_right": np.full(len(t), right)}
    alike = replace(
        run,
        odometry=replace(run.odometry, columns={"t": t, **treads}),
        pose=replace(run.pose, columns={"t": pose_s, **pose}),
    )
    refused = refusal_of(calibration_of(alike), [winding])
    assert refused.startswith("the calibration runs do not determine 'icr'")
    assert words in refused
    assert refusal_of(calibration_of(alike), [dense_windows_of(alike, 2.0)]) == ""
