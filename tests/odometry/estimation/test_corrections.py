"""The ICR filter under parameter sets with effects, against sets that say the same without."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon
from odometry.effects.catalogue import added_effects
from odometry.effects.interface.corrected import Corrected
from odometry.effects.measurement.measured import robot_run
from odometry.errors import ParameterError
from odometry.estimation.config import PAPER, IcrEkfConfig
from odometry.estimation.corrections import corrections_of
from odometry.estimation.icr_ekf import IcrEkf
from odometry.models.catalogue import MODELS
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Run
from odometry.replays.learned_parameters import learned_parameters
from odometry.replays.pipeline import ConstantTerrain, replay
from odometry.windows.recorded.run_inputs import inputs_of

ICRS = {"y_left": 0.4, "y_right": -0.3, "x_icr": 0.05, "alpha_left": 0.9, "alpha_right": 0.8}
STAMPS_S = np.arange(0, 6.01, 0.1)
ODOMETRY = "t,v_left,v_right,roll,pitch\n" + "".join(
    f"{t},{0.5 + 0.3 * np.sin(2 * t)},{0.6 - 0.2 * np.cos(t)},{0.1 * np.sin(t)},{0.1 * np.cos(t)}\n"
    for t in STAMPS_S
)


def effect(name, form, **parameters):
    return {"name": name, "form": form, "parameters": parameters}


SCALE = effect("wheel_scale", "factors", c_l=1.2, c_r=0.7)
SKID = effect("lateral_skid", "x_icr", x_shift=0.2)
SLIDES = effect("slope_sliding", "icr_slope", lambda_1=2.0, lambda_2=3.0, v_max=2.0)
LAG = effect("actuator_lag", "first_order", lag=0.3)


def table(*effects, **values):
    return TerrainParameters("icr", ICRS | values, effects=tuple(effects))


@dataclass
class Then:
    """a, and b from 3 s on."""

    initial: str = "a"

    def terrain(self, frame, _):
        return "a" if frame.stamp_s < 3 else "b"


@pytest.fixture
def run(make_run):
    return Run.read(make_run(odometry=ODOMETRY))


@pytest.fixture
def posed(make_run):
    """With poses at stamps between those of odometry."""
    poses = "t,x,y,yaw\n" + "".join(
        f"{t},{0.5 * t},{0.1 * t},{0.1 * t}\n" for t in np.arange(0.05, 5.9, 0.33)
    )
    return Run.read(make_run(odometry=ODOMETRY, pose=poses))


def replayed(run, source=None, **tables):
    """Of poses so uncertain that none is refused, slip factors held as given."""
    parameters = ParameterSet(tables)
    config = IcrEkfConfig(**PAPER, position_sigma_m=0.5, yaw_sigma_rad=0.3)
    estimator = IcrEkf(0.6, parameters, config, corrections_of(run, parameters))
    return replay(run, estimator, source or ConstantTerrain("a"))


def assert_alike(one, other):
    np.testing.assert_allclose(one.means[:, :6], other.means[:, :6], atol=1e-9)
    np.testing.assert_allclose(one.sigmas, other.sigmas, atol=1e-9)
    np.testing.assert_allclose(one.odometer().poses, other.odometer().poses, atol=1e-9)


def test_wheel_scale_filters_as_other_slip_factors(posed):
    scaled = replayed(posed, a=table(SCALE))
    factors = replayed(posed, a=table(alpha_left=0.9 * 1.2, alpha_right=0.8 * 0.7))
    assert_alike(scaled, factors)
    ideal = scaled.differential_drive(0.6).poses
    np.testing.assert_array_equal(ideal, factors.differential_drive(0.6).poses)


def test_effects_on_commands_and_motion_are_integrated(run):
    """Without poses, filter and odometer are dead reckoning of the corrected model."""
    effects = (SCALE, LAG, SKID, SLIDES)
    result = replayed(run, a=table(*effects))
    model = Corrected(MODELS["icr"], run.robot, added_effects(effects, "here"))
    twists = model.twist(model.pack(ICRS), inputs_of(run))
    expected = dead_reckon(STAMPS_S, twists, np.zeros(3)).poses
    np.testing.assert_allclose(result.odometer().poses, expected, atol=1e-12)
    np.testing.assert_allclose(result.means[:, :3], expected, atol=1e-12)
    plain = replayed(run, a=table()).odometer().poses
    assert np.abs(plain - expected).max() > 0.3


def test_what_the_motion_adds_stays_while_the_icrs_are_learned(posed):
    """A skid of 0.2 m at the ICRs of the set: -0.2 omega of v_y, whatever the filter holds."""
    result = replayed(posed, a=table(SKID))
    base = MODELS["icr"].twist(MODELS["icr"].pack(ICRS), inputs_of(posed))
    learned = np.abs(result.means[-1, 3:6] - [0.4, -0.3, 0.05]).max()
    assert learned > 0.01
    rows = np.searchsorted(STAMPS_S, result.stamps_s, side="right") - 1
    for estimate, row in zip(result.estimates, rows, strict=True):
        np.testing.assert_allclose(estimate.added_twist, [0, -0.2 * base[row, 2], 0], atol=1e-12)


def test_effects_are_those_of_the_terrain_in_force(run):
    """Scale on a, skid on b; a ground without a table has none."""
    result = replayed(run, Then(), a=table(SCALE), b=table(SKID))
    before = replayed(run, a=table(SCALE)).odometer().poses
    after = replayed(run, ConstantTerrain("b"), b=table(SKID)).odometer()
    here = STAMPS_S < 2.95
    np.testing.assert_allclose(result.odometer().poses[here], before[here], atol=1e-12)
    joint = np.flatnonzero(here)[-1] + 1
    twists = np.stack([estimate.twist for estimate in result.estimates])[joint:]
    again = dead_reckon(STAMPS_S[joint:], twists, after.poses[joint]).poses
    np.testing.assert_allclose(again, after.poses[joint:], atol=1e-12)
    unknown = replayed(run, ConstantTerrain("c"), a=table(SCALE)).estimates[3]
    assert not unknown.added_speeds_m_s.any()
    assert not unknown.added_twist.any()


def test_an_effect_on_the_measurement_is_undone_at_the_door(posed):
    """Poses of a sensor ahead and to the left, turned: the filter sees those of the robot."""
    sensor = (
        effect("lever_arm", "constant", x_arm=0.3, y_arm=0.1),
        effect("heading_offset", "constant", offset=0.4),
    )
    x, y, yaw = posed.pose.stack("x", "y", "yaw").T
    columns = {
        **posed.pose.columns,
        "x": x + 0.3 * np.cos(yaw) - 0.1 * np.sin(yaw),
        "y": y + 0.3 * np.sin(yaw) + 0.1 * np.cos(yaw),
        "yaw": yaw + 0.4,
    }
    seen = replace(posed, pose=replace(posed.pose, columns=columns))
    door = robot_run(seen, added_effects(sensor, "here"))
    assert_alike(replayed(door, a=table(*sensor)), replayed(posed, a=table()))


def test_a_set_with_effects_needs_its_corrections():
    with pytest.raises(ParameterError, match=r"terrain\.a\]: effects were given"):
        IcrEkf(0.6, ParameterSet({"a": table(SCALE)}))


def test_effects_of_another_model_than_the_base_are_refused(run):
    tables = {
        "a": TerrainParameters("icr_symmetric", {"alpha": 1.0, "b_hat": 0.8}, effects=(SLIDES,))
    }
    with pytest.raises(ParameterError, match="slope_sliding"):
        corrections_of(run, ParameterSet(tables))


def test_what_was_learned_keeps_its_effects(posed):
    result = replayed(posed, a=table(SCALE))
    learned = learned_parameters(ParameterSet({"a": table(SCALE)}), result, "r").terrains["a"]
    assert learned.effects == (SCALE,)
    assert learned.values["y_left"] != ICRS["y_left"]
    plain = ParameterSet({"a": table()})
    assert learned_parameters(plain, result, "r").terrains["a"].effects == ()
