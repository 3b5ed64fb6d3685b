"""Runs whose reference is positions without yaw: how long their stretches have to be."""

from collections.abc import Sequence

import numpy as np

from odometry.identification.config import SolverConfig
from odometry.identification.fitted import Fit
from odometry.identification.stretch_fit import fit_stretches
from odometry.models.catalogue import MODELS
from odometry.run import Robot, Run
from odometry.windows.config import WindowConfig
from odometry.windows.measured_poses import lacks_yaw
from odometry.windows.stretch_noise import UNKNOWN_NOISE, StretchNoise
from odometry.windows.stretches import MOST_POSITIONS, Stretches, stretches_of
from odometry.windows.windows import Windows, windows_of

LEAST_M = 2.0  # wheel travel of a stretch, in a short run
USUAL_M, USUAL_BY_TREADS_M = 5.0, 10.0  # longer where turns are known from treads alone
MOST_M = 50.0
ENOUGH = 8  # stretches of all runs together
DIRECTION_RAD = 0.02  # accuracy aimed at for the direction of a stretch
COARSE_RAD = 0.06  # least accuracy
LINE = np.sqrt(12 / MOST_POSITIONS)  # of n evenly spaced positions, by noise over length
SIMPLE = "icr_symmetric"  # the model under which the noise is found


def windows_or_stretches(runs: Sequence[Run], config: WindowConfig) -> Windows | Stretches:
    """Windows between poses; stretches of positions where one of the runs lacks yaw.

    Raises
    ------
    WindowError
        See `windows_of` and `stretches_of`.
    IdentificationError
        If the noise of the positions cannot be estimated.
    """
    if not any(map(lacks_yaw, runs)):
        return windows_of(runs, config)
    return stretches_for(runs, config)


def stretches_for(runs: Sequence[Run], config: WindowConfig) -> Stretches:
    """Stretches that are long enough for positions to determine their direction.

    The noise of the positions is found from a simple model on stretches of USUAL_BY_TREADS_M. A
    horizon of `config` that is longer than these stretches is taken instead.
    """
    first = stretches_of(runs, max(USUAL_BY_TREADS_M, config.horizon_m), config)
    length_m = max(length_for(noise_of(first, runs[0].robot), first), config.horizon_m)
    return stretches_of(runs, length_m, config)


def noise_of(of: Stretches, robot: Robot) -> StretchNoise:
    """The noise of stretches, beside a simple model identified on them."""
    fitted = fit_stretches(
        MODELS[SIMPLE], of, robot, fixed={}, solver_config=SolverConfig(starts=2)
    )
    return fitted.noise or UNKNOWN_NOISE


def length_for(noise: StretchNoise, of: Stretches) -> float:
    """Wheel travel [m] over which positions of this noise determine a direction to DIRECTION_RAD.

    Not longer than leaves ENOUGH stretches, whose spread shows the errors of a model that are the
    same all along one, unless the noise would then exceed COARSE_RAD.
    """
    usual_m = USUAL_BY_TREADS_M if of.turns_rad is None else USUAL_M
    share_m = of.travel_m.sum() / ENOUGH
    for_noise_m = LINE * noise.position_m / np.array([DIRECTION_RAD, COARSE_RAD])
    wanted_m = min(for_noise_m[0], max(for_noise_m[1], share_m))
    return float(np.clip(wanted_m, np.clip(share_m, LEAST_M, usual_m), MOST_M))


def position_notes(fit: Fit) -> tuple[str, ...]:
    """Sentences: what a fit to positions is based on, and what positions do not determine."""
    of, noise = fit.windows, fit.noise
    if noise is None or not isinstance(of, Stretches):
        return ()
    turns = "the treads alone" if of.turns_rad is None else "the gyroscope"
    basis = (
        f"positions without yaw: the shapes of {len(of)} stretches of {of.travel_m.mean():.1f} m "
        f"count, for positions with a noise of {noise.position_m:.2g} m; between positions the "
        f"yaw is carried by {turns}"
    )
    if of.arm_stated:
        return (basis,)
    return (
        basis,
        "[sensors] pose is not stated, so the antenna is taken to be at the robot's origin; an "
        "antenna ahead of it looks exactly like a smaller x_icr, one to the left like smaller "
        "y_left and y_right",
    )
