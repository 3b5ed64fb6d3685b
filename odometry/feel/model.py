"""A model of terrain by feel: scores of windows, and their probabilities."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.feel.assessment.evidence import Calibration
from odometry.feel.assessment.held_out import Scores
from odometry.feel.assessment.limits import Limits
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.members import Choice, Members
from odometry.feel.classifier.sensor import SensorShape, ShapeSoFar
from odometry.feel.classifier.strangeness import Strangeness, unknown_probability
from odometry.feel.recorded.windows import STEPS, FeelWindows


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
    sensor : SensorShape or None
        None of few runs, and of files before version 0.14.
    track_width_m : float
    robot : str
        Its name.
    source : str
        Which runs it was identified from.
    report : Mapping
        What was found with runs held out; plain values.
    repeats : float
        The most that samples of one of the runs repeat, see `FeelSignals`, of the axes in use; 1
        where that is not known, as in files before version 0.15.

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
    sensor: SensorShape | None
    track_width_m: float
    robot: str
    source: str = ""
    report: Mapping[str, Any] = field(default_factory=dict)
    repeats: float = 1.0

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

    def foreign(self, windows: FeelWindows) -> BoolArray:
        """Whether W windows are of another IMU, by all of them; see `ShapeSoFar`."""
        return np.full(len(windows), self.shape_so_far.plus(windows).is_foreign)

    @property
    def shape_so_far(self) -> ShapeSoFar:
        """That of no windows yet."""
        return ShapeSoFar.none(self.sensor, self.design.axes)

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


@dataclass(frozen=True)
class Summed:
    """Sums over windows, for N answers.

    Attributes
    ----------
    evidence, novelty, offsets : (N, K), (N,), (N, K, C)
        See `evidence.Stretches`.
    counts : (N,)
        Of windows; where it is 0 nothing is said.
    """

    evidence: FloatArray
    novelty: FloatArray
    offsets: FloatArray
    counts: FloatArray

    @classmethod
    def over(
        cls, evidence: FloatArray, scores: Scores, felt: BoolArray, spans: IntArray
    ) -> "Summed":
        """Over those of W windows that are felt, from the first to before the end of spans (N, 2).

        `evidence` (W, K) is bounded, see `Calibration`. A span has a window or more, and its sum
        depends on its windows alone, not on those before.
        """

        def of(values: FloatArray) -> FloatArray:
            kept = np.concatenate([(values.T * felt).T, np.zeros((1, *values.shape[1:]))])
            return np.asarray(np.add.reduceat(kept, spans.ravel(), axis=0)[::2])

        return cls(of(evidence), of(scores.novelty), of(scores.offsets), of(np.ones(len(felt))))

    def mean(self, sums: FloatArray) -> FloatArray:
        """Of the windows."""
        return np.asarray((sums.T / np.maximum(self.counts, 1)).T)


@dataclass(frozen=True)
class Probabilities:
    """Of N windows or stretches.

    Attributes
    ----------
    probabilities : (N, K)
        Of the terrains of the model.
    unknown : (N,)
        Of a terrain that it does not know; adds up to 1 with them.
    is_novel : (N,)
        Whether each is beyond the limits of the training windows.
    """

    probabilities: FloatArray
    unknown: FloatArray
    is_novel: BoolArray

    @classmethod
    def of(cls, model: FeelModel, summed: Summed, unknown_share: float) -> "Probabilities":
        """From sums over overlapping windows, and prior probabilities."""
        windows = np.maximum((summed.counts + STEPS - 1) / STEPS, 1.0)
        among = model.calibration.probabilities(summed.mean(summed.evidence), windows)
        novelty, offsets = summed.mean(summed.novelty), summed.mean(summed.offsets)
        odds = model.limits.log_odds(model.strangeness, windows, offsets)
        any_felt = summed.counts > 0
        unknown = unknown_probability(np.where(any_felt, odds, 0.0), unknown_share)
        refused = model.limits.refused(windows, novelty, offsets)
        return cls(among * (1 - unknown)[:, None], unknown, any_felt & refused)
