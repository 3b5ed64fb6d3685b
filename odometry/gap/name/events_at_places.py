"""Whether events that seem to come by themselves come where the robot is at certain places."""

from collections.abc import Sequence

import numpy as np
from sklearn.metrics import roc_auc_score

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.effects.interface.time_course import InBursts
from odometry.gap.config import GapConfig
from odometry.gap.name.places import finest_grid
from odometry.windows.dense.dense import DenseWindows

EVERY_S = 0.2
LEAST_S = 1.0  # of other visits, that say something of a place
DRAWS = 199
SEED = 0


def chance_of_places(course: InBursts, scenes: Sequence[DenseWindows], config: GapConfig) -> float:
    """Probability that events lie at the same places as well as they do by chance; 1 where unknown.

    What other visits of a node were like predicts each visit. The area under its curve (ROC) is
    compared with that of as many events of the same durations at any time.

    Parameters
    ----------
    course : InBursts
        Events of the first of the scenes.
    scenes : sequence of DenseWindows
    config : GapConfig
        Its grids.
    """
    scenes = scenes[: len(course.events_s)]
    if any(scene.inputs.position_m is None for scene in scenes):
        return 1.0
    rows = [_every(scene.time_s) for scene in scenes]
    inside = [
        course.share(np.empty(0), scene.inputs)[of] > 0.5
        for scene, of in zip(scenes, rows, strict=True)
    ]
    positions_m = np.concatenate(
        [np.asarray(s.inputs.position_m)[of] for s, of in zip(scenes, rows, strict=True)]
    )
    run = np.repeat(np.arange(len(rows)), [len(of) for of in rows])
    grids = [finest_grid(positions_m, most, config.least_spacing_m) for most in config.event_nodes]
    visits = [_Visits(grid.hats(positions_m).argmax(axis=1), run) for grid in grids if grid]
    if not visits:
        return 1.0
    return _share_as_large(visits, inside)


def _share_as_large(visits: "Sequence[_Visits]", inside: Sequence[BoolArray]) -> float:
    rng = np.random.default_rng(SEED)
    found = np.array([of.area(np.concatenate(inside)) for of in visits])
    drawn = np.empty((DRAWS, len(visits)))
    for draw in drawn:
        anywhere = np.concatenate([_anywhere(of, rng) for of in inside])
        draw[:] = [of.area(anywhere) for of in visits]
    centre, spread = drawn.mean(axis=0), np.maximum(drawn.std(axis=0), 1e-9)
    largest = ((drawn - centre) / spread).max(axis=1)
    return float((1 + np.sum(largest >= ((found - centre) / spread).max())) / (1 + DRAWS))


def _anywhere(inside: BoolArray, rng: np.random.Generator) -> BoolArray:
    """Events (N,) of the same durations, in a random order at random times."""
    ends = np.flatnonzero(np.diff(inside, prepend=False, append=False))
    durations = rng.permutation(ends[1::2] - ends[::2])
    free = len(inside) - int(durations.sum())
    gaps = np.diff(np.sort(rng.integers(free + 1, size=len(durations))), prepend=0)
    drawn = np.zeros(len(inside), dtype=np.bool_)
    begin = 0
    for gap, duration in zip(gaps, durations, strict=True):
        drawn[begin + gap : begin + gap + duration] = True
        begin += int(gap + duration)
    return drawn


class _Visits:
    """Samples (N,) by the node that they are nearest to, and the visit that they are part of."""

    def __init__(self, node: IntArray, run: IntArray) -> None:
        self.node = node
        self.visit = np.cumsum((np.diff(node, prepend=-1) != 0) | (np.diff(run, prepend=0) != 0))
        of_others = np.bincount(node)[node] - np.bincount(self.visit)[self.visit]
        self.known = of_others * EVERY_S >= LEAST_S
        self.of_others = np.maximum(of_others, 1)

    def area(self, inside: BoolArray) -> float:
        """Of "what other visits were like" for what is inside; 0.5 predicts nothing."""
        seen = inside[self.known]
        if not len(seen) or seen.all() or not seen.any():
            return 0.5
        total, of_visit = (np.bincount(of, weights=inside)[of] for of in (self.node, self.visit))
        return float(roc_auc_score(seen, ((total - of_visit) / self.of_others)[self.known]))


def _every(time_s: FloatArray) -> IntArray:
    at_s = np.arange(time_s[0], time_s[-1], EVERY_S)
    return np.searchsorted(time_s, at_s, side="right") - 1
