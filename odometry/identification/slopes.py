"""Two stages for slopes (Martinez 2024, III-B): flat ground first, then lambda_1 and lambda_2."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.identification.config import SolverConfig
from odometry.identification.errors import IdentificationError
from odometry.identification.fit import Fit, fit
from odometry.identification.problem import Problem
from odometry.identification.solve import Solution
from odometry.identification.uncertainty import residual_scale
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.noise import pose_variances
from odometry.windows.windows import Windows

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
    near: Mapping[str, float] | None = None,
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
    icr_free = [p.name for p in Icr.parameters if p.name not in fixed]
    _check_counts(int(np.sum(~tilted)), int(np.sum(tilted)), icr_free)

    def stage(chosen: BoolArray, known: Mapping[str, float], free: frozenset[str]) -> Fit:
        return fit(
            model,
            windows.where(chosen),
            robot,
            fixed=known,
            released=free,
            near=near,
            window_config=window_config,
            solver_config=solver_config,
        )

    usual = {} if "v_max" in released else {"v_max": _largest_speed(windows)}
    held = usual | dict(fixed)
    if not icr_free:
        return stage(tilted, held, released)
    terms = {name: {**(near or {}), **held}.get(name, 0.0) for name in SLOPE_NAMES}
    for _ in range(ROUNDS):
        flat = stage(~tilted, held | terms, frozenset())
        sloped = stage(tilted, held | {name: flat.values[name] for name in flat.names}, released)
        before, terms = terms, {name: sloped.values[name] for name in (*SLOPE_NAMES, *released)}
        if max(abs(terms[name] - before[name]) for name in SLOPE_NAMES) < SETTLED:
            break
    return _joined(flat, sloped, windows, tilted, pose_variances(window_config))


def _check_counts(flat: int, tilted: int, icr_free: list[str]) -> None:
    limit = f"{np.degrees(FLAT_RAD):.1f} degrees"
    if icr_free and 3 * flat <= len(icr_free):
        raise IdentificationError(
            f"{flat} windows lie on ground flatter than {limit}, too few for "
            f"{', '.join(icr_free)}: add a run on flat ground, or fix these"
        )
    if 3 * tilted <= len(SLOPE_NAMES):
        raise IdentificationError(
            f"{tilted} windows are tilted more than {limit} (roll and pitch of odometry.csv), too "
            f"few for {', '.join(SLOPE_NAMES)}"
        )


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


def _joined(
    flat: Fit, sloped: Fit, windows: Windows, tilted: BoolArray, variances: FloatArray
) -> Fit:
    """The second stage with what the first one found, over all windows.

    The optimum of the second stage moves with the first's parameters by -H22^-1 H21, H being the
    curvature of its loss: that carries the first's covariance into the slope terms.
    """
    names = flat.names + sloped.names
    free = np.array([parameter.name in names for parameter in sloped.model.parameters])
    problem = Problem(sloped.model, sloped.windows, sloped.packed, free, variances)
    order = [problem.names.index(name) for name in names]
    jacobian = problem.jacobian(sloped.packed[free])[:, :, order]
    weighted = np.sqrt(sloped.weights)[:, None, None] * problem.whitening @ jacobian
    flattened = weighted.reshape(-1, len(names))
    first, second = flattened[:, : len(flat.names)], flattened[:, len(flat.names) :]
    moves = -np.linalg.pinv(second) @ first
    cross = moves @ flat.covariance
    weights = np.empty(len(windows))
    weights[~tilted], weights[tilted] = flat.weights, sloped.weights
    every = replace(problem, windows=windows)
    solution = Solution(sloped.packed[free], weights, np.nan, min(flat.agreeing, sloped.agreeing))
    return replace(
        sloped,
        names=names,
        covariance=np.block(
            [[flat.covariance, cross.T], [cross, sloped.covariance + cross @ moves.T]]
        ),
        undetermined=flat.undetermined + sloped.undetermined,
        at_bound=flat.at_bound + sloped.at_bound,
        residuals=every.residuals(solution.chosen),
        weights=weights,
        scale=residual_scale(every, solution),
        agreeing=solution.agreeing,
        windows=windows,
    )
