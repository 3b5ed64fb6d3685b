"""What carries a robot between its measured positions, and how accurate that is."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import OdometryError
from odometry.geometry import se2
from odometry.identification.fitted import Fit
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import fit_stretches, stretches_for
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import Record
from odometry.windows.stretches.stretch_motion import antenna_ways, carried, rotations
from odometry.windows.stretches.stretch_noise import UNKNOWN_NOISE
from odometry.windows.stretches.stretches import Stretches, position_record_with_yaw_rates
from odometry.windows.travel.motion import level_path

PREFERRED = ("icr", "icr_symmetric")  # the first that the positions determine
LEAST_POSITION_M, LEAST_WANDER_M, LEAST_WANDER_RAD = 0.005, 0.005, 0.002
GYROSCOPE_RAD = 0.005  # by the root of a second: what its bias leaves
BIAS_RAD_S, GYROSCOPE_SCALE = 0.03, 0.02  # of a gyroscope, one standard deviation
VEER_RAD_M, TREADS_SCALE = 0.03, 0.1  # of yaw by treads: by a metre of travel, by a rad turned
SLIP_RAD = 0.1  # by the root of a rad turned by the treads alone: what slip leaves
SCALE_RAD = 0.03  # by the root of a rad turned: what its scale may be off by


@dataclass(frozen=True)
class Carrier:
    """The antenna's motion between M measured positions, as treads and gyroscope have it.

    Attributes
    ----------
    record : Record
    steps : (D, M - 1, 3)
        From each position to the next, in the frame of the one before: by the identified values,
        and by the corners of their uncertainty.
    step_variances : (M - 1, 3)
        Of these: along, across [m^2] and yaw [rad^2].
    drifts : (M - 1, 2)
        What two constant errors of the carried yaw act by: time [s] by the gyroscope or travel [m]
        by the treads, and the turn [rad].
    drift_sigmas : (2,)
        Standard deviations of these errors: per s or m, and per rad.
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
    drifts: FloatArray
    drift_sigmas: FloatArray
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
    paths = [_antenna_path(fitted, values, record, stretches) for values in _corners(fitted)]
    at = record.pose_samples
    path = paths[0]
    seen = path[at]
    motion = se2.between(path[stretches.first][:, None], path[_samples(stretches)])
    turned = rotations(motion[..., :2], stretches.measured)
    by_gyroscope = stretches.turns_rad is not None
    lasts = record.pose_s if by_gyroscope else record.travel_m[at]
    sigmas = (BIAS_RAD_S, GYROSCOPE_SCALE) if by_gyroscope else (VEER_RAD_M, TREADS_SCALE)
    return Carrier(
        record,
        np.stack([_steps(each[at]) for each in paths]),
        _step_variances(fitted, record, stretches, seen[:, 2]),
        np.column_stack([np.diff(lasts), np.diff(seen[:, 2])]),
        np.array(sigmas),
        max((fitted.noise or UNKNOWN_NOISE).position_m, LEAST_POSITION_M) ** 2,
        float(seen[0, 2] + turned[0] - path[stretches.first[0], 2]),
        by_gyroscope,
    )


def _steps(seen: FloatArray) -> FloatArray:
    steps = se2.between(seen[:-1], seen[1:])
    steps[:, 2] = np.diff(seen[:, 2])
    return steps


def _corners(fitted: Fit) -> FloatArray:
    """Values (1 + 2 F, P): the identified, and the cubature points of their covariance."""
    free = [parameter.name in fitted.names for parameter in fitted.model.parameters]
    variances, axes = np.linalg.eigh(fitted.covariance)
    away = (axes * np.sqrt(np.maximum(variances, 0.0) * len(variances))).T
    corners = np.tile(fitted.packed, (1 + 2 * len(away), 1))
    corners[1:, free] += np.concatenate([away, -away])
    return corners


def _samples(of: Stretches) -> IntArray:
    return of.ends.last.reshape(-1, of.steps)


def _fit(stretches: Stretches, run: Run) -> Fit:
    """The first of PREFERRED that the stretches determine."""
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


def _antenna_path(fitted: Fit, values: FloatArray, record: Record, of: Stretches) -> FloatArray:
    """Poses (N, 3) of the antenna at each sample, its yaw that of the robot."""
    twists = carried(fitted.model, of).twist(values, record.inputs)
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
