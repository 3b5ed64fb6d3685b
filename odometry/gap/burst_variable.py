"""Whether events of an effect in bursts are just where a recorded variable is large or small.

Such an effect does not come and go by itself: a limit of a drive acts whenever the speed is high.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from sklearn.metrics import roc_auc_score

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.base_model import Base
from odometry.effects.residual import ANGLES, OF_TREADS, variables_of
from odometry.effects.time_course import InBursts
from odometry.windows.dense import DenseWindows


def variable_of_events(
    course: InBursts, scenes: Sequence[DenseWindows], base: Base
) -> tuple[str, float]:
    """The variable that tells best when the events are, and how well.

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
        "is small", by time: 0.5 to 1; 0.5 tells nothing.
    """
    inside = np.concatenate([course.share(np.empty(0), one.inputs) for one in scenes]) > 0.5
    steps_s = np.concatenate([one.steps_s for one in scenes])
    if inside.all() or not inside.any():
        return "", 0.5
    areas = [(_area(inside, v, steps_s), name) for name, v in _variables(scenes, base)]
    area, name = max(areas, key=lambda one: one[0])
    return name, area


def _variables(scenes: Sequence[DenseWindows], base: Base) -> Iterator[tuple[str, FloatArray]]:
    """Of all runs (N,), where all have them; of each tread by itself; with sign and without.

    Angles come round again: neither large nor small says anything of them.
    """
    of_scenes = [variables_of(s.inputs, base.model.twist(base.values, s.inputs)) for s in scenes]
    for name in of_scenes[0]:
        if name in ANGLES or not all(name in other for other in of_scenes):
            continue
        values = np.concatenate([of[name] for of in of_scenes])
        for each in values.T if name in OF_TREADS else (values,):
            yield from ((name, each), (name, np.abs(each)))


def _area(inside: BoolArray, values: FloatArray, steps_s: FloatArray) -> float:
    area = float(roc_auc_score(inside, values, sample_weight=steps_s))
    return max(area, 1.0 - area)
