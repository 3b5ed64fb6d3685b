from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import ConfigError, RunFolderError
from odometry.modes.follow.camera_prior import SeenTerrain
from odometry.modes.follow.track import ModesConfig, follow_modes, follow_signals, judged_signals
from odometry.modes.models import velocity
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import Signals
from tests.odometry.modes.mode_drives import (
    table,
    velocity_run,
)

NAMES = ("ice", "tar")
STEP_S, SIGMA = 0.02, 0.02
A = np.array([[[-5.0, 0.0], [0.0, -4.0]], [[-5.0, 0.0], [0.0, -6.0]]])
SETTLED = np.array([[[0.5, 0.5], [-0.8, 0.8]], [[0.5, 0.5], [-1.2, 1.2]]])
B = -A @ SETTLED
NOISE = np.full((2, 2), 1e-3), np.full((2, 2), SIGMA**2)
SET = ModeSet(VelocityModes(NAMES, A, B, *NOISE), np.full(2, 20.0))
CHANGE = 1000


@pytest.fixture(scope="module")
def run():
    """Ice, from 20 s on tar."""
    labels = np.repeat(NAMES, CHANGE).tolist()
    by_name = dict(zip(NAMES, A, strict=True)), dict(zip(NAMES, B, strict=True))
    return velocity_run(np.random.default_rng(3), *by_name, labels, sigmas=(SIGMA, SIGMA))


@pytest.fixture(scope="module")
def followed(run):
    """Its modes, as they are followed without any setting."""
    return follow_modes(run, SET)


def without_labels(run):
    columns = {name: column for name, column in run.odometry.columns.items() if name != "terrain"}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def test_a_change_of_terrain_is_recognised_within_seconds(followed):
    track = followed
    sure_of_tar = track.probabilities[:, 1] > 0.9
    assert np.flatnonzero(track.probabilities[:, 0] > 0.9)[0] * STEP_S < 2.0
    assert not sure_of_tar[:CHANGE].any()
    told = np.flatnonzero(sure_of_tar)[0]
    assert 0 < (told - CHANGE) * STEP_S < 2.0
    assert (track.probabilities[told:, 1] > 0.5).mean() > 0.95
    assert track.labels.tolist() == np.repeat(NAMES, CHANGE).tolist()


