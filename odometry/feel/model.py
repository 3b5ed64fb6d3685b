"""A model of terrain by feel, and its scores of windows."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.feel.design import Design
from odometry.feel.evidence import Calibration
from odometry.feel.held_out import Scores
from odometry.feel.limits import Limits
from odometry.feel.members import Choice, Members
from odometry.feel.strangeness import Strangeness
from odometry.feel.windows import FeelWindows


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
    strangeness : Strangeness
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
    strangeness: Strangeness
    limits: Limits
    track_width_m: float
    robot: str
    source: str = ""
    report: Mapping[str, Any] = field(default_factory=dict)

    def scores(self, windows: FeelWindows) -> Scores:
        """Of W windows; rows of windows without signals are zeros."""
        felt, count = windows.felt, len(windows)
        scores = Scores.of(self.members, [one[felt] for one in self._tables(windows)])
        found = Scores(
            *(
                np.zeros((count, *one.shape[1:]))
                for one in (scores.log_likelihoods, scores.novelty, scores.offsets)
            )
        )
        found.log_likelihoods[felt] = scores.log_likelihoods
        found.novelty[felt] = scores.novelty
        found.offsets[felt] = scores.offsets
        return found

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
        return self.choice.columns(tables, self.design)
