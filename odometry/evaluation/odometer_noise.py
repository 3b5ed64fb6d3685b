"""The noise of an open-loop odometer, measured between poses of its run."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import FloatArray, IntArray
from odometry.evaluation.open_loop_errors import COMPONENTS, SOURCES, OpenLoopPath
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.windows.travel.horizons import spatial_horizons

LENGTHS_M = (2.0, 5.0, 10.0, 20.0, 50.0)  # wheel travel of the stretches
STRETCHES_IN_RUN = 4  # a length is measured where so many lie end to end
STRIDE = 0.25  # from start to start, in lengths
FEWEST = 8  # stretches of the shortest length
LEAST_SHARE = 0.3  # of usual variances; chosen on the same recordings by NEES of their halves
RESOLUTION = np.array([1e-6, 1e-8])  # variances below which no pose is known: 1 mm, 0.1 mrad


@dataclass(frozen=True)
class OdometerNoise:
    """Variances of an odometer's errors.

    Attributes
    ----------
    variances : (12,)
        By `SOURCES`: of random errors per metre of wheel travel and per radian turned, of
        constant ones per square metre and per square radian; m^2 or rad^2.
    reference : (2,)
        Of the poses that it was measured against: position [m^2] and yaw [rad^2].
    stretches : int
        How many it was measured on.
    longest_m : float
        The greatest length of these.
    """

    variances: FloatArray
    reference: FloatArray
    stretches: int
    longest_m: float

    def without_reference(self) -> "OdometerNoise":
        """The same, to be compared with poses that have no noise."""
        return replace(self, reference=RESOLUTION)


USUAL_NOISE = OdometerNoise(
    np.square([0.19, 0.17, 0.19, 0.17, 0.006, 0.08, 0.06, 0.16, 0.06, 0.16, 0.005, 0.014]),
    np.square([0.14, 0.05]),
    stretches=0,
    longest_m=0.0,
)  # means without least shares, equal for x and y, of 19 recordings (main_job/odometer_noise.py)
NOISE_WITHOUT_POSES = replace(
    USUAL_NOISE, variances=2 * USUAL_NOISE.variances
)  # twice the usual: NEES of 24 recordings over 2 to 50 m is then 3 in the mean


def motion_errors(
    poses: FloatArray, true_poses: FloatArray, first: IntArray, last: IntArray
) -> FloatArray:
    """Motions (K, 3) from first to last poses less the true ones, in the frame of the first."""
    ours, true = (se2.between(each[first], each[last]) for each in (poses, true_poses))
    errors = ours - true
    errors[:, 2] = wrap(errors[:, 2])
    return np.asarray(errors)


def measured_noise(
    path: OpenLoopPath, rows: IntArray, reference: FloatArray
) -> OdometerNoise | None:
    """Find the variances of noise that explain the errors of an odometer.

    Squared errors of stretches of several lengths are the sum of what each source adds, weighed
    with the same weight for each length: least squares over variances with a lower limit (the
    method of moments for variance components; Rao and Kleffe 1988, Estimation of Variance
    Components, 1.3).

    Parameters
    ----------
    path : OpenLoopPath
    rows : (M,)
        Poses of the path at which there is a reference.
    reference : (M, 3)

    Returns
    -------
    OdometerNoise or None
        None where there are too few stretches.
    """
    if len(rows) < 2:
        return None
    travelled = path.travel_m[rows]
    squares, units, stretches, longest_m = [], [], 0, 0.0
    for length_m in LENGTHS_M:
        if travelled[-1] - travelled[0] < STRETCHES_IN_RUN * length_m:
            break
        first, last = spatial_horizons(travelled, length_m, STRIDE * length_m).T
        if len(first) < FEWEST:
            break
        errors = np.square(motion_errors(path.poses[rows], reference, first, last))
        scale = (errors.mean(axis=0) + RESOLUTION[[0, 0, 1]]) * np.sqrt(len(first))
        by_source = path.unit_covariances(rows[first], rows[last])
        diagonal = np.swapaxes(np.diagonal(by_source, axis1=2, axis2=3), 1, 2)
        unit = np.concatenate([diagonal, _by_reference(reference, first, last)], axis=2)
        squares.append((errors / scale).ravel())
        units.append((unit / scale[:, None]).reshape(-1, unit.shape[-1]))
        stretches, longest_m = stretches + len(first), length_m
    if not stretches:
        return None
    found = _variances(np.concatenate(units), np.concatenate(squares))
    reference = np.maximum(found[len(SOURCES) :], RESOLUTION)
    return OdometerNoise(found[: len(SOURCES)], reference, stretches, longest_m)


def _variances(units: FloatArray, squares: FloatArray) -> FloatArray:
    """Variances (14,) of sources and reference whose sum is nearest to squared errors (R,).

    None is less than LEAST_SHARE of its usual value, all usual values scaled by one factor to
    these errors: few stretches cannot show that a source is absent, and a covariance without it
    would be far too sure where the robot then moves otherwise.
    """
    usual = np.concatenate([USUAL_NOISE.variances, USUAL_NOISE.reference])
    by_usual = units @ usual
    least = LEAST_SHARE * usual * (by_usual @ squares) / (by_usual @ by_usual)
    size = np.maximum(np.linalg.norm(units, axis=0), np.finfo(float).tiny)
    more = nnls(units / size, np.maximum(squares - units @ least, 0.0))[0] / size
    return np.asarray(least + more)


def _by_reference(reference: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """Variances (K, 3, 2) of a motion's x, y, yaw by those of position and yaw at both ends."""
    moved = se2.between(reference[first], reference[last])
    found = np.zeros((len(first), len(COMPONENTS), 2))
    found[:, :2, 0] = 2.0
    found[:, 0, 1], found[:, 1, 1] = moved[:, 1] ** 2, moved[:, 0] ** 2  # the first yaw is a lever
    found[:, 2, 1] = 2.0
    return found
