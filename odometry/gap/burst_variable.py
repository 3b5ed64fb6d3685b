"""Whether events of an effect in bursts are just where a recorded variable is large or small.

Such an effect does not come and go by itself: a limit of a drive acts whenever the speed is high.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.stats import binom
from sklearn.metrics import roc_auc_score

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base
from odometry.effects.residual import ANGLES, OF_TREADS, variables_of
from odometry.effects.time_course import InBursts
from odometry.windows.dense import DenseWindows

BY_CHANCE = 0.001  # probability of as many events on one terrain


def variable_of_events(
    course: InBursts, scenes: Sequence[DenseWindows], base: Base
) -> tuple[str, float]:
    """The variable that predicts best when the events are, and how well.

    Parameters
    ----------
    course : InBursts
        With an event or more that is not all of the runs.
    scenes : sequence of DenseWindows
        The runs of the events.
    base : Base
        Its twist gives the variables that were simulated.

    Returns
    -------
    name : str
    area : float
        Under the receiver operating characteristic of "the variable, or its size, is large" or
        "is small", by time: 0.5 to 1; 0.5 predicts nothing.
    """
    inside = np.concatenate([course.share(np.empty(0), one.inputs) for one in scenes]) > 0.5
    steps_s = np.concatenate([one.steps_s for one in scenes])
    if inside.all() or not inside.any():
        return "", 0.5
    areas = [(_area(inside, v, steps_s), name) for name, v in _variables(scenes, base)]
    areas.append((_area_of_terrain(course, scenes), "terrain"))
    area, name = max(areas, key=lambda one: one[0])
    return name, area


def _variables(scenes: Sequence[DenseWindows], base: Base) -> Iterator[tuple[str, FloatArray]]:
    """Of all runs (N,), where all have them; of each tread by itself; with sign and without.

    Angles are periodic: neither large nor small has a meaning.
    """
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    for name in of_scenes[0]:
        if name in ANGLES or not all(name in other for other in of_scenes):
            continue
        values = np.concatenate([of[name] for of in of_scenes])
        for each in values.T if name in OF_TREADS else (values,):
            yield from ((name, each), (name, np.abs(each)))


def _area_of_terrain(course: InBursts, scenes: Sequence[DenseWindows]) -> float:
    """0.5 + half the share of events on one terrain, less the share of time on it; 0.5 by chance.

    It says where events may be, not that there is one all the time.
    """
    events, times = [], []
    for spans, scene in zip(course.events_s, scenes, strict=False):
        if scene.inputs.terrain is None:
            return 0.5
        labels = np.asarray(scene.inputs.terrain).astype(str)
        at = np.searchsorted(scene.time_s, [sum(span) / 2 for span in spans], side="right") - 1
        events.append(labels[np.maximum(at, 0)])
        times.append(labels)
    happened, everywhere = np.concatenate(events), np.concatenate(times)
    steps_s = np.concatenate([scene.steps_s for scene in scenes[: len(times)]])
    areas = [0.5]
    for terrain in np.unique(everywhere):
        of_time = float(steps_s[everywhere == terrain].sum() / steps_s.sum())
        count = int(np.count_nonzero(happened == terrain))
        if of_time < 1 and binom.sf(count - 1, len(happened), of_time) < BY_CHANCE:
            areas.append(0.5 + (count / len(happened) - of_time) / (1 - of_time) / 2)
    return max(areas)


def _area(inside: BoolArray, values: FloatArray, steps_s: FloatArray) -> float:
    area = float(roc_auc_score(inside, values, sample_weight=steps_s))
    return max(area, 1.0 - area)
