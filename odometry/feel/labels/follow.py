"""What a run feels like, window by window and over the last stretch."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.errors import RunFolderError
from odometry.feel.labels.felt import (
    NOT_MEASURED,
    STATIONARY,
    UNDETERMINED,
    FeelConfig,
    FeltWindows,
)
from odometry.feel.model import FeelModel
from odometry.feel.recorded.windows import FeelWindows, feel_windows
from odometry.recording.run import UNKNOWN, Robot, Run

UNLIKE_SHARE = 0.5  # of the time: a run of which more is unknown is of no terrain of the model
MOST_REPEATS = 0.3  # of samples; real recordings repeat 0.02, rounded to 0.02 rad/s 0.33 and more
REPEATS_MARGIN = 0.1  # above the runs of a model that repeat as much


@dataclass(frozen=True)
class Felt(FeltWindows):
    """Evidence of the W windows of a run.

    Attributes
    ----------
    run : Run
    """

    run: Run

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
            return (STATIONARY if self.windows.standing.all() else NOT_MEASURED), 0.0, unknown
        is_unlike = (self.lasting_answers[moving] == UNKNOWN).mean() > UNLIKE_SHARE
        if is_novel or is_unlike or self.foreign[-1] or self.outside_speeds[moving].all():
            return UNKNOWN, 0.0, unknown
        is_sure = probabilities[best] >= self.config.sure
        return (best if is_sure else UNDETERMINED), probabilities[best], unknown


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
        If the run lacks a column of the model, is recorded more slowly, is rounded more coarsely,
        is of another robot, or as `feel_signals`.

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
    check_robot(model, run.robot, str(run.folder))
    check_repeats(model, windows, str(run.folder))
    foreign = model.foreign(windows)
    return Felt(model, config or FeelConfig(), windows, model.scores(windows), foreign, run)


def check_repeats(model: FeelModel, windows: FeelWindows, where: str) -> None:
    """Raise RunFolderError if samples repeat often, and more than in the runs of the model."""
    repeats = windows.most_repeats(model.design.axes)
    if repeats > max(MOST_REPEATS, model.repeats + REPEATS_MARGIN):
        raise RunFolderError(
            f"{where}: {100 * repeats:.0f} % of the samples of an axis of the IMU are the "
            f"same as the one before while the robot moves, at most {100 * model.repeats:.0f} % in "
            "the runs of the model: rounded more coarsely, clipped, or held for several rows?"
        )


def check_robot(model: FeelModel, robot: Robot, where: str) -> None:
    """Raise RunFolderError unless a robot is as wide as that of the model."""
    if not robot.may_have_width(model.track_width_m):
        raise RunFolderError(
            f"{where}: a robot of track width {robot.track_width:g} m; the model is of one of "
            f"{model.track_width_m:g} m: how terrain feels on one robot says nothing of another"
        )
