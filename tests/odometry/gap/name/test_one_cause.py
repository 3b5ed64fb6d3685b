"""Two names together, where one cause without a name does all of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.tread_slip import SlipBySpeed
from odometry.effects.motion.terrain import NewIcrs
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.general import shares_of_motion
from odometry.gap.name.one_cause import is_more_than_one
from odometry.gap.prepare.measured import measured_of

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def asked(make_scene, known):
    """Why names are one cause, where the truth keeps a share of each tread's speed."""

    def of(kept, effects):
        def planted(columns, _):
            left, right = columns["v_left"], columns["v_right"]
            of_left, of_right = kept(left, right)
            apart, (y_left, y_right, x_icr) = (
                known.base.values[0] - known.base.values[1],
                (known.base.values[:3]),
            )
            turn = (of_right * right - of_left * left) / apart
            ahead = (of_right * right * y_left - of_left * left * y_right) / apart
            return np.column_stack([ahead, -x_icr * turn, turn])

        scene = make_scene(9, planted).numbered(0)
        fitter = Fitter(known, measured_of([scene], known, CONFIG))
        search = SimpleNamespace(fitter=fitter, config=CONFIG)
        smooth = shares_of_motion([scene], known.base, CONFIG)
        return is_more_than_one(search, fitter.fit(effects), smooth)

    return of


def test_treads_that_lose_by_the_speed_of_the_robot_are_no_terrain_with_slip(asked):
    def by_the_robot(left, right):
        kept = 1 - 0.15 * np.abs(left + right) / 2
        return kept, kept

    reason = asked(by_the_robot, [NewIcrs(), SlipBySpeed()])
    assert reason.endswith("alone explains more than terrain and tread_slip together")


def test_a_terrain_with_slip_is_two_effects(asked):
    def by_each_tread(left, right):
        return 0.9 * (1 - 0.15 * np.abs(left)), 0.95 * (1 - 0.15 * np.abs(right))

    assert asked(by_each_tread, [NewIcrs(), SlipBySpeed()]) == ""


def test_one_name_is_asked_elsewhere(asked):
    assert asked(lambda left, right: (0.9 + 0 * left, 0.9 + 0 * right), [SlipBySpeed()]) == ""
