"""The interacting multiple model estimator as a source of terrain."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.modes.follow.track import ModesConfig
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes
from terrain.sources.sources import felt_terrain
from tests.odometry.modes.mode_drives import velocity_run

NAMES = ("ice", "tar")
A = np.array([[[-5.0, 0.0], [0.0, -4.0]], [[-5.0, 0.0], [0.0, -6.0]]])
SETTLED = np.array([[[0.5, 0.5], [-0.8, 0.8]], [[0.5, 0.5], [-1.2, 1.2]]])
B = -A @ SETTLED
SET = ModeSet(
    VelocityModes(NAMES, A, B, np.full((2, 2), 1e-3), np.full((2, 2), 4e-4)), np.full(2, 20.0)
)
CHANGE_S = 15.0


@pytest.fixture(scope="module")
def run():
    """Ice, from 15 s on tar."""
    labels = np.repeat(NAMES, 750).tolist()
    by_name = dict(zip(NAMES, A, strict=True)), dict(zip(NAMES, B, strict=True))
    return velocity_run(np.random.default_rng(3), *by_name, labels)


def at(source, stamp_s):
    return source.terrain(SimpleNamespace(stamp_s=stamp_s), None)


def test_the_terrain_follows_the_motion_over_the_change(run):
    source = felt_terrain(run, SET, "sand")
    assert source.initial == "sand"
    assert at(source, CHANGE_S - 0.1) == "ice"
    assert at(source, CHANGE_S + 5.0) == "tar"


def test_while_nothing_is_recognised_the_terrain_in_force_stays(run):
    """Nothing is ever sure enough."""
    never = felt_terrain(run, SET, "sand", ModesConfig(sure=1 - 1e-15, floor=1e-6))
    assert at(never, 29.0) == "sand"


def test_the_answer_does_not_know_what_comes(run):
    """Cut at 10 s, the same answers until then."""
    cut = {
        name: replace(
            table,
            columns={key: column[:500] for key, column in table.columns.items()},
            lines=table.lines[:500],
        )
        for name, table in (("odometry", run.odometry), ("velocity", run.velocity))
    }
    whole, part = felt_terrain(run, SET, "sand"), felt_terrain(replace(run, **cut), SET, "sand")
    stamps_s = np.arange(0.0, 9.9, 0.1)
    assert [at(whole, t) for t in stamps_s] == [at(part, t) for t in stamps_s]


def test_modes_of_wheels_name_no_terrain(run):
    gains = np.zeros((1, 2, 3, 5))
    of_wheels = TractionModes(("slips",), gains, np.zeros(1), 0.5, np.ones(3), np.ones(4), 0.0)
    with pytest.raises(ParameterError, match=r"slips.*kind 'velocity'"):
        felt_terrain(run, ModeSet(of_wheels, np.full(1, 20.0)), "sand")
