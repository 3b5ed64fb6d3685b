"""A model of how terrains feel, and what it says of windows."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.feel.design import Design
from odometry.feel.evidence import Calibration, Stretches
from odometry.feel.held_out import scores_of
from odometry.feel.members import Choice, Members, columns_of
from odometry.feel.scores import class_weights
from odometry.feel.windows import FeelWindows

KNOWN_SHARE = 0.95  # of the windows of known terrains, held out, that count as known
SPEED_MARGIN = 1.25  # by which a window may be slower or faster than all that were fitted to


@dataclass(frozen=True)
class Limits:
    """From where on a window is none of the terrains.

    Attributes
    ----------
    window, stretch : float
        Novelty of one window, and the mean of a stretch.
    slowest_m_s, fastest_m_s : float
        Mean tread speed of a window.
    """

    window: float
    stretch: float
    slowest_m_s: float
    fastest_m_s: float

    @classmethod
    def of(cls, windows: Stretches, stretches: Stretches, speeds_m_s: FloatArray) -> "Limits":
        """Such that KNOWN_SHARE of what was held out is known, every terrain counting alike."""
        return cls(
            _quantile(windows),
            _quantile(stretches),
            float(speeds_m_s.min()) / SPEED_MARGIN,
            float(speeds_m_s.max()) * SPEED_MARGIN,
        )


@dataclass(frozen=True)
class FeelModel:
    """How K terrains feel on one robot.

    Attributes
    ----------
    names : tuple of str
    design : Design
        The columns.
    choice : Choice
    members : Members
    calibration : Calibration
    limits : Limits
    track_width_m : float
    robot : str
        Its name.
    source : str
        Which runs it was identified from.
    report : Mapping
        What was found with runs held out; plain values.

    Examples
    --------
    >>> import odometry
    >>> model = odometry.read_feel_model(odometry.shipped_data() / "feel" / "demo.feel")
    >>> model.names, model.design.window_s, model.design.top_hz
    (('grass', 'gravel'), 2.0, 10.0)
    """

    names: tuple[str, ...]
    design: Design
    choice: Choice
    members: Members
    calibration: Calibration
    limits: Limits
    track_width_m: float
    robot: str
    source: str = ""
    report: Mapping[str, Any] = field(default_factory=dict)

    def scores(self, windows: FeelWindows) -> tuple[FloatArray, FloatArray]:
        """Log likelihoods (W, K) and novelty (W,); rows of windows that are not felt are zeros."""
        felt = windows.felt
        log_likelihoods, novelty = np.zeros((len(windows), len(self.names))), np.zeros(len(windows))
        if felt.any():
            tables = [one[felt] for one in self._tables(windows)]
            log_likelihoods[felt], novelty[felt] = scores_of(self.members, tables)
        return log_likelihoods, novelty

    def farthest_columns(self, windows: FeelWindows, most: int = 3) -> tuple[str, ...]:
        """The columns that lie farthest from the nearest terrain, in their own spread."""
        one, (layout, places) = self.members.discriminants[0], self.choice.parts(self.design)[0]
        table = self._tables(windows)[0][windows.felt]
        columns = table[:, : len(places)] - table[:, len(places) :] @ one.slopes
        spread = np.sqrt(np.diag(np.linalg.inv(one.whitening.T @ one.whitening)))
        off = np.abs(np.nanmean(columns, axis=0) - one.means).min(axis=0) / spread
        names = [self.design.names(layout)[place] for place in places]
        return tuple(names[place] for place in np.argsort(-off)[:most])

    def _tables(self, windows: FeelWindows) -> list[FloatArray]:
        tables = [
            np.hstack([self.design.matrix(windows, layout), windows.covariates])
            for layout in range(len(self.design.layouts))
        ]
        return columns_of(tables, windows.covariates.shape[1], self.choice.parts(self.design))


def _quantile(of: Stretches) -> float:
    """Novelty below which KNOWN_SHARE of the weight lies."""
    order = np.argsort(of.novelty)
    reached: AnyArray = np.cumsum(class_weights(of.labels)[order])
    place = min(int(np.searchsorted(reached, KNOWN_SHARE)), len(order) - 1)
    return float(of.novelty[order[place]])
