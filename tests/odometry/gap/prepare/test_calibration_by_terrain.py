"""ICRs of their own for the terrains of the calibration, where they differ."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.prepare.by_terrain import by_terrain, labels_covered
from odometry.gap.prepare.calibration import calibrated
from odometry.models.icr import Icr, IcrByTerrain

CONFIG = GapConfig()
WIDER = 1.4  # on ice


def turning_less(columns, twist):
    """About ICRs farther apart on ice: less yaw rate, and less sideways motion."""
    slow = np.where(columns["terrain"] == "ice", 1 / WIDER, 1.0)[:, None]
    return twist * np.column_stack([np.ones_like(slow), slow, slow])


def alike(columns, twist):  # noqa: ARG001 - of the face of effects
    return twist


def in_turn(share):
    """Ice for a share of every minute."""
    return lambda t: np.where(t % 60.0 < 60.0 * share, "ice", "mud")


@pytest.fixture(scope="module")
def calibrate(make_scene):
    def run(effect, share=0.5, given=None):
        scene = make_scene(700, effect, duration_s=160.0, top_m_s=0.5, terrain=in_turn(share))
        known = calibrated([scene], Icr(), scene.run.robot, CONFIG, given)
        return known, by_terrain(known, [scene], CONFIG)

    return run


@pytest.fixture(scope="module")
def unlike(calibrate):
    return calibrate(turning_less)


def test_each_terrain_has_its_own_icrs_where_they_differ(unlike):
    """Within 4 standard deviations of the true ones of mud, and of those times 1.4 on ice."""
    _, split = unlike
    assert isinstance(split.base.model, IcrByTerrain)
    sigmas = np.sqrt(np.diag(np.linalg.inv(split.information)))
    found = dict(zip(split.uncertain.names, split.uncertain.values, strict=True))
    own = dict(zip(split.uncertain.names, sigmas, strict=True))
    first, other = split.base.model.labels
    factors = {"ice": WIDER, "mud": 1.0}
    for suffix, label in (("", first), (f"_{other}", other)):
        width = found[f"y_left{suffix}"] - found[f"y_right{suffix}"]
        reach = 4 * np.hypot(own[f"y_left{suffix}"], own[f"y_right{suffix}"])
        assert width == pytest.approx(0.87 * factors[label], abs=reach)
        assert reach < 0.1


def test_the_difference_of_terrains_is_no_noise(unlike):
    one_set, split = unlike
    assert split.noise.wander_rad < one_set.noise.wander_rad / 3


def test_a_base_that_is_alike_on_all_terrains_stays_one_set(calibrate):
    known, kept = calibrate(alike)
    assert kept is known


def test_a_terrain_that_the_runs_hardly_cover_has_none_of_its_own(calibrate):
    known, kept = calibrate(turning_less, share=0.1)
    assert kept is known


def test_values_that_are_given_are_kept(calibrate, unlike):
    _, split = unlike
    given = dict(zip((p.name for p in Icr.parameters), split.base.values[:5].tolist(), strict=True))
    known, kept = calibrate(turning_less, given=given)
    assert kept is known


def test_labels_in_order_of_their_time(make_scene):
    scene = make_scene(701, alike, terrain=in_turn(0.4))
    assert labels_covered([scene]) == ("mud", "ice")
    nothing = replace(scene, inputs=replace(scene.inputs, terrain=None))
    assert labels_covered([nothing]) == ()
