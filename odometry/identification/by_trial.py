"""Parameters that act through a sign alone: they have no derivative, and are found by trying."""

from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.config import SolverConfig
from odometry.identification.problem import Problem
from odometry.identification.solve import Solution, loss, solve

COARSE, FINE = 9, 81  # values tried
ALTERNATIONS = 5


def try_values(
    problem: Problem, solution: Solution, sizes: FloatArray, place: int, config: SolverConfig
) -> tuple[Problem, Solution]:
    """Search with few values of a parameter that acts through a sign, then near the best one.

    Near it, the best of many values and the search for the rest take turns.
    """
    parameter = problem.model.parameters[place]
    ends = parameter.search or (parameter.low, parameter.high)
    plain = replace(config, starts=1, loss="squares")
    coarse = [
        replace(problem, values=_put(problem.values, place, value))
        for value in np.geomspace(*ends, COARSE)
    ]
    found = [solve(each, solution.chosen, sizes[problem.free], plain) for each in coarse]
    best = int(np.argmin([each.cost for each in found]))
    problem, chosen = coarse[best], found[best].chosen
    for _ in range(ALTERNATIONS):
        fine = [
            replace(problem, values=_put(problem.values, place, value))
            for value in np.geomspace(*ends, FINE)
        ]
        costs = np.array([loss(each, chosen, config) for each in fine])
        equal = np.flatnonzero(costs <= costs.min() * (1 + 1e-9))
        nearest = fine[int(equal[len(equal) // 2])]
        if nearest.values[place] == problem.values[place]:
            break
        problem = nearest
        chosen = solve(problem, chosen, sizes[problem.free], replace(config, starts=1)).chosen
    final = solve(problem, chosen, sizes[problem.free], replace(config, starts=1))
    return problem, replace(final, agreeing=solution.agreeing)


def _put(values: FloatArray, place: int, value: float) -> FloatArray:
    changed = values.copy()
    changed[place] = value
    return changed
