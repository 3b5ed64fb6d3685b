"""The lines of a report: its trajectories, their names and styles."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.transition import Y_LEFT
from odometry.evaluation.score import Score
from odometry.models.catalogue import ICR_NAMES
from odometry.report.drawing.figure import REFERENCE_STYLE, LineStyle, line_styles
from odometry.report.drawing.labels import broken_at_outages, thinned_rows
from odometry.trajectory import Trajectory
from terrain.result.evaluated import EvaluatedTrajectory
from terrain.result.run_result import RunResult

LABELS = {
    "differential_drive": "differential drive",
    "gyroscope": "gyroscope, mean speed",
    "odometer_without_gyroscope": "odometer without gyroscope",
    "odometer": "odometer",
    "estimate": "estimate",
}
IDEAL, GYROSCOPE, _, ODOMETER, ESTIMATE = LABELS.values()
REFERENCE_NAMES = {"truth": "truth", "pose": "measured pose"}
ICR_COORDINATES = ICR_NAMES[:3]  # y_left, y_right, x_icr
IcrLine = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True)
class ReportLines:
    """A result and the results that it is compared with, line by line.

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
        """Name of the reference on the page."""
        return REFERENCE_NAMES.get(self.result.reference_name, "")

    def evaluated(self) -> dict[str, EvaluatedTrajectory]:
        """Trajectories that can be evaluated fairly, with the poses that they are compared with."""
        result = self.result
        if result.reference is None:
            return {}
        own = {LABELS[name]: of for name, of in result.evaluated.items()}
        others = {n: result.beside_reference(line) for n, line in self._other_odometers().items()}
        return own | others

    def scores(self) -> dict[str, Score]:
        """Score of each trajectory that is evaluated; none without a reference."""
        return {name: of.score for name, of in self.evaluated().items()}

    def paths(self) -> dict[str, Trajectory]:
        """Trajectories to be drawn, the reference first so that it lies below.

        The reference has NaN where it has no pose for long; of long lines what a map shows is left.
        """
        result, lines = self.result, {}
        if result.reference is not None:
            stamps_s, poses = result.reference.stamps_s, result.reference.poses
            lines[self.reference_name] = Trajectory(*broken_at_outages(stamps_s, poses))
        own = result.replay.open_loop_by_name(result.run.robot.track_width)
        reckoned = {LABELS[name]: reckon for name, reckon in own.items()}
        reckoned |= self._other_odometers() | {ESTIMATE: result.replay.trajectory}
        return lines | {name: _drawn(reckon()) for name, reckon in reckoned.items()}

    def icr_lines(self, coordinate: int) -> dict[str, IcrLine]:
        """Stamps, values and sigmas of one ICR coordinate (0, 1, 2) by each result."""
        replays = {ESTIMATE: self.result.replay} | {
            name: other.replay for name, other in self.compared_with.items()
        }
        of = slice(Y_LEFT + coordinate, Y_LEFT + coordinate + 1)
        return {
            name: (r.stamps_s, r.numbers("mean", columns=of)[:, 0], r.sigmas_of(of)[:, 0])
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
        """A style for every name; the ICRs of a compared result have that of its odometer."""
        others = [other_odometer(name) for name in self.compared_with]
        first = [ODOMETER, IDEAL, ESTIMATE]
        styles = line_styles([*first, *others, *(n for n in LABELS.values() if n not in first)])
        icrs = {name: styles[other_odometer(name)] for name in self.compared_with}
        references = dict.fromkeys(REFERENCE_NAMES.values(), REFERENCE_STYLE)
        return {**icrs, **styles, **references}

    def icr_styles(self) -> dict[str, LineStyle]:
        """The same, the estimate drawn as a solid line."""
        styles = self.styles()
        return styles | {ESTIMATE: styles[ODOMETER]}

    def _other_odometers(self) -> dict[str, Callable[[], Trajectory]]:
        return {
            other_odometer(name): other.replay.odometer
            for name, other in self.compared_with.items()
        }


def _drawn(path: Trajectory) -> Trajectory:
    """A path with the poses that a map of it shows."""
    x, y, _ = path.poses.T
    return path.rows(thinned_rows(x, y))


def other_odometer(name: str) -> str:
    """Name of the odometer of a compared result."""
    return f"odometer, {name}"
