"""Positions that scatter from one to the next, as those of single-point GNSS do."""

import math
from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level

NOISY_M = 0.15
EVEN = 1 / 3  # of the second differences of positions, by how evenly the treads drove
TWICE = 2.0  # as uneven as the treads drove: no slip makes positions so
FEWEST = 20  # second differences with known treads


def noisy_positions(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> Iterator[Finding]:
    """One finding where positions are noisy for certain; parameters as of `position_noise_m`."""
    sigma = position_noise_m(evidence, stamps_s, positions)
    if sigma is not None:
        yield Finding(
            "noisy_positions",
            Level.NOTE,
            f"positions scatter by {sigma:.2f} m from one to the next",
            "Positions are noisy (single-point GNSS), or of two places in turn (two antennas)",
            f"State it: --position-sigma {sigma:.2f} and a longer --horizon (identify, compare); "
            "`run` and `batch` take it from the recording where [filter] position_sigma_m is less",
        )


def position_noise_m(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> float | None:
    """Noise of positions that are noisy for certain, in their unit; None where they are not.

    Second differences of neighbours are noise where the robot drives evenly by its treads: they
    are taken from the third of them where it does so most. The noise must be more than what is
    uneven there, and than `NOISY_M`.

    Parameters
    ----------
    evidence : Evidence
    stamps_s : (M,)
        Ascending.
    positions : (M, 2)
    """
    uneven_m = _unevenness_m(evidence, stamps_s)
    if np.isfinite(uneven_m).sum() < FEWEST:
        return None
    even = uneven_m <= np.nanquantile(uneven_m, EVEN)
    second = np.diff(positions, n=2, axis=0)[even]
    of_second = 1.4826 * float(np.median(np.abs(second)))  # of one axis, as `driving` below
    scale = evidence.metres_per_metre or 1.0
    driving = scale * float(np.median(uneven_m[even])) / math.sqrt(2.0)
    if not 1 / 30 < scale < 30:  # in another unit: which of both is, is not known here
        of_second, driving = min(of_second, of_second / scale), 0.0
    if of_second <= TWICE * driving:
        return None
    sigma = math.sqrt((of_second**2 - driving**2) / 6.0)
    return sigma if sigma > NOISY_M else None


def _unevenness_m(evidence: Evidence, stamps_s: FloatArray) -> FloatArray:
    """How far the treads carry the robot from where an even drive would, (M - 2,)."""
    of = evidence.integrals
    left_m, right_m = np.diff(of.left_m(stamps_s)), np.diff(of.right_m(stamps_s))
    turn = np.diff(of.gyroscope_rad(stamps_s))
    turn = np.where(np.isfinite(turn), turn, (right_m - left_m) / evidence.run.robot.track_width)
    step_m = (left_m + right_m) / 2
    turn = (turn[1:] + turn[:-1]) / 2
    return np.asarray(np.hypot(step_m[1:] * np.cos(turn) - step_m[:-1], step_m[1:] * np.sin(turn)))
