"""Answers of windows: by each of them, and by all of the last stretch."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.config import require, require_positive
from odometry.feel.assessment.held_out import Scores
from odometry.feel.classifier.strangeness import SURE
from odometry.feel.model import FeelModel, Probabilities, Summed
from odometry.feel.recorded.windows import FeelWindows, joined_windows, windows_since
from odometry.recording.run import UNKNOWN

STATIONARY, UNDETERMINED, NOT_MEASURED = "stationary", "undetermined", "not measured"
SILENT = (STATIONARY, UNDETERMINED, NOT_MEASURED)


@dataclass(frozen=True)
class FeelConfig:
    """Settings of the answers.

    Attributes
    ----------
    stretch_s : float
        Over so much time before each window evidence is put together.
    sure : float
        The probability from which a terrain is named; below it the answer is "undetermined".
    unknown_share : float, optional
        Prior probability of a terrain that the model does not know; by
        default what kept the model modest on terrains that were left out.
    """

    stretch_s: float = 10.0
    sure: float = SURE
    unknown_share: float | None = None

    def __post_init__(self) -> None:
        require_positive(self, "stretch_s")
        for name in ("sure", "unknown_share"):
            value = getattr(self, name)
            inside = value is None or 0 < value < 1
            require(inside, f"{name} = {value}, expected above 0 and below 1")


@dataclass(frozen=True)
class FeltWindows:
    """Evidence of W windows, one after another.

    Attributes
    ----------
    model : FeelModel
    config : FeelConfig
    windows : FeelWindows
    scores : Scores
        Of W windows; zeros where one has no evidence.
    foreign : (W,)
        Whether what is known at each window shows another IMU than the model's, see `sensor`.
    """

    model: FeelModel
    config: FeelConfig
    windows: FeelWindows
    scores: Scores
    foreign: BoolArray

    @property
    def stamps_s(self) -> FloatArray:
        """From when on (W,) each window is known."""
        return self.windows.known_s

    @property
    def probabilities(self) -> FloatArray:
        """Of each terrain (W, K) by one window; rows and `unknown` add up to 1."""
        return self._windows.probabilities

    @property
    def unknown(self) -> FloatArray:
        """Probability (W,) of a terrain that the model does not know, by one window."""
        return self._windows.unknown

    @cached_property
    def answers(self) -> AnyArray:
        """A terrain, "unknown", or one of SILENT (W,), by one window."""
        return self._answers(self._windows)

    @property
    def lasting_probabilities(self) -> FloatArray:
        """As `probabilities` (W, K), by all windows of the last stretch."""
        return self._lasting.probabilities

    @property
    def lasting_unknown(self) -> FloatArray:
        """As `unknown` (W,), by all windows of the last stretch."""
        return self._lasting.unknown

    @cached_property
    def lasting_answers(self) -> AnyArray:
        """As `answers` (W,), by all windows of the last stretch."""
        return self._answers(self._lasting)

    @property
    def outside_speeds(self) -> BoolArray:
        """Windows (W,) that are slower or faster than those the model was identified from."""
        limits, speeds = self.model.limits, self.windows.speeds_m_s
        outside = (speeds < limits.slowest_m_s) | (speeds > limits.fastest_m_s)
        return np.asarray(outside & self.windows.felt)

    @cached_property
    def _windows(self) -> Probabilities:
        rows = np.arange(len(self.windows))
        return self._over(np.column_stack([rows, rows + 1]))

    @cached_property
    def _lasting(self) -> Probabilities:
        begins_s, ends_s = self.windows.begins_s, self.windows.ends_s
        end = np.arange(1, len(ends_s) + 1)
        first = np.searchsorted(begins_s, ends_s - self.config.stretch_s - 1e-6)
        return self._over(np.column_stack([np.minimum(first, end - 1), end]))

    def _over(self, spans: IntArray) -> Probabilities:
        """Put windows together from the first to before the end of spans (N, 2)."""
        share = self.config.unknown_share or self.model.strangeness.share
        evidence = self.model.calibration.evidence(self.scores.log_likelihoods)
        summed = Summed.over(evidence, self.scores, self.windows.felt, spans)
        return Probabilities.of(self.model, summed, share)

    def _answers(self, of: Probabilities) -> AnyArray:
        names = np.array(self.model.names, dtype=object)[of.probabilities.argmax(axis=1)]
        named = np.where(of.probabilities.max(axis=1) >= self.config.sure, names, UNDETERMINED)
        named = np.where(of.is_novel | self.outside_speeds | self.foreign, UNKNOWN, named)
        named = np.where(self.windows.standing, STATIONARY, named)
        return np.where(self.windows.whole, named, NOT_MEASURED)

    def since(self, first: int) -> "FeltWindows":
        """Those from a row on."""
        windows = windows_since(self.windows, first)
        scores = self.scores.since(first)
        return FeltWindows(self.model, self.config, windows, scores, self.foreign[first:])

    @classmethod
    def joined(cls, parts: Sequence["FeltWindows"]) -> "FeltWindows":
        """Windows of one run, one part after another."""
        windows = joined_windows([one.windows for one in parts])
        scores = Scores.joined([one.scores for one in parts])
        foreign = np.concatenate([one.foreign for one in parts])
        return cls(parts[0].model, parts[0].config, windows, scores, foreign)
