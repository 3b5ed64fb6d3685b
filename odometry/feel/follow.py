"""What a run feels like, window by window and over the last stretch."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.config import require, require_positive
from odometry.errors import RunFolderError
from odometry.feel.held_out import Scores
from odometry.feel.model import FeelModel
from odometry.feel.probabilities import Probabilities, Summed
from odometry.feel.windows import FeelWindows, feel_windows
from odometry.run import UNKNOWN, Run

STATIONARY, UNDETERMINED, NOT_MEASURED = "stationary", "undetermined", "not measured"
SILENT = (STATIONARY, UNDETERMINED, NOT_MEASURED)
SAME_WIDTH = 0.1  # share by which track widths of one robot may differ


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
    sure: float = 0.6
    unknown_share: float | None = None

    def __post_init__(self) -> None:
        require_positive(self, "stretch_s")
        for name in ("sure", "unknown_share"):
            value = getattr(self, name)
            inside = value is None or 0 < value < 1
            require(inside, f"{name} = {value}, expected above 0 and below 1")


@dataclass(frozen=True)
class Felt:
    """Evidence of the W windows of a run.

    Attributes
    ----------
    run : Run
    model : FeelModel
    config : FeelConfig
    windows : FeelWindows
    scores : Scores
        Of W windows; zeros where one has no evidence.
    """

    run: Run
    model: FeelModel
    config: FeelConfig
    windows: FeelWindows
    scores: Scores

    @property
    def stamps_s(self) -> FloatArray:
        """From when on (W,) each window is known."""
        return self.windows.ends_s

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

    @cached_property
    def of_run(self) -> tuple[dict[str, float], bool]:
        """Probability of each terrain if the run is of one, and whether it is like none."""
        of = self._over(np.array([[0, len(self.windows)]]))
        names = self.model.names
        found = dict(zip(names, of.probabilities[0].tolist(), strict=True))
        return found, bool(of.is_novel[0])

    @property
    def answer_of_run(self) -> tuple[str, float, float]:
        """The answer if the run is of one terrain, its probability, and that of an unknown one."""
        probabilities, is_novel = self.of_run
        best = max(probabilities, key=lambda name: probabilities[name])
        unknown = 1 - sum(probabilities.values())
        moving = self.windows.felt
        if not moving.any():
            return (STATIONARY if self.windows.standing.any() else NOT_MEASURED), 0.0, unknown
        if is_novel or self.outside_speeds[moving].all():
            return UNKNOWN, 0.0, unknown
        is_sure = probabilities[best] >= self.config.sure
        return (best if is_sure else UNDETERMINED), probabilities[best], unknown

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
        begins_s, ends_s = self.windows.begins_s, self.stamps_s
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
        named = np.where(of.is_novel | self.outside_speeds, UNKNOWN, named)
        named = np.where(self.windows.standing, STATIONARY, named)
        return np.where(self.windows.whole, named, NOT_MEASURED)


def follow_feel(run: Run, model: FeelModel, config: FeelConfig | None = None) -> Felt:
    """Name the terrain of a run by feel.

    Parameters
    ----------
    run : Run
    model : FeelModel
        Of the same robot.
    config : FeelConfig, optional

    Raises
    ------
    RunFolderError
        If the run lacks a column of the model, is recorded more slowly, is of another robot, or as
        `feel_signals`.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> model = odometry.read_feel_model(odometry.shipped_data() / "feel" / "demo.feel")
    >>> felt = odometry.follow_feel(run, model)
    >>> felt.probabilities.shape == (len(felt.windows), 2)
    True
    """
    windows = feel_windows(run, model.design.window_s)
    model.design.check(windows, str(run.folder))
    width = run.robot.track_width
    if abs(width / model.track_width_m - 1) > SAME_WIDTH:
        raise RunFolderError(
            f"{run.folder}: a robot of track width {width:g} m; the model is of one of "
            f"{model.track_width_m:g} m: how terrain feels on one robot says nothing of another"
        )
    return Felt(run, model, config or FeelConfig(), windows, model.scores(windows))
