"""Errors of one trajectory of a run in a few numbers, and poses held out to find them."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.evaluation.reference_yaw import counted_reference_yaw
from odometry.evaluation.relative import (
    EvaluationConfig,
    RelativeErrors,
    position_errors,
    relative_errors,
)
from odometry.recording.frames import POSE_COLUMNS
from odometry.recording.run import Run
from odometry.trajectory import Trajectory

JUDGED_EVERY_S = 2.0
SILENT_S = 1.0


@dataclass(frozen=True)
class Score:
    """Errors of one trajectory.

    Attributes
    ----------
    windows : int
        Number of spatial horizons.
    translation_per_m : (3,) or None
        Quartiles (25, 50, 75 %) of the position error in metres per metre of wheel travel.
    mean_translation_per_m : float or None
    rotation_deg_per_m : (3,) or None
        Quartiles of the heading error, degrees per metre of wheel travel; None where the
        reference has no yaw.
    mean_rotation_deg_per_m : float or None
    mean_position_m, final_position_m, median_position_m : float or None
        Distance from the reference: mean and median over all its stamps, and at the last.
    """

    windows: int
    translation_per_m: FloatArray | None = None
    mean_translation_per_m: float | None = None
    rotation_deg_per_m: FloatArray | None = None
    mean_rotation_deg_per_m: float | None = None
    mean_position_m: float | None = None
    final_position_m: float | None = None
    median_position_m: float | None = None

    def to_table(self) -> dict[str, Any]:
        """Plain values with the unit in each name."""
        return {
            "windows": self.windows,
            "translation_m_per_m": {
                "mean": self.mean_translation_per_m,
                "median": _median(self.translation_per_m),
                "quartiles": _plain(self.translation_per_m),
            },
            "rotation_deg_per_m": {
                "mean": self.mean_rotation_deg_per_m,
                "median": _median(self.rotation_deg_per_m),
                "quartiles": _plain(self.rotation_deg_per_m),
            },
            "position_m": {
                "mean": self.mean_position_m,
                "median": self.median_position_m,
                "final": self.final_position_m,
            },
        }


def reference_of(run: Run) -> tuple[str, Trajectory] | None:
    """The trajectory that a run is compared with: truth.csv, else pose.csv, else none.

    It holds the rows with x and y; the yaw of a row without one is NaN.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> name, reference = odometry.reference_of(run)
    >>> name, len(reference)
    ('truth', 1085)
    """
    for name, table in (("truth", run.truth), ("pose", run.pose)):
        if table is None:
            continue
        poses = table.stack("x", "y", "yaw")
        measured = np.isfinite(poses[:, :2]).all(axis=1)
        if measured.sum() >= 2:
            return name, Trajectory(table.stamps_s[measured], poses[measured])
    return None


def window_errors(
    run: Run, trajectory: Trajectory, reference: Trajectory, config: EvaluationConfig
) -> RelativeErrors:
    """Relative errors of a trajectory of a run, the reference's turns counted by the run."""
    travel_s, travel_m = run.odometry.stamps_s, run.wheel_travel_m
    counted = counted_reference_yaw(run, reference)
    return relative_errors(
        trajectory,
        reference,
        travel_s,
        travel_m,
        config,
        reference_yaw_rad=counted.yaw_rad,
        reference_part=counted.part,
    )


def score(
    run: Run, trajectory: Trajectory, reference: Trajectory, config: EvaluationConfig
) -> Score:
    """Errors of a trajectory of a run against a reference.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> gravel = odometry.ConstantTerrain("gravel")
    >>> filtered = odometry.replay(run, odometry.IcrEkf(track_width=0.4), gravel)
    >>> _, reference = odometry.reference_of(run)
    >>> found = odometry.score(run, filtered.odometer(), reference, odometry.EvaluationConfig())
    >>> found.mean_translation_per_m < 0.1  # m per m of wheel travel
    True
    """
    relative = window_errors(run, trajectory, reference, config)
    return summary(relative, position_errors(trajectory, reference)[1])


def summary(relative: RelativeErrors, distances_m: FloatArray) -> Score:
    """Errors of windows, and distances (K,) from the reference, in a few numbers."""
    position: dict[str, Any] = (
        {
            "mean_position_m": float(distances_m.mean()),
            "median_position_m": float(np.median(distances_m)),
            "final_position_m": float(distances_m[-1]),
        }
        if len(distances_m)
        else {}
    )
    if not len(relative.start_s):
        return Score(0, **position)
    rotation = np.degrees(relative.rotation_per_m[np.isfinite(relative.rotation_per_m)])
    return Score(
        len(relative.start_s),
        np.percentile(relative.translation_per_m, [25, 50, 75]),
        float(relative.translation_per_m.mean()),
        np.percentile(rotation, [25, 50, 75]) if len(rotation) else None,
        float(rotation.mean()) if len(rotation) else None,
        **position,
    )


def _median(quartiles: FloatArray | None) -> float | None:
    return None if quartiles is None else float(quartiles[1])


def _plain(quartiles: FloatArray | None) -> list[float] | None:
    return None if quartiles is None else [float(value) for value in quartiles]


@dataclass(frozen=True)
class Withheld:
    """A run without some of its poses, and those of them that are used for evaluation.

    Attributes
    ----------
    run : Run
        x, y and yaw of the withheld rows are NaN: its frames keep their stamps.
    judged : Trajectory
        One held-out pose every JUDGED_EVERY_S; its yaw is NaN where none was measured.
    poses : int
        How many were withheld.
    """

    run: Run
    judged: Trajectory
    poses: int


def withhold(run: Run, begin_s: float, end_s: float) -> Withheld | None:
    """Remove poses of a run for evaluation; None where fewer than two are left for that.

    Parameters
    ----------
    run : Run
    begin_s, end_s : float
        First and last stamp of the replay: its first pose starts it and is never withheld.
    """
    if run.pose is None:
        return None
    poses = run.pose.stack(*POSE_COLUMNS)
    stamps_s = run.pose.stamps_s
    measured = np.isfinite(poses).any(axis=1) & (stamps_s >= begin_s) & (stamps_s <= end_s)
    rows = np.flatnonzero(measured)
    judged, kept = choose(stamps_s[rows])
    has_place = np.isfinite(poses[rows[judged], :2]).all(axis=1)
    judges = rows[judged][has_place]
    if len(judges) < 2:
        return None
    emptied = poses.copy()
    emptied[rows[~kept]] = np.nan
    columns = dict(run.pose.columns) | dict(zip(POSE_COLUMNS, emptied.T, strict=True))
    return Withheld(
        replace(run, pose=replace(run.pose, columns=columns)),
        Trajectory(stamps_s[judges], poses[judges]),
        int(np.sum(~kept)),
    )


def choose(stamps_s: FloatArray) -> tuple[BoolArray, BoolArray]:
    """Which poses at increasing stamps (M,) are evaluated with, and which are given to the filter.

    The first is given, and so is at least one between two of the evaluation.
    """
    judged, given = np.zeros(len(stamps_s), dtype=np.bool_), np.ones(len(stamps_s), dtype=np.bool_)
    last_s, given_from = stamps_s[:1], 0  # last evaluation pose; at first, the start
    for row, stamp_s in enumerate(stamps_s):
        silent_from = int(np.searchsorted(stamps_s, stamp_s - SILENT_S, side="right"))
        if stamp_s - last_s[0] >= JUDGED_EVERY_S and silent_from > given_from:
            judged[row], given[silent_from : row + 1] = True, False
            last_s, given_from = stamps_s[row:], row + 1
    return judged, given
