"""Fitness J of whole runs, each row under parameters that did not see it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.fitting import SplitModels
from odometry.comparison.split import Part
from odometry.effects.measured import robot_run, shared_measurement
from odometry.effects.tables import effects_of
from odometry.errors import OdometryError
from odometry.evaluation.open_loop import Fitness, fitness, measured_poses, open_loop
from odometry.run_inputs import inputs_of


@dataclass(frozen=True)
class RunFitness:
    """Dead reckoning of a whole run under one model, each row held out."""

    robot: str
    run: str
    model: str
    fitness: Fitness


def run_fitness(split_models: Sequence[SplitModels], models: Sequence[str]) -> list[RunFitness]:
    """Dead-reckon runs from their first poses under each model (Martinez 2024 eq. 13).

    A run over several terrains, or of which each half is held out in turn, changes parameters on
    its way. A model that failed on a part of a run has no fitness of it. Where a model has effects
    on the measurement, it is evaluated with the poses of the robot.
    """
    parts: dict[str, list[tuple[Part, SplitModels]]] = {}
    for each in split_models:
        for part in each.split.held_out:
            parts.setdefault(part.name, []).append((part, each))
    found = []
    for of_run in parts.values():
        for model in models:
            try:
                found.append(_fitness(of_run, model))
            except (OdometryError, KeyError):
                continue  # the evaluated windows say why
    return found


def _fitness(parts: Sequence[tuple[Part, SplitModels]], model: str) -> RunFitness:
    run, name = parts[0][0].run, parts[0][0].name
    twists = _twists(parts, model)
    effects = [effects_of(fitted.predictors[model].model) for _, fitted in parts]
    robot = robot_run(run, shared_measurement(effects))
    result = fitness(open_loop(robot, twists), *measured_poses(robot))
    return RunFitness(parts[0][1].split.robot, name, model, result)


def _twists(parts: Sequence[tuple[Part, SplitModels]], model: str) -> FloatArray:
    """Twists (N, 3) at all rows of a run, from the parts that it falls into."""
    run = parts[0][0].run
    inputs, twists = inputs_of(run), np.empty((len(run.odometry), 3))
    for part, fitted in parts:
        rows, predictor = np.flatnonzero(part.rows), fitted.predictors[model]
        twists[rows] = predictor.model.twist(predictor.packed, inputs.rows(rows))
    return twists
