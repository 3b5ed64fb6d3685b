"""What is hidden in blind cases is named, at the noise of the issue; one seed of each kind.

Twenty seeds of every kind, at three levels of noise: `tests/studies/gap_cases.py`.
"""

import numpy as np
import pytest

from odometry.effects.base import Base
from odometry.effects.corrected import Added
from odometry.effects.heading_offset import HeadingOffset
from odometry.effects.slope_icr import SlopeByIcr
from odometry.gap.fit import Fitted
from odometry.gap.gap import find_gap
from odometry.gap.name import is_there
from odometry.models.catalogue import MODELS
from odometry.run import Robot, Run
from tests.blind.cases import FORMULA, make_case

PAIRS = ("wheel_scale+time_offset", "time_offset+lever_arm")
CASES = (
    *((kind, 0) for kind in (*FORMULA, "unknown_pull", "unknown_ripple", *PAIRS)),
    *(("none", 0), ("none", 1), ("contact_slope", 0)),
)


def read(case):
    return [Run.read(folder) for folder in (case.measured, case.calibration, case.holdout)]


@pytest.fixture(scope="session")
def studied(tmp_path_factory):
    """A case and what was found in it, each studied once."""
    known = {}

    def study(kind, seed):
        if (kind, seed) not in known:
            case = make_case(kind, seed, tmp_path_factory.mktemp("case"))
            measured, calibration, holdout = read(case)
            known[kind, seed] = case, find_gap([measured], [calibration], [holdout])
        return known[kind, seed]

    return study


def names(result):
    return [added.effect.name for added in result.added]


@pytest.mark.parametrize(("kind", "seed"), CASES)
def test_the_verdict_is_right(studied, kind, seed):
    case, result = studied(kind, seed)
    assert result.verdict in (case.effects or ("none",))
    assert (result.verdict == "none") == (names(result) == [])


@pytest.mark.parametrize(("kind", "least"), [*((k, 0.9) for k in FORMULA), ("unknown_pull", 0.5)])
def test_the_held_out_excess_is_closed(studied, kind, least):
    _, result = studied(kind, 0)
    assert result.holdout.share_closed > least
    assert result.holdout.after.value < result.holdout.noise_floor.high * 1.2


@pytest.mark.parametrize("kind", PAIRS)
def test_both_of_a_pair_are_named(studied, kind):
    case, result = studied(kind, 0)
    assert set(names(result)) >= set(case.effects)


def fitted(effect, values, covariance):
    base = Base(MODELS["icr"], np.array([0.4, -0.4, 0.0, 1.0, 1.0]), Robot(0.6))
    return Fitted(base, (Added(effect, np.array(values)),), covariance, np.ones(3), np.ones(3), 0.0)


def test_an_effect_known_only_as_a_product_is_there():
    """lambda v_max is known to 1 %, lambda and v_max are not."""
    along = np.array([0.1, 0.05, -10.0])
    covariance = 2.0 * np.outer(along, along) + np.diag([1e-6, 1e-6, 1e-2])
    assert is_there(fitted(SlopeByIcr(), [0.1, 0.05, 10.0], covariance))
    assert not is_there(fitted(SlopeByIcr(), [1e-4, 1e-4, 10.0], covariance))


def test_an_effect_within_its_uncertainty_of_none_is_not_there():
    assert not is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-6]])))
    assert is_there(fitted(HeadingOffset(), [-0.0014], np.array([[1e-8]])))
