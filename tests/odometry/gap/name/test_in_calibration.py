"""What the calibration runs have as well is not offered as missing on the measured ones."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.late_by_chance import LateByChance
from odometry.effects.motion.contact_effects import SlopeByContact
from odometry.gap.config import GapConfig
from odometry.gap.name.candidates import quick_effects
from odometry.gap.name.in_calibration import (
    _pays,
    in_calibration,
    is_new,
    spoils_calibration,
)
from odometry.gap.prepare.scenes import scene_of
from tests.odometry.gap.name.test_further import searched

CONFIG = GapConfig()
LATE = LateByChance()


def by_chance(scene, most_s, seed=5):
    """The same run with poses stamped when they arrived, by up to so much later."""
    pose = scene.run.pose
    late_s = most_s * np.random.default_rng(seed).random(len(pose))
    stamps_s = np.maximum.accumulate(pose.stamps_s + late_s) + 1e-6 * np.arange(len(pose))
    run = replace(scene.run, pose=replace(pose, columns={**pose.columns, "t": stamps_s}))
    return scene_of(run, CONFIG)


def thinned(scene):
    """The same run with half of its poses, at random."""
    chosen = np.random.default_rng(7).random(len(scene.run.pose)) < 0.5
    return scene_of(replace(scene.run, pose=scene.run.pose.rows(np.flatnonzero(chosen))), CONFIG)


@pytest.fixture(scope="module")
def measured(make_scene):
    return by_chance(make_scene(3, duration_s=60.0), 0.09)


@pytest.fixture(scope="module")
def known_late(known):
    """A calibration whose poses are stamped so, too."""
    kept = tuple((base, by_chance(scene, 0.09)) for base, scene in known.held_back)
    return replace(known, held_back=kept)


def forms(scenes, calibration):
    return {effect.form for effect in quick_effects(scenes, calibration)}


def test_late_stamps_are_missing_where_the_calibration_has_none(measured, known):
    assert not in_calibration(LATE, [measured], known)
    assert LATE.form in forms([measured], known)


def test_they_are_not_where_it_has_them_as_well(measured, known_late):
    assert in_calibration(LATE, [measured], known_late)
    assert LATE.form not in forms([measured], known_late)


def test_stamps_that_are_off_by_much_more_are(known, measured):
    kept = tuple((base, by_chance(scene, 0.03)) for base, scene in known.held_back)
    assert not in_calibration(LATE, [measured], replace(known, held_back=kept))


def test_poses_that_were_measured_unevenly_are_not_late(known, make_scene):
    """Uneven stamps that are right gain nothing by even ones."""
    kept = tuple((base, thinned(scene)) for base, scene in known.held_back)
    measured = thinned(make_scene(3, duration_s=60.0))
    assert not in_calibration(LATE, [measured], replace(known, held_back=kept))


def test_other_effects_may_always_be_missing(measured, known_late):
    assert not in_calibration(WheelScale(), [measured], known_late)


def half_late(scene, seed=0):
    """One of two poses, at random, stamped later by chance by about as much as that is uneven."""
    first = np.arange(0, len(scene.run.pose) - 1, 2)
    chosen = first + np.random.default_rng(seed).integers(2, size=len(first))
    run = replace(scene.run, pose=scene.run.pose.rows(chosen))
    return by_chance(replace(scene, run=run), 0.3, seed)


def test_they_are_not_where_half_of_the_unevenness_is_theirs(known, make_scene):
    """Poses that were measured unevenly and stamped late by chance: stamps show more than that."""
    kept = tuple((base, half_late(scene)) for base, scene in known.held_back)
    known = replace(known, held_back=kept)
    assert not _pays(Added(LATE, np.array(LATE.always)), known)
    assert in_calibration(LATE, [half_late(make_scene(3, duration_s=60.0))], known)


@pytest.fixture
def known_small(known):
    """A calibration in whose runs wheels are 0.95 times as large as its bases say, too."""
    larger = np.array([1.0, 1.0, 1.0, 1 / 0.95, 1 / 0.95])
    kept = tuple(
        (replace(base, values=base.values * larger), scene) for base, scene in known.held_back
    )
    return replace(known, held_back=kept)


@pytest.mark.parametrize(("scale", "new"), [(0.95, False), (0.88, True), (1.05, True)])
def test_a_name_is_new_that_the_calibration_does_not_show_as_much(known, known_small, scale, new):
    wheels = Added(WheelScale(), np.full(2, scale))
    assert is_new(wheels, known, CONFIG) == ""
    assert (is_new(wheels, known_small, CONFIG) == "") == new


@pytest.mark.parametrize(("gain", "new"), [(1e-10, True), (0.3, True), (3.0, False)])
def test_what_the_calibration_hardly_does_it_does_not_show(known, monkeypatch, gain, new):
    """A dead zone below all of its speeds gains what rounding leaves, in each stretch."""
    gains = [np.full(12, gain), np.full(12, gain / 2)]
    monkeypatch.setattr("odometry.gap.name.in_calibration._all_gains", lambda *_: gains.pop(0))
    assert (is_new(Added(WheelScale(), np.full(2, 0.95)), known, CONFIG) == "") == new


def test_a_name_that_the_calibration_shows_as_much_does_not_stand(known, known_small, make_scene):
    runs = [make_scene(seed, lambda _, twist: 0.95 * twist) for seed in (5, 6)]
    for calibration, reason in ((known, ""), (known_small, "the calibration runs show as much")):
        search, found = searched(calibration, *runs, WheelScale())
        assert search._fails(found)[:33] == reason


@pytest.mark.parametrize(("gain", "spoils"), [(0.01, True), (1e6, False)])
def test_an_effect_of_every_drive_spoils_a_calibration_that_does_not_show_it(
    known, known_small, gain, spoils
):
    """Unless it loses little there of what it gains, or the calibration runs do show it."""
    wheels = Added(WheelScale(), np.full(2, 0.95))
    assert bool(spoils_calibration(wheels, gain, known, CONFIG)) == spoils
    assert spoils_calibration(wheels, gain, known_small, CONFIG) == ""


def test_level_calibration_runs_say_nothing_of_a_slope(known, monkeypatch):
    """What noise of roll and pitch makes of one is not what they would show."""
    lost = "odometry.gap.name.in_calibration._all_gains"
    monkeypatch.setattr(lost, lambda *_: np.full(12, -100.0))
    slope = Added(SlopeByContact(), np.array([0.0, 0.0, 0.5, 0.5, 0.02]))
    assert spoils_calibration(slope, 0.01, known, CONFIG) == ""
