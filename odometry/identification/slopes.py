"""Two stages for slopes (Martinez 2024, III-B): flat terrain first, then tilted."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import IdentificationError
from odometry.identification.fit import Fit, fit
from odometry.identification.problem import PROBLEMS, Problem
from odometry.identification.solve import Solution
from odometry.identification.start import SolverConfig
from odometry.identification.uncertainty import residual_scale
from odometry.models.base import KinematicModel, Stages
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import Windows

FLAT_RAD = np.radians(1.5)  # terrain tilted less than this is flat
ROUNDS = 10
SETTLED = 1e-4  # change of the second stage's parameters below which a round has changed nothing


def fit_in_two_stages(
    model: KinematicModel,
    windows: Windows,
    robot: Robot,
    *,
    stages: Stages,
    fixed: Mapping[str, float],
    released: frozenset[str] = frozenset(),
    near: Mapping[str, float] | None = None,
    window_config: WindowConfig,
    solver_config: SolverConfig,
) -> Fit:
    """Identify some parameters on the flat windows, then the others on the tilted ones.

    The first round is the paper's, with the second stage's parameters at zero in the first. What is
    called flat may tilt a little, so the stages are repeated with what was found, until it stays.

    Parameters are those of `fit`, and the model's `stages`. Known parameters that the recording
    determines are taken from it unless they are fixed or released. The covariance of the second
    stage holds what the first one leaves uncertain.

    Raises
    ------
    IdentificationError
        If the flat or the tilted windows are too few for their stage.
    """
    tilted = mean_tilt_rad(windows) > FLAT_RAD
    first_free = [name for name in stages.flat if name not in fixed]
    _check_counts(int(np.sum(~tilted)), int(np.sum(tilted)), first_free, stages.tilted)

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

    known = model.determined_by(windows.inputs)
    held = {name: value for name, value in known.items() if name not in released} | dict(fixed)
    if not first_free:
        return stage(tilted, held, released)
    terms = {name: {**(near or {}), **held}.get(name, 0.0) for name in stages.tilted}
    for _ in range(ROUNDS):
        flat = stage(~tilted, held | terms, frozenset())
        sloped = stage(tilted, held | {name: flat.values[name] for name in flat.names}, released)
        before, terms = terms, {name: sloped.values[name] for name in (*stages.tilted, *released)}
        if max(abs(terms[name] - before[name]) for name in stages.tilted) < SETTLED:
            break
    free = np.isin([p.name for p in model.parameters], (*flat.names, *sloped.names))
    problem = PROBLEMS[solver_config.loss](
        model, windows.where(tilted), sloped.packed, free, pose_variances(window_config)
    )
    return _joined(flat, sloped, windows, tilted, problem)


def _check_counts(flat: int, tilted: int, first: list[str], second: tuple[str, ...]) -> None:
    limit = f"{np.degrees(FLAT_RAD):.1f} degrees"
    if first and 3 * flat <= len(first):
        raise IdentificationError(
            f"{flat} windows lie on terrain flatter than {limit}, too few for "
            f"{', '.join(first)}: add a run on flat terrain, or fix these"
        )
    if 3 * tilted <= len(second):
        raise IdentificationError(
            f"{tilted} windows are tilted more than {limit} (roll and pitch of odometry.csv), too "
            f"few for {', '.join(second)}"
        )


def mean_tilt_rad(windows: Windows) -> FloatArray:
    """Angle (K,) between the body's z and the vertical, averaged over the samples of a window."""
    upright = np.cos(windows.inputs.roll_rad) * np.cos(windows.inputs.pitch_rad)
    tilt = np.arccos(np.clip(upright, -1.0, 1.0))
    sums = np.concatenate([[0.0], np.cumsum(tilt)])
    counts = windows.last - windows.first
    return np.asarray((sums[windows.last] - sums[windows.first]) / counts)


def _joined(flat: Fit, sloped: Fit, windows: Windows, tilted: BoolArray, problem: Problem) -> Fit:
    """The second stage with what the first one found, over all windows.

    The optimum of the second stage moves with the first's parameters by -H22^-1 H21, H being the
    curvature of its loss (implicit function theorem): that carries the first's covariance over.
    """
    names = flat.names + sloped.names
    order = [problem.names.index(name) for name in names]
    jacobian = problem.jacobian(sloped.packed[problem.free])[:, :, order]
    weighted = np.sqrt(sloped.weights)[:, None, None] * problem.whitening @ jacobian
    flattened = weighted.reshape(-1, len(names))
    first, second = flattened[:, : len(flat.names)], flattened[:, len(flat.names) :]
    moves = -np.linalg.pinv(second) @ first
    cross = moves @ flat.covariance
    weights = np.empty(len(windows))
    weights[~tilted], weights[tilted] = flat.weights, sloped.weights
    every = replace(problem, windows=windows)
    agreeing = min(flat.agreeing, sloped.agreeing)
    solution = Solution(sloped.packed[problem.free], weights, np.nan, agreeing)
    return replace(
        sloped,
        names=names,
        covariance=np.block(
            [[flat.covariance, cross.T], [cross, sloped.covariance + cross @ moves.T]]
        ),
        freedom=np.append(flat.freedom, np.minimum(sloped.freedom, flat.freedom.min())),
        undetermined=flat.undetermined + sloped.undetermined,
        at_bound=flat.at_bound + sloped.at_bound,
        residuals=every.residuals(solution.chosen),
        weights=weights,
        scale=residual_scale(every, solution),
        agreeing=solution.agreeing,
        windows=windows,
        start={**sloped.start, **{name: flat.start[name] for name in flat.names}},
    )
