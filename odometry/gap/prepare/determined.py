"""Whether the calibration runs determine what of the base model the measured runs show."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import GapError
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.derivative import whitened_derivative
from odometry.gap.solve import steps_within
from odometry.identification.fitted import SHOWN, Undetermined
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.dense.dense_noise import whitening

MOST_SIZES = 1.0  # standard deviation of a combination of parameters, in their ordinary sizes
SHOWN_SIGMAS = 1.0  # by which this deviation moves each measured number
LEAST_POWER = 1e-12  # of a combination on which nothing in the calibration depends


def require_determined(calibration: Calibration, measured: Sequence[DenseWindows]) -> None:
    """Refuse a base of which the calibration leaves open what the measured runs depend on.

    Its errors there would be taken for a missing effect: of calibration runs that stand, or go
    straight on, and measured runs that turn.

    Raises
    ------
    GapError
        Naming the combinations of parameters.
    """
    uncertain, base = calibration.uncertain, calibration.base
    count = int(uncertain.free.sum())
    sizes = np.asarray(base.model.ordinary_sizes(base.robot))[uncertain.free]
    powers, directions = np.linalg.eigh(sizes[:, None] * _alone(calibration, count) * sizes)
    moves = _derivative(calibration, measured)[:, :count] * sizes
    deviations = np.maximum(powers, LEAST_POWER) ** -0.5
    moved = np.sqrt(np.mean((moves @ directions) ** 2, axis=0)) * deviations
    found = [
        _named(directions[:, place], uncertain.names, powers[place])
        for place in np.flatnonzero((deviations > MOST_SIZES) & (moved > SHOWN_SIGMAS))
    ]
    if found:
        raise GapError(
            f"the calibration runs do not determine {base.model.name!r}, and on the measured runs "
            f"it would look like a missing effect: {'; '.join(found)}; expected calibration runs "
            "that turn both ways at several speeds, or a parameter set (--model)"
        )


def _alone(calibration: Calibration, count: int) -> FloatArray:
    """Information (P, P) of the parameters when latency and gyroscope are found beside them."""
    whole = calibration.information
    own, between, beside = whole[:count, :count], whole[:count, count:], whole[count:, count:]
    return np.asarray(own - between @ np.linalg.pinv(beside) @ between.T)


def _derivative(calibration: Calibration, scenes: Sequence[DenseWindows]) -> FloatArray:
    """Measured numbers, of unit variance, by the free numbers of the base (N, F)."""
    uncertain = calibration.uncertain
    steps = steps_within(uncertain.values, uncertain.scales, uncertain.bounds)
    whiteners = [whitening(scene, calibration.noise) for scene in scenes]
    low, high = uncertain.bounds
    moving = (uncertain.values > low) & (uncertain.values < high)
    return moving * whitened_derivative(
        lambda of: (uncertain.at(of), ()), uncertain.values, steps, scenes, whiteners
    )


def _named(direction: FloatArray, names: Sequence[str], power: float) -> str:
    shares = {
        name: float(share)
        for name, share in zip(names, direction, strict=False)
        if abs(share) >= SHOWN
    }
    nothing = power <= LEAST_POWER
    return Undetermined(shares, np.inf if nothing else float(power**-0.5)).words()
