"""Whether the wheels of a side agree, so that their mean is the speed of the tread."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.bags.wheels.wheel_source import WheelSource
from odometry.errors import BagError

SPAN_NS = 500_000_000  # over which speeds are averaged: single ticks of an encoder do not count
MOST_SPANS = 8192  # an hour; of longer recordings every second span is left out, again and again
LEAST_SPANS = 20  # with motion, ten seconds: fewer say nothing
MOVES_M_S, STILL_M_S = 0.1, 0.01  # a tread surely moves; a wheel does not
DEAD_SHARE = 0.1  # of the spans in which its neighbours move and it does not: it broke on the way
AGAINST_SHARE = 0.8  # of the spans in which two wheels turn against one another
# Wheels of a side that slip by another share, or wear, differ by less; a gear, a unit or the
# ticks of an encoder by more
SCALED = 1.3
CLEAR = 1.5  # the misfit of the odd one of two wheels, against that of the other
RELATED = 0.5  # correlation of two wheels that slip, at least
HELD_SPANS = 10  # five seconds with one value, in which others of the side change
SAME_M_S = 1e-9
CHANGES_M_S, CHANGES, HELD_SHARE = 0.15, 0.5, 0.2  # apart, by so much of the value, so often


@dataclass(frozen=True)
class Contradiction:
    """Wheels of a side that contradict each other.

    Attributes
    ----------
    wheel : str
        The odd one, or the likelier of two.
    broken : bool
        Whether no mean with it can be right: it is dead, or turns against the others.
    cause : str
    """

    wheel: str
    broken: bool
    cause: str


class SideAgreement:
    """Gathers speeds of single wheels; memory does not grow with their number."""

    def __init__(self, source: WheelSource) -> None:
        self._source = source
        self._spans: list[FloatArray] = []
        self._every = 1

    def add(self, stamps_ns: IntArray, wheels_m_s: FloatArray) -> None:
        """Take in speeds (N, k) of the left and then the right wheels."""
        whole = np.isfinite(wheels_m_s).all(axis=1)
        if not whole.any():
            return
        numbers, begins = np.unique(stamps_ns[whole] // SPAN_NS, return_index=True)
        counts = np.diff(begins, append=np.count_nonzero(whole))
        means = np.add.reduceat(wheels_m_s[whole], begins) / counts[:, None]
        self._spans.append(means[numbers % self._every == 0])
        if sum(map(len, self._spans)) > MOST_SPANS:
            self._spans = [np.concatenate(self._spans)[::2]]
            self._every *= 2

    def contradictions(self) -> list[Contradiction]:
        """What contradicts; empty where the wheels of each side agree, or hardly moved."""
        if not self._spans:
            return []
        speeds, count = np.concatenate(self._spans), len(self._source.left)
        left, right = speeds[:, :count], speeds[:, count:]
        return [
            *_of_side(self._source.left, left, right),
            *_of_side(self._source.right, right, left),
        ]

    def verdict(self) -> list[str]:
        """What is to be said of wheels that contradict each other.

        Raises
        ------
        BagError
            If their mean cannot be right, or these are wheels that the user did not state.
        """
        found = self.contradictions()
        if not found:
            return []
        said = (
            f"wheels of a side contradict each other: {'; '.join(one.cause for one in found)}. "
            f"Leave the odd one out: {self._without(found)}"
        )
        if self._source.stated and not any(one.broken for one in found):
            return [f"warning: {said}"]
        raise BagError(f"{self._source.topic}: {said}")

    def _without(self, found: list[Contradiction]) -> str:
        """The options that leave the odd wheels out."""
        odd = {one.wheel for one in found}
        sides = {"left": self._source.left, "right": self._source.right}
        kept = {side: [w for w in wheels if w not in odd] for side, wheels in sides.items()}
        return " ".join(f"--{side} {','.join(wheels)}" for side, wheels in kept.items())


def _of_side(
    names: tuple[str, ...], speeds: FloatArray, other_side: FloatArray
) -> Iterator[Contradiction]:
    """Contradictions of a side; the other side tells which of two wheels is the odd one."""
    alive = []
    held = [_held(speeds[:, k], np.delete(speeds, k, axis=1)) for k in range(len(names))]
    for place, name in enumerate(names):
        others = np.delete(speeds, place, axis=1)
        fastest = np.abs(others).max(axis=1, initial=0)
        moves = fastest > MOVES_M_S
        still = np.abs(speeds[moves, place]) < STILL_M_S
        if len(still) >= LEAST_SPANS and np.mean(still) >= DEAD_SHARE:
            yield Contradiction(
                name,
                True,
                f"{name} stays at zero in {100 * np.mean(still):.0f} % of the time in which the "
                f"others of its side move (up to {fastest.max():.2f} m/s): its encoder is dead, or "
                "its number is not filled in",
            )
        elif held[place] > 0 and held[place] == max(held):
            yield Contradiction(
                name,
                True,
                f"{name} keeps one speed to the last digit in {100 * held[place]:.2g} % of the "
                "time while the others of its side change: its last value goes on",
            )
        else:
            alive.append(place)
    if len(alive) > 2:
        middle = np.median(speeds[:, alive], axis=1)
        for place in alive:
            yield from _of_pair((names[place], "the others of its side"), speeds[:, place], middle)
    elif len(alive) == 2:
        odd = _odd_of_two(speeds[:, alive], other_side)
        first, second = alive if odd != 0 else alive[::-1]
        for one in _of_pair((names[second], names[first]), speeds[:, second], speeds[:, first]):
            how = "or the other way round"
            if odd is not None:
                how = "by the other side, if the robot drives ahead more than it turns on the spot"
            yield replace(one, cause=f"{one.cause} ({how})")


def _held(wheel: FloatArray, others: FloatArray) -> float:
    """In which share of the time a wheel (N,) kept one speed while others (N, k) had another."""
    if not others.shape[1]:
        return 0.0
    ends = np.flatnonzero(np.abs(np.diff(wheel)) > SAME_M_S) + 1
    held = 0
    for begin, end in pairwise([0, *ends.tolist(), len(wheel)]):
        if end - begin < HELD_SPANS or abs(wheel[begin]) < STILL_M_S:
            continue
        apart = np.abs(others[begin:end] - wheel[begin]).max(axis=1)
        if np.mean(apart > max(CHANGES_M_S, CHANGES * abs(wheel[begin]))) > HELD_SHARE:
            held += end - begin
    return held / len(wheel)


def _of_pair(names: tuple[str, str], odd: FloatArray, other: FloatArray) -> Iterator[Contradiction]:
    """What contradicts between a wheel and another; the first is named as the odd one."""
    moves = (np.abs(other) > MOVES_M_S) & (np.abs(odd) > STILL_M_S)
    if np.count_nonzero(moves) < LEAST_SPANS:
        return
    one, two = odd[moves], other[moves]
    ratio = float(np.median(np.abs(one) / np.abs(two)))
    related = float(np.sum(one * two) / np.sqrt(np.sum(one**2) * np.sum(two**2)))
    if np.mean(one * two < 0) >= AGAINST_SHARE:
        cause = f"{names[0]} turns against {names[1]} all the time: it counts backwards"
        yield Contradiction(names[0], True, cause)
    elif not 1 / SCALED < ratio < SCALED:
        cause = f"{names[0]} turns {ratio:.2f} times as fast as {names[1]}: a unit, gear or encoder"
        yield Contradiction(names[0], False, cause)
    elif related < RELATED:
        cause = f"{names[0]} has little to do with {names[1]} (correlation {related:.2f})"
        yield Contradiction(names[0], False, cause)


def _odd_of_two(pair: FloatArray, other_side: FloatArray) -> int | None:
    """Which of two wheels (N, 2) fits the other side worse; None where that is unclear."""
    moves = np.abs(other_side).max(axis=1) > MOVES_M_S
    if np.count_nonzero(moves) < LEAST_SPANS:
        return None
    ahead = np.sign(other_side[moves].sum(axis=1))
    size = np.median(np.abs(other_side[moves]), axis=1)
    misfits = [float(np.median(np.abs(one[moves] * ahead - size))) for one in pair.T]
    if max(misfits) < CLEAR * min(misfits):
        return None
    return int(np.argmax(misfits))
