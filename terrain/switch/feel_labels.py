"""Terrain by feel as labels of the place under the robot."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.feel.labels.felt import FeltWindows
from odometry.feel.recorded.windows import STEPS
from odometry.recording.run import UNKNOWN
from terrain.switch.place_labels import PlaceLabel


class FeltPlaces(Protocol):
    """Terrain by feel as one more source of labels."""

    def between(
        self, after_s: float, upto_s: float, pose: FloatArray, travel_m: float
    ) -> Iterator[PlaceLabel]:
        """Labels of the windows that became known after one stamp and up to another."""

    def beside(self, seen: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of one image with those terrains added that only feel can name."""


@dataclass(frozen=True)
class FeelLabels:
    """Windows that do not overlap and have probabilities.

    Attributes
    ----------
    names : tuple of str
        Of the terrains of the model of feel.
    image_names : tuple of str
        Of the terrains that the camera can name.
    known_s : (N,)
    probabilities : (N, K)
        Of each terrain by one window, calibrated on held-out runs.
    """

    names: tuple[str, ...]
    image_names: tuple[str, ...]
    known_s: FloatArray
    probabilities: FloatArray

    @classmethod
    def of(cls, felt: FeltWindows, image_names: tuple[str, ...] = ()) -> "FeelLabels":
        """Windows that do not overlap; those that fit no terrain are none."""
        rows = evident(felt, np.arange(0, len(felt.windows), STEPS))
        return cls(felt.model.names, image_names, felt.stamps_s[rows], given_by(felt, rows))

    def between(
        self, after_s: float, upto_s: float, pose: FloatArray, travel_m: float
    ) -> Iterator[PlaceLabel]:
        """Labels of the windows that became known after one stamp and up to another.

        Parameters
        ----------
        after_s, upto_s : float
        pose : (3,)
            Of the robot in the odometry frame.
        travel_m : float
            Wheel travel of the run.
        """
        first, end = np.searchsorted(self.known_s, [after_s, upto_s], side="right")
        for row in range(int(first), int(end)):
            of = float(self.known_s[row]), self.probabilities[row]
            yield place_label((self.names, self.image_names), of, pose, travel_m)

    def beside(self, seen: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of one image with those terrains added that only feel can name."""
        return widened(seen, self.names) if seen else seen


def evident(felt: FeltWindows, rows: IntArray) -> IntArray:
    """Those of some windows in which the robot moves on a terrain that the model may know."""
    return np.asarray(rows[felt.windows.felt[rows] & (felt.answers[rows] != UNKNOWN)])


def given_by(felt: FeltWindows, rows: IntArray) -> FloatArray:
    """Probabilities of the terrains of the model (N, K) by some windows (N,)."""
    given = felt.probabilities[rows]
    return np.asarray(
        given + felt.unknown[rows, None] / given.shape[1]
    )  # of none: the same for all


def place_label(
    names: tuple[Sequence[str], tuple[str, ...]],
    of: tuple[float, FloatArray],
    pose: FloatArray,
    travel_m: float,
) -> PlaceLabel:
    """The label of the place under a robot.

    Parameters
    ----------
    names : (sequence of str, tuple of str)
        Of the terrains of the model of feel, and of those that the camera can name.
    of : (float, (K,))
        From when on a window is known, and what it gives to each terrain.
    pose : (3,)
        Of the robot in the odometry frame.
    travel_m : float
        Wheel travel of the run.
    """
    stamp_s, probabilities = of
    given = dict(zip(names[0], probabilities.tolist(), strict=True))
    label = max(given, key=lambda name: given[name])
    given = widened(given, names[1])
    return PlaceLabel(label, stamp_s, travel_m, pose[:2], 0.0, given, by_feel=True)


def widened(given: Mapping[str, float], names: tuple[str, ...]) -> dict[str, float]:
    """Probabilities with further terrains, without probabilities: these get the mean."""
    mean = sum(given.values()) / len(given)
    wider = {**given, **{name: mean for name in names if name not in given}}
    whole = sum(wider.values())
    return {name: one / whole for name, one in wider.items()}
