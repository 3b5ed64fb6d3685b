"""Which trajectories of a replayed run are evaluated with which poses, and their errors."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.relative import (
    EvaluationConfig,
    RelativeErrors,
    position_errors,
)
from odometry.evaluation.score import Score, Withheld, summary, window_errors
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from odometry.trajectory import Trajectory

SCATTERS = ("noisy_positions", "rounded_positions")  # their first value is its deviation


@dataclass(frozen=True)
class SecondReplay:
    """The same filter on the same run, without the poses of the evaluation.

    Attributes
    ----------
    withheld : Withheld
    replay : Replay
    """

    withheld: Withheld
    replay: Replay


@dataclass(frozen=True)
class EvaluatedTrajectory:
    """A trajectory of a run, the poses that it is compared with, and their name.

    Attributes
    ----------
    reckon : callable
        Gives `trajectory` anew: all trajectories of a long run do not fit in memory together.
    reference : Trajectory
    against : str
        "truth", "pose" or "withheld pose".
    run : Run
    config : EvaluationConfig
    """

    reckon: Callable[[], Trajectory]
    reference: Trajectory
    against: str
    run: Run
    config: EvaluationConfig

    @property
    def trajectory(self) -> Trajectory:
        """Of the point that the reference measures."""
        return self.reckon()

    @property
    def position_errors(self) -> tuple[FloatArray, FloatArray]:
        """Stamps (K,) of the reference that it covers, and its distance (K,) there [m]."""
        return self._errors[0]

    @property
    def window_errors(self) -> RelativeErrors:
        """Errors of windows of equal wheel travel."""
        return self._errors[1]

    @property
    def score(self) -> Score:
        """Its errors in a few numbers."""
        return summary(self.window_errors, self.position_errors[1])

    @cached_property
    def _errors(self) -> tuple[tuple[FloatArray, FloatArray], RelativeErrors]:
        line = self.trajectory
        windows = window_errors(self.run, line, self.reference, self.config)
        return position_errors(line, self.reference), windows


def is_used_by_filter(reference_name: str) -> bool:
    """Whether the filter used the reference, which then cannot evaluate its estimate."""
    return reference_name == "pose"


def scatter_of_reference(
    events: Sequence[FilterEvent], reference_name: str, horizon_m: float
) -> list[str]:
    """A sentence where the positions of pose.csv scatter: that much of an error is theirs.

    Over a horizon both ends do, with sigma along each axis: sqrt(pi) sigma in the mean.
    """
    sigmas_m = [event.values[0] for event in events if event.kind in SCATTERS]
    if not is_used_by_filter(reference_name) or not sigmas_m:
        return []
    per_m = math.sqrt(math.pi) * max(sigmas_m) / horizon_m
    return [
        f"The poses themselves are off by about {max(sigmas_m):.2g} m (scatter, rounding): a "
        f"perfect trajectory would have an error of up to {per_m:.2g} m per m against them."
    ]


def at_reference_point(
    run: Run, reference_name: str, reckon: Callable[[], Trajectory]
) -> Trajectory:
    """A trajectory of the point that the reference measures: in pose.csv that is the antenna."""
    trajectory = reckon()
    if reference_name != "pose" or run.sensors.pose_m is None:
        return trajectory
    places = se2.transform(trajectory.poses, np.array(run.sensors.pose_m[:2]))
    return Trajectory(trajectory.stamps_s, np.column_stack([places, trajectory.poses[:, 2]]))
