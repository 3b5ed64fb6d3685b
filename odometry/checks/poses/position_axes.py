"""Positions that hardly change along one axis while the robot drives along it."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import middle_rad
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.stamps.late_positions import reckoned_m
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense, pose_sense

MISSING = 0.1  # of what is measured along the other axis; good poses have 0.9 and more
# Quantile of the windows, and its share of the drive: more is measured at times, till a border.
# Heights of real drives have 0.07, noise of 3 cm 0.12.
OFTEN, AT_TIMES = 0.97, 0.5
SURE = 5.0  # standard deviations
LEAST_DRIVEN_M = 3.0  # along the direction that is missing
AS_MUCH = 0.2  # by which yaw may turn more or less than the gyroscope
CONSTANT_M = 1e-3  # of a column that is not measured
ACROSS = 0.2  # of the extent along: lanes there and back have less, whatever a gyroscope drifts
CAUSE = (
    "Positions are of other axes, one of which is vertical (a camera has x to the right, y down "
    "and z ahead), or one of their columns was not measured (a constant): these cannot be "
    "distinguished"
)
HELD = 0.9  # correlation of turns with those of the gyroscope, or of positions with the way


def position_axes(evidence: Evidence) -> Iterator[Finding]:
    """One direction of the drive is missing in the positions."""
    if not evidence.yaw_measured:
        yield from _constant_column(evidence)
    elif _yaw_holds(evidence):
        yield from _missing_direction(evidence)


def _missing_direction(evidence: Evidence) -> Iterator[Finding]:
    """One direction is missing, and yaw turns as the gyroscope does.

    Displacements in the frame of the poses are a matrix times those of the treads along the yaw: a
    rotation and a scale, whose two singular values are equal. One of them near zero is an axis
    that is vertical, or was not measured.
    """
    m = evidence.motion
    yaw = middle_rad(m.yaw_rad)
    driven_m = m.mean_m[:, None] * np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)
    fits = [relation(moved, *driven_m.T) for moved in m.moved_m.T]
    if any(fit is None or not fit.distinct for fit in fits):
        return
    known = [fit for fit in fits if fit is not None]
    axes, sizes, ways = np.linalg.svd([fit.coefficients for fit in known])
    sigma = max(float(fit.sigmas.max()) for fit in known)
    best = max(known, key=lambda fit: fit.correlation)
    if sizes[1] + SURE * sigma > MISSING * sizes[0] or best.correlation < HELD:
        return
    if _is_way_ahead(evidence, axes[:, 0], best):
        return
    along_m = driven_m @ ways[1]
    missing_m = float(np.nansum(np.abs(along_m)))
    if missing_m < LEAST_DRIVEN_M:
        return
    measured, driven = (np.nanquantile(np.abs(v), OFTEN) for v in (m.moved_m @ axes[:, 1], along_m))
    if measured > AT_TIMES * driven:
        return
    axis = _axis(axes[:, 1])
    yield Finding(
        "position_axes",
        Level.WARNING,
        f"positions of pose.csv hardly change along {axis} ({sizes[1]:.2g} m for each m that "
        f"the robot drives that way by treads and yaw, {missing_m:.3g} m in all), and "
        f"{sizes[0]:.3g} m for each m across it; yaw turns as the other sensors do",
        CAUSE,
        "Write x and y of the horizontal plane in which yaw counts: x forward and y left at yaw 0",
    )


def _constant_column(evidence: Evidence) -> Iterator[Finding]:
    """One column never changes, and the path of treads and gyroscope goes across it, too."""
    pose = evidence.run.pose
    if pose is None:
        return
    positions_m = pose.stack("x", "y")
    positions_m = positions_m[np.isfinite(positions_m).all(axis=1)]
    extents_m = np.ptp(positions_m, axis=0) if len(positions_m) else np.zeros(2)
    if extents_m.min() > CONSTANT_M or extents_m.max() < LEAST_DRIVEN_M:
        return
    path_m = reckoned_m(evidence)
    across_m, along_m = np.sqrt(np.linalg.eigvalsh(np.cov(path_m.T)))
    if across_m < max(LEAST_DRIVEN_M / 2, ACROSS * along_m):
        return
    yield Finding(
        "position_axes",
        Level.WARNING,
        f"{'xy'[int(extents_m.argmin())]} of pose.csv never changes, and the other goes over "
        f"{extents_m.max():.3g} m; the path of the treads and their turns is {2 * across_m:.3g} m "
        f"wide and {2 * along_m:.3g} m long (twice its standard deviations)",
        f"{CAUSE}; of latitude and longitude, too few digits are left (4.81E+01)",
        "Write x and y of the horizontal plane, with all their digits",
    )


def _yaw_holds(evidence: Evidence) -> bool:
    """Whether measured yaw turns as much as the gyroscope, else to the side of the treads."""
    found = evidence.pose_turn_by_gyroscope
    if found is not None and gyroscope_sense(evidence) is not Sense.OPPOSITE:
        as_much = abs(found.slope - 1) < AS_MUCH
        return found.certain() and found.correlation > HELD and as_much
    return pose_sense(evidence) is Sense.AGREES


def _is_way_ahead(evidence: Evidence, axis: FloatArray, by_yaw: Relation) -> bool:
    """Whether what is measured along an axis is the way ahead, whatever yaw says."""
    ahead = relation(evidence.motion.moved_m @ axis, evidence.motion.mean_m)
    return ahead is not None and ahead.explained > by_yaw.explained


def _axis(direction: FloatArray) -> str:
    """A direction in the frame of the poses in words."""
    degrees = round(float(np.degrees(np.arctan2(direction[1], direction[0])))) % 180
    names = {0: "x", 90: "y"}
    near = next((at for at in (0, 90, 180) if abs(degrees - at) <= 10), None)
    return names[near % 180] if near is not None else f"{degrees} degrees of their frame"
