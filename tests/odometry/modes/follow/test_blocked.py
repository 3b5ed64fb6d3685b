"""A robot that is blocked while its treads turn: that is no terrain."""

from dataclasses import replace

import numpy as np

from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set import NO_MODES
from tests.odometry.modes.mode_examples import run_of, velocity_set

HELD = slice(1000, 1400)


def test_no_mode_is_named_while_the_robot_is_blocked(rng):
    """One of the modes hardly turns: it would explain a robot that stands."""
    mode_set = velocity_set(turns=(0.05, 1.0))
    run = run_of(1.0, size=2000, rng=rng)
    before = named_modes(follow_modes(run, mode_set), 0.9)
    columns = dict(run.odometry.columns)
    for tread, speed in (("v_left", -0.4), ("v_right", 0.4)):
        columns[tread] = columns[tread].copy()
        columns[tread][HELD] = speed
    columns["gyro_z"] = columns["gyro_z"].copy()
    columns["gyro_z"][HELD] = 0.01 * rng.standard_normal(400)
    blocked = replace(run, odometry=replace(run.odometry, columns=columns))
    track = follow_modes(blocked, mode_set)
    answers = named_modes(track, 0.9)
    inside = slice(HELD.start + 20, HELD.stop - 20)
    assert set(answers[inside]) <= set(NO_MODES)
    assert track.probabilities[HELD.stop - 20, 0] < 0.6  # of ice: the stretch is no evidence
    np.testing.assert_array_equal(answers[: HELD.start - 20], before[: HELD.start - 20])
    assert set(answers[HELD.stop + 100 :]) <= {"tar", *NO_MODES}
    assert "tar" in set(answers[HELD.stop :])
