"""The lines of a report: which trajectories it shows, under which names and in which style."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.evaluation.score import Score, score
from odometry.models.catalogue import ICR_NAMES
from odometry.report.palette import REFERENCE_STYLE, LineStyle, line_styles
from odometry.trajectory import Trajectory
from terrain.run_odometry import RunResult

ODOMETER, IDEAL, FILTER = "odometer", "differential drive", "filter"
REFERENCE_NAMES = {"truth": "truth", "pose": "measured pose"}
ICR_COORDINATES = ICR_NAMES[:3]  # y_left, y_right, x_icr
IcrLine = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True)
class ReportLines:
    """A result and those that it is compared with, line by line.

    Attributes
    ----------
    result : RunResult
    compared_with : Mapping of name to RunResult
        Other results of the same run.
    """

    result: RunResult
    compared_with: Mapping[str, RunResult]

    @property
    def reference_name(self) -> str:
        """What the errors are against, as a reader would say."""
        return REFERENCE_NAMES.get(self.result.reference_name, "")

    def judged(self) -> dict[str, Trajectory]:
        """Trajectories that may be judged: the filter has seen pose.csv, but not the truth."""
        replay = self.result.replay
        lines = {
            ODOMETER: replay.odometer(),
            IDEAL: replay.differential_drive(self.result.run.robot.track_width),
        }
        if self.result.reference_name == "truth":
            lines[FILTER] = replay.trajectory()
        return lines | self._other_odometers()

    def scores(self) -> dict[str, Score]:
        """Score of each judged trajectory; none without a reference."""
        result = self.result
        if result.reference is None:
            return {}
        return {
            name: score(result.run, line, result.reference, result.config.evaluation)
            for name, line in self.judged().items()
        }

    def paths(self) -> dict[str, Trajectory]:
        """Trajectories to be drawn, the reference first so that it lies below."""
        replay, lines = self.result.replay, {}
        if self.result.reference is not None:
            lines[self.reference_name] = self.result.reference
        lines |= self.judged() | {FILTER: replay.trajectory()}
        return lines

    def icr_lines(self, coordinate: int) -> dict[str, IcrLine]:
        """Stamps, values and sigmas of one ICR coordinate (0, 1, 2) by each result."""
        replays = {"estimate": self.result.replay} | {
            name: other.replay for name, other in self.compared_with.items()
        }
        return {
            name: (r.stamps_s, r.means[:, 3 + coordinate], r.sigmas[:, 3 + coordinate])
            for name, r in replays.items()
        }

    def true_icr(self, name: str) -> tuple[FloatArray, FloatArray] | None:
        """Stamps and values of one true ICR coordinate over the replay, where truth.csv has it."""
        truth, stamps_s = self.result.run.truth, self.result.replay.stamps_s
        if truth is None or name not in truth:
            return None
        known = np.isfinite(truth[name])
        known &= (truth.stamps_s >= stamps_s[0]) & (truth.stamps_s <= stamps_s[-1])
        return (truth.stamps_s[known], truth[name][known]) if known.any() else None

    def styles(self) -> dict[str, LineStyle]:
        """A style for every name; the estimate of a result looks like its odometer."""
        others = [other_odometer(name) for name in self.compared_with]
        styles = line_styles([ODOMETER, IDEAL, FILTER, *others])
        estimates = {name: styles[other_odometer(name)] for name in self.compared_with}
        references = dict.fromkeys(REFERENCE_NAMES.values(), REFERENCE_STYLE)
        return {**estimates, "estimate": styles[ODOMETER], **styles, **references}

    def _other_odometers(self) -> dict[str, Trajectory]:
        return {
            other_odometer(name): other.replay.odometer()
            for name, other in self.compared_with.items()
        }


def other_odometer(name: str) -> str:
    """How the odometer of a compared result is called."""
    return f"odometer, {name}"
