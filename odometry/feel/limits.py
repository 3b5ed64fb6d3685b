"""From where on a window is none of the terrains."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.feel.scores import class_weights

KNOWN_SHARE = 0.96  # of known terrains, held out, that strangeness leaves known
NEAR_SHARE = 0.99  # and that distance alone does: what lies beyond is like nothing felt
NEVER = 1e9  # log odds of a model that knows no strangeness; a file holds no infinity
EVEN = 0.0  # log odds: what is more probably known than not is never refused
SPEED_MARGIN = 1.25  # by which a window may be slower or faster than all that were fitted to


@dataclass(frozen=True)
class Limits:
    """Above these a window, or a stretch, is none of the terrains.

    Attributes
    ----------
    window, stretch : float
        Novelty of one window, and the mean of a stretch.
    slowest_m_s, fastest_m_s : float
        Mean tread speed of a window.
    strange_window, strange_stretch : float
        Log odds of strangeness.
    """

    window: float
    stretch: float
    slowest_m_s: float
    fastest_m_s: float
    strange_window: float = NEVER
    strange_stretch: float = NEVER

    @classmethod
    def of(
        cls,
        windows: tuple[AnyArray, FloatArray, FloatArray],
        stretches: tuple[AnyArray, FloatArray, FloatArray],
        speeds_m_s: FloatArray,
    ) -> "Limits":
        """By labels, novelty and log odds (N,) of what was held out; every terrain alike."""
        return cls(
            quantile(windows[1], windows[0], NEAR_SHARE),
            quantile(stretches[1], stretches[0], NEAR_SHARE),
            float(speeds_m_s.min()) / SPEED_MARGIN,
            float(speeds_m_s.max()) * SPEED_MARGIN,
            max(EVEN, quantile(windows[2], windows[0], KNOWN_SHARE)),
            max(EVEN, quantile(stretches[2], stretches[0], KNOWN_SHARE)),
        )


def quantile(values: FloatArray, labels: AnyArray, share: float) -> float:
    """Value (N,) up to which so much of the weight lies, every terrain counting alike."""
    order = np.argsort(values)
    reached: AnyArray = np.cumsum(class_weights(labels)[order])
    place = min(int(np.searchsorted(reached, share)), len(order) - 1)
    return float(values[order[place]])
