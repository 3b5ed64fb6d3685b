"""From where on windows are none of the terrains."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.feel.assessment.evidence import Stretches
from odometry.feel.assessment.scores import class_weights
from odometry.feel.classifier.strangeness import LENGTHS, Strangeness, farness, terms

# Of known terrains, held out, that their distance to the nearest leaves known: what is refused
# of runs beyond one in twenty would be undetermined else, so that little is lost.
KNOWN_SHARE = {"window": 0.95, "stretch": 0.95, "run": 0.9}
NEAR_SHARE = 0.99  # and that the distance in all columns does: beyond is like nothing felt
NEVER = 1e9  # of a file that knows no such distance; a file holds no infinity
STRETCH_S = 10.0
LONG_S = 20.0  # what is put together over more time is judged as a run
SPEED_MARGIN = 1.25  # by which a window may be slower or faster than all that were fitted to


@dataclass(frozen=True)
class Limits:
    """Above these a window, a stretch or a run is none of the terrains.

    Attributes
    ----------
    novelty : Mapping of str to float
        Squared distance by column, for each of LENGTHS.
    farness : Mapping of str to float
        Squared distance of the mean in the space of discriminants, for each of LENGTHS.
    slowest_m_s, fastest_m_s : float
        Mean tread speed of a window.
    window_s : float
        How long a window lasts.
    """

    novelty: Mapping[str, float]
    farness: Mapping[str, float]
    slowest_m_s: float
    fastest_m_s: float
    window_s: float

    @classmethod
    def of(
        cls, by_length: Mapping[str, Stretches], speeds_m_s: FloatArray, window_s: float
    ) -> "Limits":
        """From held-out runs: by terrain of equal weight for novelty, by answer for farness.

        With the same weight for each terrain, the few runs of the rarest terrain would decide how
        far is far.
        """
        return cls(
            {
                length: quantile(one.novelty, one.labels, NEAR_SHARE)
                for length, one in by_length.items()
            },
            {
                length: float(np.quantile(farness(one.offsets), KNOWN_SHARE[length]))
                for length, one in by_length.items()
            },
            float(speeds_m_s.min()) / SPEED_MARGIN,
            float(speeds_m_s.max()) * SPEED_MARGIN,
            window_s,
        )

    def refused(self, windows: FloatArray, novelty: FloatArray, offsets: FloatArray) -> BoolArray:
        """Whether each (N,) from so many windows (N,), without their overlap, is no terrain."""
        return self.excess(windows, novelty, offsets) > 1

    def excess(self, windows: FloatArray, novelty: FloatArray, offsets: FloatArray) -> FloatArray:
        """The larger of both distances (N,), in units of its limit."""
        far = farness(offsets) / self.at(self.farness, windows)
        return np.maximum(far, novelty / self.at(self.novelty, windows))

    def log_odds(
        self, strangeness: Strangeness, windows: FloatArray, offsets: FloatArray
    ) -> FloatArray:
        """Of "never felt" (N,), as probable before as known."""
        kinds, odds = self.lengths(windows), np.zeros(len(windows))
        far = farness(offsets) / self.at(self.farness, windows)
        for length in LENGTHS:
            of = kinds == length
            odds[of] = terms(far[of] * self.farness[length]) @ strangeness.weights[length]
        return odds

    def at(self, limits: Mapping[str, float], windows: FloatArray) -> FloatArray:
        """Limits (N,) of answers from so many windows (N,).

        Between one window and a stretch, what differs between windows averages out as
        1 / windows, and what they have in common stays.
        """
        stretch = STRETCH_S / self.window_s
        share = np.clip((1 / windows - 1 / stretch) / (1 - 1 / stretch), 0, 1)
        between = limits["stretch"] + share * (limits["window"] - limits["stretch"])
        return np.where(self.lengths(windows) == "run", limits["run"], between)

    def lengths(self, windows: FloatArray) -> AnyArray:
        """Which of LENGTHS so many windows (N,) are judged as."""
        long = windows * self.window_s > LONG_S
        return np.where(windows <= 1, "window", np.where(long, "run", "stretch"))


def quantile(values: FloatArray, labels: AnyArray, share: float) -> float:
    """Value (N,) up to which so much of the weight lies, with equal weights of terrains."""
    order = np.argsort(values)
    reached: AnyArray = np.cumsum(class_weights(labels)[order])
    place = min(int(np.searchsorted(reached, share)), len(order) - 1)
    return float(values[order[place]])
