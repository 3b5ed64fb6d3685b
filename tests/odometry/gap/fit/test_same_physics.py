"""Effects of the same physics have one set of values."""

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.motion.contact_effects import InertiaByContact, SlopeByContact
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.hypothesis import Hypothesis, own_values
from odometry.gap.prepare.measured import measured_of

SHARE = 0.08


class Aside(MotionEffect):
    """The robot slips aside by a share of its speed."""

    name, form, physics = "aside", "toy", "toy"
    column = 1

    @property
    def parameters(self):
        return (EffectParameter("share", "", -1.0, 1.0, 0.01, 0.01),)

    def usual(self, base):  # noqa: ARG002 - of the interface
        return np.zeros(1), np.ones(1)

    def twist(self, values, twist, inputs, base):  # noqa: ARG002 - of the interface
        changed = twist.copy()
        changed[:, self.column] += values[0] * np.abs(twist[:, 0])
        return changed


class Around(Aside):
    """It turns by the same share."""

    name, column = "around", 2


class Alone(Around):
    """It turns by a share of its own."""

    physics = ""


def slipping(columns, twist):  # noqa: ARG001 - of the interface of effects
    changed = twist.copy()
    changed[:, 1:] += SHARE * np.abs(twist[:, :1])
    return changed


@pytest.fixture(scope="module")
def fitter(make_scene, known):
    scenes = (make_scene(72, slipping, duration_s=60.0),)
    return Fitter(known, measured_of(scenes, known, GapConfig()))


def test_two_effects_have_one_value_and_its_covariance(fitter):
    both = fitter.fit([Aside(), Around()])
    first, second = both.effects
    np.testing.assert_array_equal(first.values, second.values)
    np.testing.assert_allclose(both.covariance, both.covariance[0, 0])
    assert first.values[0] == pytest.approx(SHARE, abs=4 * np.sqrt(both.covariance[0, 0]))
    assert both.freedom == 1


def test_what_one_tells_narrows_the_other(fitter):
    """The information of a value that both have is the sum of what each has."""
    both, apart = fitter.fit([Aside(), Around()]), fitter.fit([Aside(), Alone()])
    assert apart.freedom == 2
    of_each = np.linalg.inv(apart.covariance)
    prior = 1.0  # of each that stands alone
    assert 1 / both.covariance[0, 0] == pytest.approx(of_each.sum() - prior, rel=0.05)
    assert both.base_moved == pytest.approx(SHARE**2, rel=0.1)
    assert apart.base_moved == pytest.approx(2 * SHARE**2, rel=0.1)


def test_a_known_one_is_free_again_beside_a_new_one(fitter):
    """A slow effect that was found stays pinned only while no other shares its values."""

    class Slow(Aside):
        slow = True

    start = fitter.fit([Slow()]).effects
    pinned = fitter.fit([*(one.effect for one in start), WheelScale()], start, pin_slow=True)
    np.testing.assert_array_equal(pinned.effects[0].values, start[0].values)
    shared = fitter.fit([*(one.effect for one in start), Around()], start, pin_slow=True)
    assert shared.effects[0].values[0] == shared.effects[1].values[0] != start[0].values[0]


def test_contact_forces_are_of_one_physics(fitter, known):
    slope, inertia, scale = SlopeByContact(0.3), InertiaByContact(0.3), WheelScale()
    assert own_values([slope, scale, inertia]) == (True, True, False)
    hypothesis = Hypothesis(known, fitter.measured, (slope, scale, inertia))
    own = np.arange(hypothesis.of_base, hypothesis.of_base + 5)
    np.testing.assert_array_equal(hypothesis.places[-5:], own)
    np.testing.assert_array_equal(hypothesis.places[:-5], np.arange(hypothesis.of_base + 7))
