"""Parameters that are given for the base, against the calibration runs."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import GapError
from odometry.gap.config import GapConfig
from odometry.gap.prepare.given_base import check_given
from odometry.gap.prepare.prepared import prepared
from odometry.models.icr import Icr
from tests.odometry.positions_drives import table

TRUE = {"y_left": 0.45, "y_right": -0.42, "x_icr": 0.02, "alpha_left": 1.0, "alpha_right": 1.0}
MILLIMETRES = {name: 1000 * TRUE[name] for name in ("y_left", "y_right", "x_icr")}


@pytest.fixture(scope="module")
def run(make_scene):
    return make_scene(600, duration_s=80.0, top_m_s=0.5).run


@pytest.mark.parametrize(
    "changed", [{}, {"x_icr": 0.0}, {"y_left": 0.5, "y_right": -0.5}, {"alpha_left": 0.95}]
)
def test_what_fits_or_nearly_fits_is_taken(run, changed):
    check_given(Icr(), TRUE | changed, [run])


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"y_left": 0.9, "y_right": -0.84}, r"turned 2\.0\d \+- 0\.\d\d times as far"),
        ({"alpha_left": 0.1, "alpha_right": 0.1}, r"turned 9\.9\d .* and went 9\.5\d \+-"),
        (MILLIMETRES, r"turned (99\d|100\d)\.\d\d \+-"),
    ],
)
def test_what_is_of_another_robot_or_unit_is_refused(run, changed, said):
    with pytest.raises(GapError, match=said):
        check_given(Icr(), TRUE | changed, [run])


def test_the_noise_of_positions_is_no_way_of_a_robot_that_spins_on_the_spot(run):
    rng, t = np.random.default_rng(7), np.arange(0.0, 120.0, 0.02)
    turning = np.outer([-0.45, 0.45], 0.6 * np.sign(np.sin(t / 15)))
    left, right = turning + rng.normal(0, 0.01, (2, len(t)))
    yaw = np.append(0.0, np.cumsum(0.02 * (right - left)[:-1] / 0.9))[::5]
    x, y = rng.normal(0, 0.02, (2, len(yaw)))
    spin = replace(
        run,
        odometry=table({"t": t, "v_left": left, "v_right": right}),
        pose=table({"t": t[::5], "x": x, "y": y, "yaw": yaw}),
        imu=None,
    )
    check_given(Icr(), TRUE | {"y_right": -0.45, "x_icr": 0.0}, [spin])


def test_the_workflow_asks(run, make_scene):
    measured = make_scene(601, duration_s=80.0, top_m_s=0.5).run
    base = Icr(), TRUE | {"y_left": 0.9, "y_right": -0.84}
    with pytest.raises(GapError, match="calibrate on runs that the set fits"):
        prepared([measured], [run], [], base, GapConfig())


@pytest.mark.parametrize(
    ("changed", "noted"), [({}, False), ({"y_left": 0.5, "y_right": -0.5}, True)]
)
def test_what_nearly_fits_is_said(run, make_scene, changed, noted):
    """A base that turns by 13 % less: what it lacks is in the calibration as well."""
    measured = make_scene(601, duration_s=80.0, top_m_s=0.5).run
    notes = prepared([measured], [run], [], (Icr(), TRUE | changed), GapConfig()).notes
    assert any("the given parameters leave" in note for note in notes) is noted
