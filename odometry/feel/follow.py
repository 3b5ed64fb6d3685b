"""What a run feels like, window by window and over the last stretch."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.config import require, require_positive
from odometry.errors import RunFolderError
from odometry.feel.model import FeelModel
from odometry.feel.windows import STEPS, FeelWindows, feel_windows
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
    """

    stretch_s: float = 10.0
    sure: float = 0.6

    def __post_init__(self) -> None:
        require_positive(self, "stretch_s")
        require(0 < self.sure < 1, f"sure = {self.sure}, expected above 0 and below 1")


@dataclass(frozen=True)
class Felt:
    """Evidence of the W windows of a run.

    Attributes
    ----------
    run : Run
    model : FeelModel
    config : FeelConfig
    windows : FeelWindows
    log_likelihoods : (W, K)
        Zeros where a window says nothing.
    novelty : (W,)
    """

    run: Run
    model: FeelModel
    config: FeelConfig
    windows: FeelWindows
    log_likelihoods: FloatArray
    novelty: FloatArray

    @property
    def stamps_s(self) -> FloatArray:
        """From when on (W,) each window is known."""
        return self.windows.ends_s

    @cached_property
    def probabilities(self) -> FloatArray:
        """Of each terrain (W, K) by one window; alike where it says nothing."""
        calibration = self.model.calibration
        return calibration.probabilities(self.log_likelihoods, np.ones(len(self.windows)))

    @cached_property
    def answers(self) -> AnyArray:
        """A terrain, "unknown", or one of SILENT (W,), by one window."""
        return self._answers(self.probabilities, self.novelty > self.model.limits.window)

    @cached_property
    def lasting_probabilities(self) -> FloatArray:
        """The same (W, K) by all windows of the last stretch."""
        sums, _, counts = self._trailing
        means = sums / np.maximum(counts, 1)[:, None]
        worth = np.where(counts > 0, (counts + STEPS - 1) / STEPS, 1.0)
        return self.model.calibration.probabilities(means, worth)

    @cached_property
    def lasting_answers(self) -> AnyArray:
        """The same (W,) by all windows of the last stretch."""
        _, novelty, counts = self._trailing
        novel = novelty / np.maximum(counts, 1) > self.model.limits.stretch
        return self._answers(self.lasting_probabilities, novel)

    @cached_property
    def of_run(self) -> tuple[dict[str, float], bool]:
        """Probability of each terrain if the run is of one, and whether it is like none."""
        felt = self.windows.felt
        names = self.model.names
        if not felt.any():
            return dict.fromkeys(names, 1 / len(names)), False
        worth = np.array([max(1.0, felt.sum() / STEPS)])
        mean = self.log_likelihoods[felt].mean(axis=0)[None]
        probabilities = self.model.calibration.probabilities(mean, worth)[0]
        novel = bool(self.novelty[felt].mean() > self.model.limits.stretch)
        return dict(zip(names, probabilities.tolist(), strict=True)), novel

    @property
    def outside_speeds(self) -> BoolArray:
        """Windows (W,) that are slower or faster than those the model was identified from."""
        limits, speeds = self.model.limits, self.windows.speeds_m_s
        outside = (speeds < limits.slowest_m_s) | (speeds > limits.fastest_m_s)
        return np.asarray(outside & self.windows.felt)

    @cached_property
    def _trailing(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sums (W, K), (W,) and counts (W,) over the windows of the stretch up to each."""
        felt, ends_s = self.windows.felt, self.stamps_s
        first = np.searchsorted(self.windows.begins_s, ends_s - self.config.stretch_s - 1e-6)
        upto = np.arange(1, len(ends_s) + 1)
        first = np.minimum(first, upto - 1)
        table = np.column_stack([self.log_likelihoods, self.novelty, felt]) * felt[:, None]
        summed = np.vstack([np.zeros(table.shape[1]), np.cumsum(table, axis=0)])
        part = summed[upto] - summed[first]
        return part[:, :-2], part[:, -2], part[:, -1]

    def _answers(self, probabilities: FloatArray, novel: BoolArray) -> AnyArray:
        names = np.array(self.model.names, dtype=object)[probabilities.argmax(axis=1)]
        named = np.where(probabilities.max(axis=1) >= self.config.sure, names, UNDETERMINED)
        named = np.where(novel | self.outside_speeds, UNKNOWN, named)
        named = np.where(self.windows.standing, STATIONARY, named)
        return np.where(self.windows.whole, named, NOT_MEASURED)


def follow_feel(run: Run, model: FeelModel, config: FeelConfig | None = None) -> Felt:
    """Tell what a run feels like.

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
    log_likelihoods, novelty = model.scores(windows)
    return Felt(run, model, config or FeelConfig(), windows, log_likelihoods, novelty)
