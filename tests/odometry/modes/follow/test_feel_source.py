"""Feel as a source of modes: a chain written out by hand, and made drives that shake by terrain."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.estimation.imm.markov import ModeChain
from odometry.feel.identify_feel import identify_feel
from odometry.feel.recorded.windows import STEPS
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.feel_source import FeelSource, feel_source, with_feel
from odometry.modes.follow.followed import followed
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.innovation_test import ModeFit
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.modes_config import ModesConfig
from tests.odometry.feel.feel_drives import TERRAINS, drive, drives, with_imu
from tests.odometry.modes.mode_examples import track

DWELL_S = np.array([20.0, 20.0])
NAMES = ("grates", "tiles")


def named(run, terrain):
    return replace(run, settings={**run.settings, "run": {"terrain": terrain}})


def turning_as_tiles(run, terrain):
    """The run with the yaw gain of tiles, and its own vibration."""
    t, left, right = run.odometry.stamps_s, run.odometry["v_left"], run.odometry["v_right"]
    missing = (TERRAINS["tiles"][4] - TERRAINS[terrain][4]) / 0.5

    def change(columns):
        turned = missing * np.interp(columns["t"], t, right - left)
        return columns | {"gyro_z": columns["gyro_z"] + turned}

    return with_imu(run, change)


@pytest.fixture(scope="module")
def model():
    return identify_feel(drives(NAMES, seconds=40.0))


@pytest.fixture(scope="module")
def alike_set():
    """Modes of two terrains that turn alike: motion cannot distinguish them."""
    runs = [
        named(turning_as_tiles(drive(terrain, seed, seconds=60.0), terrain), label)
        for seed, label in enumerate(NAMES)
        for terrain in NAMES
    ]
    return ModeSet(identify_velocity_modes(runs), DWELL_S)


def test_evidence_is_known_from_the_end_of_a_window_on():
    source = FeelSource(np.array([1.0, 1.05, 9.0]), np.array([[1.0, 0.0], [0.5, 0.0], [0.0, 1.0]]))
    rows = source.at(np.array([0.0, 0.9, 1.1, 2.0]))
    assert {row: of.tolist() for row, of in rows.items()} == {2: [1.5, 0.0]}


def test_feel_alone_is_a_hidden_markov_chain():
    """Two modes that change at 1/20 a second: written out for one window at 2 s."""
    source = FeelSource(np.array([2.0]), np.log([[0.8, 0.2]]))
    stamps_s = np.arange(6.0)
    found = source.alone(stamps_s, ModeChain(DWELL_S).transition, 0.0)
    kept = (1 + np.exp(-2 * 1.0 / 20.0)) / 2
    after = 0.8 * kept + 0.2 * (1 - kept)
    np.testing.assert_allclose(found[:, 0], [0.5, 0.5, 0.8, after, *found[4:, 0]])
    assert 0.5 < found[5, 0] < found[4, 0] < after


@pytest.mark.slow
def test_windows_are_worth_what_they_were_on_runs_held_out(model):
    run = drive("grates", 901)
    one, most = (
        feel_source(run, replace(model, calibration=replace(model.calibration, correlation=c)), *of)
        for c, of in ((0.0, (NAMES, DWELL_S)), (1.0, (NAMES, DWELL_S)))
    )
    lasting = DWELL_S[0] / model.design.window_s
    np.testing.assert_allclose(one.log_evidence, lasting * most.log_evidence)
    assert np.all(one.log_evidence <= 0)
    assert np.exp(STEPS * one.log_evidence).max() <= 1


def test_terrains_that_are_no_modes_say_nothing_of_any(model):
    """Feel names grates, which is no mode: tiles and a mode that it lacks stay equally probable."""
    run = drive("grates", 901)
    source = feel_source(run, model, ("tiles", "snow", "ice"), np.full(3, 20.0))
    assert np.ptp(source.log_evidence, axis=1).max() < 0.5
    np.testing.assert_allclose(source.log_evidence[:, 1], source.log_evidence[:, 2])


def test_modes_that_feel_does_not_know_are_refused(model):
    with pytest.raises(ParameterError, match="expected terrains in common"):
        feel_source(drive("grates", 901), model, ("ice", "mud"), DWELL_S)


def by_motion(probabilities, **others):
    known = track(["a"] * len(probabilities), ["a"] * len(probabilities))
    return replace(known, probabilities=np.array(probabilities), **others)


NEVER = FeelSource(np.array([0.0]), np.log([[0.6, 0.3, 0.1]]))  # of a chain that never changes


def with_that(motion):
    return with_feel(motion, NEVER, np.full(3, np.inf), ModesConfig(floor=0.0))


def test_probabilities_of_motion_and_feel_are_multiplied():
    both = with_that(by_motion([[0.5, 0.25, 0.25]]))
    product = np.array([0.3, 0.075, 0.025])
    np.testing.assert_allclose(both.probabilities, [product / product.sum()])
    np.testing.assert_allclose(both.felt, [[0.6, 0.3, 0.1]])


def test_what_motion_cannot_decide_is_left_to_feel():
    """b leads and is like a, of which feel says more; c is ruled out by motion."""
    alike = np.array([[True, False, False]])
    both = with_that(by_motion([[0.1, 0.9, 0.0]], alike=alike))
    np.testing.assert_allclose(both.probabilities, [[2 / 3, 1 / 3, 0.0]])
    assert both.alike is None


def test_motion_says_nothing_where_the_rolling_test_does_not_agree():
    logs = np.log([[0.3, 0.3, 0.399, 0.001], [0.7, 0.2, 0.099, 0.001]])
    fit = ModeFit(np.zeros((2, 3, 1)), np.zeros((2, 1)), logs)
    both = with_that(by_motion([[0.9, 0.05, 0.05]] * 2, fit=fit))
    np.testing.assert_allclose(both.probabilities[0], [0.6, 0.3, 0.1])
    assert both.probabilities[1, 0] > 0.9


@pytest.mark.parametrize("terrain", NAMES)
def test_feel_names_what_motion_cannot_distinguish(model, alike_set, terrain):
    run = turning_as_tiles(drive(terrain, 77, seconds=30.0), terrain)
    both = followed(run, alike_set, feel=model)
    late = both.motion.stamps_s > 8.0
    assert terrain not in set(both.answers(both.motion)[late])
    assert (named_modes(both.with_feel, 0.9)[late] == terrain).mean() > 0.9
    assert both.last_track is both.with_feel