@pytest.mark.slow
def test_what_moves_in_a_gap_of_odometry_determines_nothing(run):
    """For 2 s on ice the speeds in force turn two thirds as much as the treads truly did."""
    signals = SET.modes.signals(run)
    gap = slice(500, 600)
    treads = signals.tread_speeds_m_s.copy()
    middle = treads[gap].mean(axis=1, keepdims=True)
    treads[gap] = middle + 2 / 3 * (treads[gap] - middle)
    lost = replace(signals, tread_speeds_m_s=treads)
    spans_s = signals.stamps_s[[[gap.start, gap.stop]]]
    naive, told = (
        follow_signals(one, SET).probabilities[:, 0]
        for one in (lost, replace(lost, gaps_s=spans_s))
    )
    assert naive[gap].min() < 0.01  # as if it were tar
    assert told[500:700].min() > 0.8  # less by what may have changed meanwhile
    changed = np.where(np.arange(2 * CHANGE)[:, None] // 100 == 5, 99.0, signals.measured)
    changed[gap.start] = signals.measured[gap.start]
    same = follow_signals(replace(lost, measured=changed, gaps_s=spans_s), SET)
    np.testing.assert_array_equal(same.probabilities[:, 0], told)


def test_probabilities_sum_to_one_and_keep_their_floor(run, followed):
    track = follow_modes(run, SET, ModesConfig(floor=0.01))
    np.testing.assert_allclose(track.probabilities.sum(axis=1), 1.0, atol=1e-12)
    assert track.probabilities.min() >= 0.01 * (1 - 1e-9)
    assert followed.probabilities.min() < 0.01


def test_errors_that_last_are_in_the_sigmas(run, followed):
    """All of the variance but the share of one measurement in the time that errors last."""
    modes = replace(SET.modes, errors_last_s=10 * STEP_S)
    lasting = follow_modes(run, replace(SET, modes=modes))
    added = (lasting.sigmas[:CHANGE] ** 2 - followed.sigmas[:CHANGE] ** 2)[:, :2]
    expected = 0.9 * modes.measurement_variance[0]  # but where modes are in doubt
    np.testing.assert_allclose(np.median(added, axis=0), expected, rtol=0.03)


def test_errors_that_last_are_those_of_the_probable_mode(run):
    """On tar, where errors are three times as large as on ice."""
    variances = SIGMA**2 * np.array([[1.0, 1.0], [9.0, 9.0]])
    modes = replace(SET.modes, measurement_variance=variances, errors_last_s=10 * STEP_S)
    track = follow_modes(run, replace(SET, modes=modes))
    on_tar = track.probabilities[:, 1] > 0.97
    assert on_tar.sum() > 100
    assert track.sigmas[on_tar, :2].min() ** 2 > 0.85 * 9.0 * SIGMA**2


def test_a_rough_stretch_says_less():
    """The same turn, named while the treads are steady and left open while they are not."""
    gains = np.zeros((2, 2, 3, 5))
    gains[:, :, 0, 0], gains[:, :, 2, 1] = 1.0, np.array([0.8, 0.7])[:, None]
    noise = np.array([1e-6, 1e-6, 1e-8]), np.array([1e-4, 1e-4, 1e-4, 0.02**2])
    t = STEP_S * np.arange(100)
    signals = Signals(
        t,
        np.column_stack([0.1 + t, 0.6 + t]),
        np.column_stack([np.full((100, 3), np.nan), np.full(100, 0.8)]),
        np.full(100, "steady", dtype=object),
    )
    signals.measured[:40, 3] = np.nan
    signals.measured[0, :3] = 0.0
    most = []
    for growth in (0.0, 1000.0):
        modes = TractionModes(NAMES, gains, np.zeros(2), 0.5, *noise, variance_growth=growth)
        track = follow_signals(signals, ModeSet(modes, np.full(2, 20.0)))
        most.append(track.probabilities[50, 0])
    assert most[0] > 0.99
    assert most[1] < 0.6


def test_far_above_the_speeds_of_identification_nothing_is_learned(run, followed):
    """Beyond 1.2 times the fastest run, as if it were not measured."""
    fastest_m_s = float(np.abs(run.odometry.stack("v_left", "v_right")).max())
    slower, equal = (
        follow_modes(run, replace(SET, modes=replace(SET.modes, fastest_m_s=of)))
        for of in (fastest_m_s / 10, fastest_m_s)
    )
    signals = judged_signals(run, SET)
    faster = np.abs(signals.tread_speeds_m_s).max(axis=1) > 1.2 * fastest_m_s / 10
    assert np.isnan(slower.normalised_squared[1:][faster[:-1]]).all()
    assert faster.mean() > 0.5
    np.testing.assert_array_equal(equal.probabilities, followed.probabilities)
    assert slower.probabilities.max() < equal.probabilities.max()


def test_the_same_input_gives_the_same_bits(run, followed):
    first, second = followed, follow_modes(run, SET)
    for name in ("probabilities", "means", "sigmas", "normalised_squared"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()


@pytest.mark.slow
def test_truth_and_labels_are_for_scoring_alone(run, followed):
    """Every row of the truth names the wrong ground, and holds to the next."""
    truth = table({"t": np.array([5.0, 20.0]), "terrain": np.array(["tar", "ice"])})
    bare = without_labels(run)
    for other, labels in (
        (bare, ["unknown"] * 2 * CHANGE),
        (replace(run, truth=truth), ["tar"] * CHANGE + ["ice"] * CHANGE),
        (replace(bare, truth=truth), ["tar"] * CHANGE + ["ice"] * CHANGE),
    ):
        track = follow_modes(other, SET)
        assert track.labels.tolist() == labels
        assert track.probabilities.tobytes() == followed.probabilities.tobytes()
        assert track.means.tobytes() == followed.means.tobytes()


def test_motion_overrides_labels_that_are_wrong(run):
    seen = [SeenTerrain(t, "tar", 0.9) for t in (0.0, 5.0, 10.0)]
    motion, both = (follow_modes(run, SET, seen=of).probabilities[:CHANGE, 0] for of in ((), seen))
    assert (both[400:] > 0.5).mean() > 0.9
    assert (both < motion).mean() > 0.95  # the gyroscope counts, though


def test_a_run_without_a_yaw_rate_is_refused(run):
    columns = {name: run.odometry[name] for name in ("t", "v_left", "v_right")}
    bare = replace(run, velocity=None, odometry=table(columns))
    with pytest.raises(RunFolderError, match="no yaw rate"):
        follow_modes(bare, SET)


def test_a_robot_of_another_width_is_refused(run):
    width = run.robot.track_width
    known = replace(SET, modes=replace(SET.modes, track_width=width * 1.05))
    assert len(judged_signals(run, known)) == len(judged_signals(run, SET))
    wider = replace(SET, modes=replace(SET.modes, track_width=width * 1.3))
    with pytest.raises(RunFolderError, match=r"track width 0\.5 m; the modes are of one of 0\.65"):
        judged_signals(run, wider)


@pytest.mark.slow
def test_errors_that_last_count_once(run, monkeypatch):
    """Measured each 0.02 s, one error for 0.2 s: a tenth of the log-odds. No mode is ever left.

    A bias would be learnt from all of them.
    """
    monkeypatch.setattr(velocity, "FIRST_SIGMAS", np.array([0.5, 0.5, 0.0]))
    monkeypatch.setattr(velocity, "BIAS_WALK_RAD2_S3", 0.0)
    odds = {}
    for lasts_s in (0.0, 0.01, 0.2):
        modes = replace(SET.modes, errors_last_s=lasts_s)
        track = follow_modes(run, ModeSet(modes, np.full(2, np.inf)), ModesConfig(floor=0.0))
        odds[lasts_s] = np.diff(np.log(track.probabilities[:100]), axis=1)[:, 0]
    assert np.abs(odds[0.0]).max() > 1.0
    np.testing.assert_allclose(odds[0.2], odds[0.0] / 10, atol=1e-9)
    np.testing.assert_allclose(odds[0.01], odds[0.0], atol=1e-9)


@pytest.mark.parametrize(
    "wrong",
    [
        {"floor": 0.5},
        {"sure": 0.5},
        {"sure": 1.0},
        {"most_doubt": 0.9},
        {"agreed": 1.0},
        {"lasting_s": 0},
        {"misfit_share": 0.0},
        {"turn_sigmas": 0.0},
        {"headings_share": -1.0},
    ],
)
def test_settings_that_cannot_be(wrong):
    with pytest.raises(ConfigError, match=f"{next(iter(wrong))} = "):
        ModesConfig(**wrong)
