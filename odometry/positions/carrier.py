"""What carries a robot between its measured positions, and how far that is to be trusted."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import OdometryError
from odometry.geometry import se2
from odometry.identification.config import SolverConfig
from odometry.identification.fitted import Fit
from odometry.identification.from_positions import stretches_for
from odometry.identification.stretch_fit import fit_stretches
from odometry.models.catalogue import MODELS
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.motion import level_path
from odometry.windows.record import Record
from odometry.windows.stretch_motion import antenna_ways, carried, rotations
from odometry.windows.stretch_noise import UNKNOWN_NOISE
from odometry.windows.stretches import Stretches, position_record_with_yaw_rates

PREFERRED = ("icr", "icr_symmetric")  # the first that the positions tell
LEAST_POSITION_M, LEAST_WANDER_M, LEAST_WANDER_RAD = 0.005, 0.005, 0.002
GYROSCOPE_RAD = 0.005  # by the root of a second: what its bias leaves
SLIP_RAD = 0.1  # by the root of a rad turned by the treads alone: what slip leaves
SCALE_RAD = 0.03  # by the root of a rad turned: what its scale may be off by


@dataclass(frozen=True)
class Carrier:
    """The antenna's motion between M measured positions, as treads and gyroscope have it.

    Attributes
    ----------
    record : Record
    steps : (M - 1, 3)
        From each position to the next, in the frame of the one before.
    step_variances : (M - 1, 3)
        Of these: along, across [m^2] and yaw [rad^2].
    position_variance_m2 : float
        Of a measured position along each axis.
    first_yaw_rad : float
        Yaw at the first position, roughly.
    by_gyroscope : bool
        Whether a gyroscope carries the yaw, and not the treads.
    """

    record: Record
    steps: FloatArray
    step_variances: FloatArray
    position_variance_m2: float
    first_yaw_rad: float
    by_gyroscope: bool


def carrier_of(run: Run) -> Carrier:
    """Identify a simple model on the positions of a run, and let it carry the robot.

    Raises
    ------
    OdometryError
        If there are too few positions, or no model can be identified on them.
    """
    config = WindowConfig()
    stretches = stretches_for([run], config)
    fitted = _fit(stretches, run)
    record = position_record_with_yaw_rates(run, config)
    path = _antenna_path(fitted, record, stretches)
    seen = path[record.pose_samples]
    steps = se2.between(seen[:-1], seen[1:])
    steps[:, 2] = np.diff(seen[:, 2])
    motion = se2.between(path[stretches.first][:, None], path[_samples(stretches)])
    turned = rotations(motion[..., :2], stretches.measured)
    first_yaw_rad = seen[0, 2] + turned[0] - path[stretches.first[0], 2]
    return Carrier(
        record,
        steps,
        _step_variances(fitted, record, stretches, seen[:, 2]),
        max((fitted.noise or UNKNOWN_NOISE).position_m, LEAST_POSITION_M) ** 2,
        float(first_yaw_rad),
        stretches.turns_rad is not None,
    )


def _samples(of: Stretches) -> IntArray:
    return of.ends.last.reshape(-1, of.steps)


def _fit(stretches: Stretches, run: Run) -> Fit:
    """The first of PREFERRED that the stretches tell."""
    *better, simplest = PREFERRED
    for name in better:
        try:
            fitted = fit_stretches(
                MODELS[name], stretches, run.robot, fixed={}, solver_config=SolverConfig(starts=2)
            )
        except OdometryError:
            continue
        if not fitted.undetermined and not fitted.at_bound:
            return fitted
    return fit_stretches(
        MODELS[simplest], stretches, run.robot, fixed={}, solver_config=SolverConfig(starts=2)
    )


def _antenna_path(fitted: Fit, record: Record, of: Stretches) -> FloatArray:
    """Poses (N, 3) of the antenna at each sample, its yaw that of the robot."""
    twists = carried(fitted.model, of).twist(fitted.packed, record.inputs)
    path = level_path(twists, np.append(np.diff(record.stamps_s), 0.0), record.inputs)
    ways, _ = antenna_ways(path[None], of.arm_m)
    return np.column_stack([ways[0], path[:, 2]])


def _step_variances(fitted: Fit, record: Record, of: Stretches, turn_rad: FloatArray) -> FloatArray:
    _, wander_m, wander_rad = np.sqrt((fitted.noise or UNKNOWN_NOISE).variances)
    travel_m = np.diff(record.travel_m[record.pose_samples])
    place_m2 = max(wander_m, LEAST_WANDER_M) ** 2 * travel_m
    turned_rad = np.abs(np.diff(turn_rad))
    yaw_rad2 = max(wander_rad, LEAST_WANDER_RAD) ** 2 * travel_m + SLIP_RAD**2 * turned_rad
    if of.turns_rad is not None:
        yaw_rad2 = GYROSCOPE_RAD**2 * np.diff(record.pose_s) + SCALE_RAD**2 * turned_rad
    return np.column_stack([place_m2, place_m2, yaw_rad2])
