"""Two stages for slopes (Martinez 2024, III-B): flat ground first, then lambda_1 and lambda_2."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.config import SolverConfig, WindowConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.fit import Fit, fit
from odometry.identification.noise import pose_variances
from odometry.identification.problem import Problem
from odometry.identification.windows import Windows
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.run import Robot

FLAT_RAD = np.radians(1.5)  # ground tilted less than this is flat
SLOPE_NAMES = ("lambda_1", "lambda_2")
ROUNDS = 10
SETTLED = 1e-4  # change of the slope terms [s/rad] below which a round has changed nothing


def fit_in_two_stages(
    model: KinematicModel,
    windows: Windows,
    robot: Robot,
    *,
    fixed: Mapping[str, float],
    released: frozenset[str] = frozenset(),
    window_config: WindowConfig,
    solver_config: SolverConfig,
) -> Fit:
    """Identify `icr_slope`: the ICRs on the flat windows, then the slope terms on the tilted ones.

    The first round is the paper's, without slope terms in the first stage. What is called flat may
    tilt a little, so the stages are repeated with the terms found, until these stay.

    Parameters are those of `fit`. `v_max` is the largest mean tread speed in the windows unless
    it is fixed. The covariance of the slope terms holds what the first stage leaves uncertain.

    Raises
    ------
    IdentificationError
        If the flat or the tilted windows are too few for their stage.
    """
    tilted = mean_tilt_rad(windows) > FLAT_RAD
    flat_free = [p.name for p in Icr.parameters if p.name not in fixed]
    if flat_free and 3 * np.sum(~tilted) <= len(flat_free):
        raise IdentificationError(
            f"{int(np.sum(~tilted))} windows lie on ground flatter than "
            f"{np.degrees(FLAT_RAD):.1f} degrees, too few for {', '.join(flat_free)}: add a run on "
            "flat ground, or fix these"
        )
    if 3 * np.sum(tilted) <= len(SLOPE_NAMES):
        raise IdentificationError(
            f"{int(np.sum(tilted))} windows are tilted more than {np.degrees(FLAT_RAD):.1f} "
            f"degrees (roll and pitch of odometry.csv), too few for {', '.join(SLOPE_NAMES)}"
        )
    usual = {} if "v_max" in released else {"v_max": _largest_speed(windows)}
    held = usual | dict(fixed)
    terms = {name: held.get(name, 0.0) for name in SLOPE_NAMES}
    for _ in range(ROUNDS):
        flat = fit(
            model,
            windows.where(~tilted),
            robot,
            fixed=held | terms,
            window_config=window_config,
            solver_config=solver_config,
        )
        sloped = fit(
            model,
            windows.where(tilted),
            robot,
            fixed=held | {name: flat.values[name] for name in flat.names},
            released=released,
            window_config=window_config,
            solver_config=solver_config,
        )
        before, terms = terms, {name: sloped.values[name] for name in SLOPE_NAMES}
        if max(abs(terms[name] - before[name]) for name in SLOPE_NAMES) < SETTLED:
            break
    return _joined(flat, sloped, pose_variances(window_config))


def mean_tilt_rad(windows: Windows) -> FloatArray:
    """Angle (K,) between the body's z and the vertical, averaged over the samples of a window."""
    upright = np.cos(windows.inputs.roll_rad) * np.cos(windows.inputs.pitch_rad)
    tilt = np.arccos(np.clip(upright, -1.0, 1.0))
    sums = np.concatenate([[0.0], np.cumsum(tilt)])
    counts = windows.last - windows.first
    return np.asarray((sums[windows.last] - sums[windows.first]) / counts)


def _largest_speed(windows: Windows) -> float:
    """v_y^m of Martinez 2024: the largest |V_r + V_l| / 2."""
    return float(np.abs(windows.inputs.tread_speeds_m_s.mean(axis=-1)).max())


def _joined(flat: Fit, sloped: Fit, variances: FloatArray) -> Fit:
    """The second stage with the parameters of the first, and the covariance of both.

    The optimum of the second stage moves with the first's parameters by -H22^-1 H21, H being the
    curvature of its loss.
    """
    names = flat.names + sloped.names
    free = np.array([parameter.name in names for parameter in sloped.model.parameters])
    problem = Problem(sloped.model, sloped.windows, sloped.packed, free, variances)
    order = [problem.names.index(name) for name in names]
    jacobian = problem.jacobian(sloped.packed[free])[:, :, order]
    weighted = np.sqrt(sloped.weights)[:, None, None] * problem.whitening() @ jacobian
    flattened = weighted.reshape(-1, len(names))
    first, second = flattened[:, : len(flat.names)], flattened[:, len(flat.names) :]
    moves = -np.linalg.pinv(second) @ first
    cross = moves @ flat.covariance
    covariance = np.block(
        [[flat.covariance, cross.T], [cross, sloped.covariance + cross @ moves.T]]
    )
    return replace(
        sloped,
        names=names,
        covariance=covariance,
        undetermined=flat.undetermined + sloped.undetermined,
        at_bound=flat.at_bound + sloped.at_bound,
        agreeing=min(flat.agreeing, sloped.agreeing),
    )
