"""Fitness J of whole runs, each row under parameters that did not see it."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.judgement import RunFitness
from odometry.comparison.parts import Part
from odometry.comparison.prepare import Prepared
from odometry.effects.measured import robot_run, shared_measurement
from odometry.effects.tables import effects_of
from odometry.errors import OdometryError
from odometry.evaluation.fitness import fitness
from odometry.evaluation.open_loop import measured_poses, open_loop
from odometry.models.run_inputs import inputs_of


def run_fitness(prepared: Sequence[Prepared], models: Sequence[str]) -> list[RunFitness]:
    """Dead-reckon runs from their first poses under each model (Martinez 2024 eq. 13).

    A run over several grounds, or of which each half is judged apart, changes parameters on its
    way. A model that failed on a part of a run has no fitness of it. Where a model has effects on
    the measurement, it is judged by the poses of the robot.
    """
    parts: dict[str, list[tuple[Part, Prepared]]] = {}
    for each in prepared:
        for part in each.split.judged:
            parts.setdefault(part.name, []).append((part, each))
    found = []
    for of_run in parts.values():
        for model in models:
            try:
                found.append(_fitness(of_run, model))
            except (OdometryError, KeyError):
                continue  # said of the judged windows
    return found


def _fitness(parts: Sequence[tuple[Part, Prepared]], model: str) -> RunFitness:
    run, name = parts[0][0].run, parts[0][0].name
    twists = _twists(parts, model)
    effects = [effects_of(prepared.predictors[model].model) for _, prepared in parts]
    robot = robot_run(run, shared_measurement(effects))
    result = fitness(open_loop(robot, twists), *measured_poses(robot))
    return RunFitness(parts[0][1].split.robot, name, model, result)


def _twists(parts: Sequence[tuple[Part, Prepared]], model: str) -> FloatArray:
    """Twists (N, 3) at all rows of a run, from the parts that it falls into."""
    run = parts[0][0].run
    inputs, twists = inputs_of(run), np.empty((len(run.odometry), 3))
    for part, prepared in parts:
        rows, predictor = np.flatnonzero(part.rows), prepared.predictors[model]
        twists[rows] = predictor.model.twist(predictor.packed, inputs.rows(rows))
    return twists
