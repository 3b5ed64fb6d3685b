"""Terrain by feel of a run as sentences."""

from collections.abc import Iterator

import numpy as np

from odometry.feel.follow import NOT_MEASURED, SILENT, STATIONARY, Felt
from odometry.run import UNKNOWN

UNLIKE_SHARE = 0.5  # of the windows: a run with more that are unknown is unlike those of the model
OFTEN = 0.05  # share of the windows from which a sentence is written


def sentences(felt: Felt) -> tuple[str, ...]:
    """The answer for the run, then what is to be known of it."""
    return (answer_words(felt), *_more(felt))


def shares(felt: Felt) -> dict[str, float]:
    """Share of the windows of each answer over the last stretch, the largest first."""
    names, counts = np.unique(felt.lasting_answers.astype(str), return_counts=True)
    found = dict(zip(names.tolist(), (counts / counts.sum()).tolist(), strict=True))
    return dict(sorted(found.items(), key=lambda one: -one[1]))


def answer_words(felt: Felt) -> str:
    """How much of the time feels like what."""
    said = ", ".join(f"{name} {100 * share:.0f} %" for name, share in shares(felt).items())
    return f"Of the time: {said}."


def is_unlike(felt: Felt) -> bool:
    """Whether most of the windows in which the robot moves are like no terrain of the model."""
    moving = felt.windows.felt
    return bool(moving.any() and (felt.answers[moving] == UNKNOWN).mean() > UNLIKE_SHARE)


def _more(felt: Felt) -> Iterator[str]:
    moving = felt.windows.felt
    if not moving.any():
        yield "The robot stands, or nothing was measured, all the time: nothing can be felt."
        return
    probabilities, novel = felt.of_run
    best = max(probabilities, key=lambda name: probabilities[name])
    if is_unlike(felt):
        share = (felt.answers[moving] == UNKNOWN).mean()
        farthest = ", ".join(felt.model.farthest_columns(felt.windows))
        yield (
            f"{100 * share:.0f} % of the windows feel like nothing that the model was identified "
            f"from; the farthest off are {farthest}: another terrain, load, tyre or sensor?"
        )
    elif not novel and set(felt.lasting_answers.tolist()) <= {best, UNKNOWN, *SILENT}:
        yield f"If it is all one terrain, it is {best} with probability {probabilities[best]:.2f}."
    outside = felt.outside_speeds[moving].mean()
    if outside > OFTEN:
        limits = felt.model.limits
        yield (
            f"{100 * outside:.0f} % of the windows are driven at speeds that the model does not "
            f"know ({limits.slowest_m_s:.2f} to {limits.fastest_m_s:.2f} m/s): unknown."
        )
    for name, word in ((STATIONARY, "the robot stands"), (NOT_MEASURED, "samples are missing")):
        share = (felt.answers == name).mean()
        if share > OFTEN:
            yield f"In {100 * share:.0f} % of the windows {word}."
    if felt.model.members.logistic is None:
        yield (
            "The model is of an older version, which hardly distinguishes terrains that it does "
            "not know: identify it again."
        )
    robot = felt.run.robot.name
    if robot and felt.model.robot and robot != felt.model.robot:
        yield f"The model is of {felt.model.robot!r}, the run of {robot!r}: be wary of the answers."
