"""Tread speeds that are repeated where they change, and what the record says of them."""

from dataclasses import replace

import numpy as np

from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.further import further_candidates
from odometry.gap.prepare.measured import measured_of
from odometry.recording.repeated_speeds import between_new_values
from odometry.windows.dense.averaged import averaged_windows
from odometry.windows.dense.dense import dense_windows_of

CONFIG = GapConfig()


def test_between_new_values_speeds_are_drawn_straight():
    stamps_s = np.array([0.0, 0.1, 0.3, 0.4, 0.5])
    speeds = np.column_stack([[0.2, 0.2, 0.2, 0.6, 0.6], [0.0, 0.0, 0.0, 0.5, 0.4]])
    added = between_new_values(stamps_s, speeds)
    np.testing.assert_allclose(added[:, 0], [0.0, 0.1, 0.3, 0.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(added[:, 1], 0.0)  # it stood, and then nothing is repeated


def test_where_nothing_is_repeated_there_is_nothing():
    assert between_new_values(np.arange(3.0), np.arange(6.0).reshape(3, 2)) is None


def test_frames_that_are_lost_are_a_share_of_what_lies_between_new_ones(make_scene, known):
    """The left speed is repeated for a second in each three; all of it is added, of each sign."""
    run = make_scene(11, lambda _, twist: twist, duration_s=80.0).run
    speeds, stamps_s = run.odometry.columns["v_left"], run.odometry.stamps_s
    rows = np.where(stamps_s % 3 < 1, 0, np.arange(len(speeds)))
    columns = {**run.odometry.columns, "v_left": speeds[np.maximum.accumulate(rows)]}
    run = replace(run, odometry=replace(run.odometry, columns=columns))
    scene = averaged_windows(dense_windows_of(run, CONFIG.horizon_s)).numbered(0)
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    candidates = [
        one
        for one in further_candidates([scene], known.base, CONFIG)
        if one.variable == "tread_speed_repeated" and {part for part, _ in one.terms} == {"left"}
    ]
    (judged,) = judge(fitter, fitter.fit([]), candidates, CONFIG, lambda: None)
    (added,) = judged.fitted.effects
    largest = added.effect.knots[-1]
    np.testing.assert_allclose(added.values, [-largest, largest], rtol=0.15)
    assert judged.least > CONFIG.least_evidence
