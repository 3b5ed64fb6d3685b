"""Smooth functions in the place of names: which of them may be each run's own."""

from dataclasses import replace

import numpy as np

from odometry.effects.corrected import Added
from odometry.effects.history import History
from odometry.gap.accepted_effects import Standing
from odometry.gap.config import GapConfig
from odometry.gap.contest import ranked
from odometry.gap.explanation import Explanation
from odometry.gap.fit import Fitter
from odometry.gap.measured import measured_of
from odometry.gap.statistic import floor_of
from odometry.gap.unnamed import last_of_each_run

CONFIG = GapConfig()


def test_weights_of_earlier_speeds_are_those_of_all_runs(make_scene, known):
    def same(_, twist):
        return twist

    scene = make_scene(4, same)
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    start = fitter.fit([])
    history = History()
    fit = replace(start, effects=(Added(history, np.full(len(history.terms), 0.01)),))
    floor = floor_of(known.held_back, CONFIG.part_s)
    search = Standing(fitter, start, (scene,), floor, floor, CONFIG, lambda: None)
    found = Explanation(start, tuple(ranked(fitter, start, [fit], CONFIG)), ())
    assert last_of_each_run(search, found) is None
