"""What a fault is: how it is drawn, what is true of it, and which answers are right."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np


class UnsuitableError(Exception):
    """This recording has no place where the fault would matter: take another one."""


@dataclass(frozen=True)
class Fault:
    """A fault of a recording.

    Attributes
    ----------
    key : str
    level : str
        Mildest level that is right: refused, warning or note.
    truth : str
        The cause, in one sentence.
    words : tuple of str
        Alternatives. An alternative is right when each of its words begins a word of the cause,
        or of what was found where the word is marked by @ (a word is a regular expression;
        capitals do not matter).
    draw : callable
        Recording and Generator to the faulty Recording.
    needs : frozenset of str
        What the recording must have (`bases.traits`).
    equal : tuple of str
        Faults that nothing in the files distinguishes from this one.
    named : bool
        The issue names it.
    harmless : bool
        A warning would be wrong: the check repairs it.
    """

    key: str
    level: str
    truth: str
    words: tuple[str, ...]
    draw: Callable
    needs: frozenset[str] = frozenset()
    equal: tuple[str, ...] = ()
    named: bool = False
    harmless: bool = False


def either(*groups):
    """Alternatives of one word of each group."""
    return tuple(" ".join(words) for words in product(*groups))


def about(subjects, words):
    """Alternatives of one word, of a cause about one of the subjects."""
    return either([f"@{subject}" for subject in subjects], words)


def says(seen, cause, words):
    """Whether a cause has all the words of at least one alternative."""

    def has(word):
        text = f"{seen} {cause}" if word.startswith("@") else cause
        return re.search(rf"(?<![a-z0-9]){word.removeprefix('@')}", text.lower())

    return any(all(has(word) for word in alternative.split()) for alternative in words)


def pick_stretch(rng, stamps_s, shares, starts, suits):
    """Rows (mask) of a stretch at random that suits.

    `shares` bounds its part of the whole, `starts` the part of the whole where it begins.
    """
    first, length = stamps_s[0], stamps_s[-1] - stamps_s[0]
    for _ in range(300):
        start = first + length * rng.uniform(*starts)
        mask = (stamps_s >= start) & (stamps_s < start + length * rng.uniform(*shares))
        if mask.sum() > 2 and suits(mask):
            return mask
    raise UnsuitableError


def held(stamps_s, known_s, values):
    """Values at the last stamp known before each stamp."""
    rows = np.searchsorted(known_s, stamps_s, side="right") - 1
    return values[np.clip(rows, 0, len(known_s) - 1)]


def integral(stamps_s, values):
    """Integral up to each stamp of values that hold until the next."""
    return np.r_[0.0, np.cumsum(values[:-1] * np.diff(stamps_s))]


def gyro_bias(recording):
    """What the gyroscope of odometry.csv turns too much on average, by the poses [rad/s]."""
    table, pose = recording["odometry"], recording["pose"]
    turned = np.interp(pose["t"][[0, -1]], table["t"], integral(table["t"], table["gyro_z"]))
    yaw = np.unwrap(pose["yaw"])[[0, -1]]
    return float((np.diff(turned) - np.diff(yaw))[0] / np.ptp(pose["t"]))


def distance(table, mask):
    """Wheel travel [m] of the rows of a mask, and its turning of treads (difference) [m]."""
    steps = np.diff(table["t"], append=table["t"][-1])[mask]
    left, right = table["v_left"][mask], table["v_right"][mask]
    return (np.abs(left) + np.abs(right)) @ steps / 2, np.abs(right - left) @ steps
