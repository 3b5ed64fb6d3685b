"""Parameters that shape an effect by steps: derivatives say nothing of them, jumps do."""

import numpy as np
import pytest

from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.prepare.calibration import calibrated
from odometry.gap.prepare.measured import measured_of
from odometry.models.icr import Icr
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from odometry.windows.dense.dense import dense_windows_of, thinned
from tests.blind.cases import make_case

CONFIG = GapConfig()
LEVEL_M_S = 0.1
TRUE_GAIN, TRUE_LEVEL = -0.2, 7


class FromALevelOn(MotionEffect):
    """Less motion above a speed that changes by whole levels: a staircase."""

    name = form = "staircase"

    @property
    def parameters(self):
        return (
            EffectParameter("gain", "", -0.5, 0.5, 0.0, 0.01),
            EffectParameter("level", "", 0.0, 9.9, 2.5, 1.0, None),
        )

    def twist(self, values, twist, inputs, base):  # noqa: ARG002 - of the face
        return twist * less(inputs.right, *values)


def less(v_right, gain, level):
    return 1.0 + gain * (v_right > LEVEL_M_S * np.floor(level))[:, None]


@pytest.fixture(scope="module")
def fitter(make_scene, known):
    def planted(columns, twist):
        return twist * less(columns["v_right"], TRUE_GAIN, TRUE_LEVEL)

    return Fitter(known, measured_of([make_scene(70, planted)], known, CONFIG))


def test_a_level_five_stairs_off_is_found(fitter):
    fit = fitter.fit([FromALevelOn()])
    gain, level = fit.effects[0].values
    assert np.floor(level) == TRUE_LEVEL
    assert gain == pytest.approx(TRUE_GAIN, abs=4 * np.sqrt(fit.covariance[0, 0]))
    assert fitter.spread(fit) == pytest.approx(1.0, abs=0.05)


def test_its_derivative_says_nothing(fitter, known):
    """What makes the test above one of jumps."""
    start = (Added(FromALevelOn(), np.array([-0.1, 2.5])),)
    fit = Fitted(known.base, start, np.eye(2), np.ones(1), np.ones(1), 0.0)
    slopes = fitter.design(fit).jacobian
    assert np.abs(slopes[:, 0]).max() > 1.0
    np.testing.assert_array_equal(slopes[:, 1], 0.0)


def test_a_slow_effect_is_not_made_to_jump(fitter):
    """Each jump costs as many runs of the model as it has jumps."""

    class Slow(FromALevelOn):
        slow = True

    (added,) = fitter.fit([Slow()]).effects
    assert added.values[1] == 2.5


def test_inertia_is_found_beside_a_delay(tmp_path):
    """H acts through a sign alone; without jumps the search for it ends 0.1 off."""
    case = make_case("inertia+time_offset", 3, tmp_path)
    calibration, measured = Run.read(case.calibration), Run.read(case.measured)
    measured = cut_run(measured, Span(0.0, 80.0))
    scenes = [dense_windows_of(run, CONFIG.horizon_s) for run in (calibration, measured)]
    known = calibrated(scenes[:1], Icr(), calibration.robot, CONFIG)
    scene = thinned(scenes[1], CONFIG.most_windows)
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    robot = known.base.robot
    alone = fitter.fit([InertiaByIndices(robot.mass, robot.track_width)])
    both = fitter.fit([alone.effects[0].effect, TimeOffset()], alone.effects)
    assert both.effects[0].values[-1] == pytest.approx(case.truth["inertia"]["h"], abs=0.03)
    assert both.effects[1].values[0] == pytest.approx(
        case.truth["time_offset"]["delay_s"], abs=0.002
    )
    assert fitter.spread(both) == pytest.approx(1.0, abs=0.05)
