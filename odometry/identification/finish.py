"""The solution of a search as a fit: values, covariance, what is undetermined or at a bound."""

import numpy as np

from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fitted import Fit, undetermined
from odometry.identification.problem import AnyProblem
from odometry.identification.solve import Solution
from odometry.identification.start import Start, by_name
from odometry.identification.uncertainty import Uncertainty
from odometry.windows.stretch_noise import StretchNoise

EDGE = 1e-3  # ordinary sizes: nearer to a bound than this, a parameter is at it


def finished(
    start: Start,
    problem: AnyProblem,
    solution: Solution,
    *,
    uncertainty: Uncertainty,
    scale: float,
    noise: StretchNoise | None = None,
) -> Fit:
    """The fit of a solution.

    Parameters
    ----------
    start : Start
    problem : AnyProblem
    solution : Solution
    uncertainty : Uncertainty
    scale : float
        How many times larger the residuals are than the noise explains.
    noise : StretchNoise, optional
        Where the noise was estimated from these residuals: `scale` widens nothing then.

    Raises
    ------
    IdentificationError
        If the values contradict each other.
    """
    low, high = problem.bounds()
    sizes = start.sizes[problem.free]
    at_bound = (solution.chosen < low + EDGE * sizes) | (solution.chosen > high - EDGE * sizes)
    values = problem.complete(solution.chosen)
    try:
        problem.model.check(values)
    except ParameterError as error:
        raise IdentificationError(f"the best fit of {problem.model.name!r}: {error}") from error
    residuals, jacobian = problem.linearised(solution.chosen)
    whitened = np.sqrt(solution.weights)[:, None, None] * (problem.noise_whitening @ jacobian)
    in_sign = zip(problem.model.parameters, start.in_sign, strict=True)
    return Fit(
        model=problem.model,
        values=by_name(problem.model, values),
        names=problem.names,
        covariance=uncertainty.covariance,
        freedom=uncertainty.freedom,
        undetermined=undetermined(
            whitened.reshape(residuals.size, len(sizes)),
            problem.names,
            sizes,
            max(1.0, scale) if noise is None else 1.0,
            start.solver_config.undetermined,
        ),
        by_trial=tuple(parameter.name for parameter, sign in in_sign if sign),
        at_bound=tuple(name for name, edged in zip(problem.names, at_bound, strict=True) if edged),
        residuals=residuals,
        weights=solution.weights,
        scale=scale,
        agreeing=solution.agreeing,
        starts=start.solver_config.starts,
        windows=problem.windows,
        start=start.by_name,
        noise=noise,
    )
