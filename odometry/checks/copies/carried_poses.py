"""Poses that a filter carries on by the treads from one fix to the next."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

LEAST_ROWS = 100
LIVELY, LEAST_CHANGE_M = 0.6, 1e-6  # quantile of the changes of the treads, and their least size
# Of the usual change of these rows, by which a quarter of them differs at most. Measured poses of
# real recordings and of drives by formulas: by 0.24 at the least
QUARTER, EXACT, EXACT_M = 0.25, 0.005, 2e-4


def carried_poses(evidence: Evidence) -> Iterator[Finding]:
    """Steps from pose to pose change as those of the treads do, more exactly than any is measured.

    So they do between the corrections of a filter that mixes treads in. Simulated runs (truth.csv)
    may move so exactly without noise.
    """
    found = None if evidence.run.truth is not None else _changes_m(evidence)
    if found is None:
        return
    of_poses_m, of_treads_m = found
    lively = np.abs(of_treads_m) > max(
        float(np.quantile(np.abs(of_treads_m), LIVELY)), LEAST_CHANGE_M
    )
    if lively.sum() < LEAST_ROWS / 4:
        return
    usual_m = float(np.median(np.abs(of_treads_m[lively])))
    off_m = float(np.quantile(np.abs(of_poses_m - of_treads_m)[lively], QUARTER))
    if off_m > min(EXACT * usual_m, EXACT_M):
        return
    yield Finding(
        "poses_are_wheel_odometry",
        Level.WARNING,
        f"in a quarter of its rows and more the step of pose.csv changes as that of the treads, to "
        f"{1000 * off_m:.2g} mm of {1000 * usual_m:.2g} mm",
        "pose.csv is the output of a filter that carries its pose on by these treads between the "
        "fixes that correct it: no reference",
        "Use the fixes themselves (GNSS, SLAM, motion capture): what is identified or compared "
        "with these poses is partly what the filter assumed of the treads",
    )


def _changes_m(evidence: Evidence) -> tuple[FloatArray, FloatArray] | None:
    """Changes (K,) from step to step ahead, of the poses and of the mean of the treads."""
    pose, of = evidence.run.pose, evidence.integrals
    if pose is None or not evidence.yaw_measured or evidence.yaw_in_degrees:
        return None
    known = np.isfinite(pose.stack("x", "y", "yaw")).all(axis=1)
    if known.sum() < LEAST_ROWS:
        return None
    stamps_s, yaw = pose.stamps_s[known], np.unwrap(pose["yaw"][known])
    moved_m = np.diff(pose["x"][known] + 1j * pose["y"][known])
    ahead_m = np.real(moved_m * np.exp(-1j * (yaw[1:] + yaw[:-1]) / 2))
    of_poses_m = np.diff(ahead_m)
    of_treads_m = np.diff(of.left_m(stamps_s) + of.right_m(stamps_s), 2) / 2
    both = np.isfinite(of_poses_m) & np.isfinite(of_treads_m)
    return (of_poses_m[both], of_treads_m[both]) if both.sum() >= LEAST_ROWS else None
