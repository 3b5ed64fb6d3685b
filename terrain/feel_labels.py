"""Terrain by feel as labels of the place under the robot."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.feel.follow import Felt
from odometry.feel.windows import STEPS
from odometry.run import UNKNOWN
from terrain.place_labels import PlaceLabel


@dataclass(frozen=True)
class FeelLabels:
    """Windows that do not overlap and have probabilities.

    Attributes
    ----------
    names : tuple of str
        Of the terrains of the model of feel.
    image_names : tuple of str
        Of the terrains that the camera can name.
    ends_s : (N,)
    probabilities : (N, K)
        Of each terrain by one window, calibrated on held-out runs.
    """

    names: tuple[str, ...]
    image_names: tuple[str, ...]
    ends_s: FloatArray
    probabilities: FloatArray

    @classmethod
    def of(cls, felt: Felt, image_names: tuple[str, ...] = ()) -> "FeelLabels":
        """Windows that do not overlap; those that fit no terrain are none."""
        windows = felt.windows
        rows = np.arange(0, len(windows), STEPS)
        rows = rows[windows.felt[rows] & (felt.answers[rows] != UNKNOWN)]
        given = felt.probabilities[rows]
        given = given + felt.unknown[rows, None] / given.shape[1]  # of none: the same for all
        return cls(felt.model.names, image_names, felt.stamps_s[rows], given)

    def between(
        self, after_s: float, upto_s: float, pose: FloatArray, travel_m: float
    ) -> Iterator[PlaceLabel]:
        """Labels of the windows that ended after one stamp and up to another.

        Parameters
        ----------
        after_s, upto_s : float
        pose : (3,)
            Of the robot in the odometry frame.
        travel_m : float
            Wheel travel of the run.
        """
        first, end = np.searchsorted(self.ends_s, [after_s, upto_s], side="right")
        for row in range(int(first), int(end)):
            given = dict(zip(self.names, self.probabilities[row].tolist(), strict=True))
            yield PlaceLabel(
                max(given, key=lambda name: given[name]),
                float(self.ends_s[row]),
                travel_m,
                pose[:2],
                0.0,
                widened(given, self.image_names),
                by_feel=True,
            )

    def beside(self, seen: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of one image with those terrains added that only feel can name."""
        return widened(seen, self.names) if seen else seen


def widened(given: Mapping[str, float], names: tuple[str, ...]) -> dict[str, float]:
    """Probabilities with further terrains, without probabilities: these get the mean."""
    mean = sum(given.values()) / len(given)
    wider = {**given, **{name: mean for name in names if name not in given}}
    whole = sum(wider.values())
    return {name: one / whole for name, one in wider.items()}
