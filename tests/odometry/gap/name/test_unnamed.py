"""Smooth functions in the place of names: which of them may be each run's own."""

from dataclasses import replace

import numpy as np

from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.history import History
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import ranked
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.unnamed import last_of_each_run
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import floor_of

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
