"""Turns of the treads that something else explains far better: a scale of one side that changes.

From a moment on (a tyre goes flat), backwards, or by a constant at slow speeds (a dead zone).
"""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.treads.turns_by_treads import Turns, turns_by_treads

MOMENTS = np.linspace(0.1, 0.9, 17)  # shares of the time at which a scale is asked to change
LEAST_OF_EACH = 10  # windows in which a tread runs backwards
# Of the squares that the treads leave of the turns of 75 real recordings as they are, a change of
# one side, backwards or from a moment on, leaves 0.75 and more where it explains 0.95 of the turns,
# and a constant at slow speeds 0.71; 0.04 to 0.5 where there was such a change in simulated ones.
HALF, EXPLAINED = 0.5, 0.95
ALONE = 0.7  # of what the same change of both sides, or of a bias of the gyroscope, leaves
# Where scales of each part of the drive leave less than this share of what one change leaves, the
# scales go with the terrain. They left 0.1 to 0.5 of it on drives across terrains that reversed on
# one of them, or came back to one.
FAR_BETTER = 0.5
CHANGED = 0.1  # of the scale of that side, that changes at least
LEAST_SPEED = 0.02  # of the ordinary fastest speed, of the constant
AS_WELL = 1.2  # times what two scales leave, that one scale and a constant leave


@once
def side_changes(evidence: Evidence) -> str:
    """Words where a scale that changes explains the turns far better; "" elsewhere."""
    turns = turns_by_treads(evidence)
    if turns is None:
        return ""
    found = [*_changes(evidence, turns), *_slow(evidence, turns)]
    left, words = min(found, default=(np.inf, ""))
    if left * turns.share >= 1 - EXPLAINED or turns.left_by_parts() < FAR_BETTER * left:
        return ""
    return words


def constant_as_well(evidence: Evidence) -> str:
    """Words where both sides may have one scale, and one reads a constant less as it moves."""
    turns = turns_by_treads(evidence)
    if turns is None:
        return ""
    constants_s = turns.constants_s(evidence.fastest_m_s)
    side = int(np.argmin([turns.left_by_one_scale(of) for of in constants_s]))
    if turns.left_by_one_scale(constants_s[side]) > AS_WELL:
        return ""
    return (
        "one scale of both explains the turns as well, with a constant by which the "
        f"{('left', 'right')[side]} tread reads too little, or too much, while it moves (a dead "
        "zone: slow speeds read zero)"
    )


def _changes(evidence: Evidence, turns: Turns) -> Iterator[tuple[float, str]]:
    """What is left by a scale of one side that changes, and words."""
    begin_s, end_s = turns.start_s[[0, -1]]
    for share in MOMENTS:
        at_s = float(begin_s + share * (end_s - begin_s))
        after = turns.start_s >= at_s
        when = f"from about {evidence.run_time_s(at_s):.0f} s on"
        yield from _of_one_side(turns, (after, after, after), when, "before")
    mean_m = turns.left_m + turns.right_m
    backwards = turns.left_m < 0, turns.right_m < 0, mean_m < 0
    yield from _of_one_side(turns, backwards, "backwards", "forwards")


def _of_one_side(
    turns: Turns, rows: tuple[BoolArray, BoolArray, BoolArray], when: str, otherwise: str
) -> Iterator[tuple[float, str]]:
    changing_m = [
        np.where(rows[side], way_m, 0.0) for side, way_m in enumerate((turns.left_m, turns.right_m))
    ]
    of_each, _ = turns.fit(turns.left_m, turns.right_m, turns.lasts_s, *changing_m)
    if HALF < of_each < np.inf:
        return  # one of them leaves more
    for side in range(2):
        if rows[side].sum() < LEAST_OF_EACH:
            continue
        left, of = turns.left_by(changing_m[side])
        change = float(of[3] / of[side])
        if left > HALF or abs(change) < CHANGED:
            continue
        both, _ = turns.left_by(np.where(rows[2], turns.right_m - turns.left_m, 0.0))
        bias, _ = turns.left_by(np.where(rows[side], turns.lasts_s, 0.0))
        if left < ALONE * min(both, bias):
            yield (
                left,
                f"a metre of the {('left', 'right')[side]} tread turns the robot {1 + change:.2f} "
                f"times as much {when} as {otherwise}, one of the other tread as much",
            )


def _slow(evidence: Evidence, turns: Turns) -> Iterator[tuple[float, str]]:
    """What is left by a constant that one tread, or both, read too little while they move."""
    constants_s = turns.constants_s(evidence.fastest_m_s)
    alone = [turns.left_by(of) for of in constants_s]
    both, of_both = turns.left_by(constants_s[1] - constants_s[0])
    least_m_s = LEAST_SPEED * evidence.fastest_m_s
    for side, (left, of) in enumerate(alone):
        less_m_s = float(of[3] / of[side])
        if left < HALF and left < ALONE * min(alone[1 - side][0], both) and less_m_s > least_m_s:
            yield left, _too_little(f"the {('left', 'right')[side]} tread reads", less_m_s)
    less_m_s = float(of_both[3] / of_both[1])
    if both < HALF and less_m_s > least_m_s:
        yield both, _too_little("both treads read", less_m_s)


def _too_little(reads: str, speed_m_s: float) -> str:
    return (
        f"{reads} about {speed_m_s:.2g} m/s too little while moving, as where slow speeds read "
        "zero (a dead zone)"
    )
