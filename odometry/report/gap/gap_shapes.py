"""The shape of what is unknown: smooth functions of a variable, with their intervals."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import FloatArray
from odometry.effects.unknown.history import BOTH, History
from odometry.effects.unknown.residual import (
    COMPONENTS,
    TREADS,
    WORLD,
    Residual,
    basis_of,
    variable_of,
)
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.gap.answer.answer import WITHIN_95
from odometry.gap.answer.result import GapResult, NamedEffect
from odometry.gap.locate.region_words import noun_of, shown_unit
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Picture
from odometry.report.gap.gap_figures import AFTER, WIDTH_IN
from odometry.report.gap.gap_places import place_picture

POINTS = 200
TAILS = 0.01  # of the samples on either side are not drawn
HEIGHT_IN = 2.3
ADDED_TO = {
    "world_x": "velocity along x",
    "world_y": "velocity along y",
    "left": "left tread",
    "right": "right tread",
    BOTH: "both treads",
}


def shape_pictures(result: GapResult, folder: Path) -> list[Picture]:
    """One for each smooth function that was added."""
    found: list[Picture] = []
    for effect in result.effects:
        file = folder / f"gap_shape_{len(found) + 1}.png"
        residual = effect.added.effect
        if isinstance(residual, ResidualOfPlace):
            found.append(place_picture(result, effect, residual, file))
        elif isinstance(residual, Residual):
            found.append(_picture(result, effect, residual, file))
    return found


def shape_of(effect: NamedEffect, variable: FloatArray) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Value and standard deviation (N,) of each component of the motion that it adds to.

    At values (N,) of the variable; parameters are taken as independent. Of a history the weight
    at each lag; in the first run, where each run has its own.
    """
    residual = effect.added.effect
    if not isinstance(residual, Residual):
        raise TypeError(f"the effect is {residual.name}, expected a residual")
    basis = basis_of(variable, residual.knots)
    sigmas = (effect.high - effect.low) / (2 * WITHIN_95)
    shapes = {}
    for component in (*COMPONENTS, *WORLD, *TREADS, BOTH):
        own = [i for i, (name, _) in enumerate(residual.terms) if name == component]
        if own:
            columns = basis[:, [residual.terms[i][1] for i in own]]
            variance = columns**2 @ sigmas[own] ** 2
            shapes[component] = (columns @ effect.added.values[own], np.sqrt(variance))
    return shapes


def _span(result: GapResult, residual: Residual) -> tuple[float, float]:
    """Of the values recorded; a turn where the function is one of an angle."""
    if not residual.knots:
        return -np.pi, np.pi
    if isinstance(residual, History):
        return residual.knots[0], residual.knots[-1]
    base = result.base
    twists = [base.model.twist(base.values, scene.inputs) for scene in result.measured_scenes]
    of_scenes = [
        variable_of(residual.variable, scene.inputs, twist)
        for scene, twist in zip(result.measured_scenes, twists, strict=True)
    ]
    recorded = np.concatenate([values.ravel() for values in of_scenes if values is not None])
    low, high = np.quantile(recorded, [TAILS, 1 - TAILS])
    return float(low), float(high)


def _picture(result: GapResult, effect: NamedEffect, residual: Residual, file: Path) -> Picture:
    low, high = _span(result, residual)
    at = np.linspace(low, high, POINTS, dtype=np.float64)
    shapes = shape_of(effect, at)
    unit, factor = shown_unit(residual.variable)
    noun = noun_of(residual.variable)
    parameters = zip(residual.terms, residual.parameters, strict=False)
    units = {component: parameter.unit for (component, _), parameter in parameters}

    def draw(figure: Figure) -> None:
        panels = figure.subplots(1, len(shapes), squeeze=False)[0]
        for axes, (component, (value, sigma)) in zip(panels, shapes.items(), strict=True):
            reach = WITHIN_95 * sigma
            axes.axhline(0.0, color="#555555", linewidth=0.8)
            axes.fill_between(
                factor * at, value - reach, value + reach, color=AFTER.colour, alpha=0.25, lw=0
            )
            axes.plot(factor * at, value, color=AFTER.colour, linewidth=1.8)
            unit_of = units[component] or "share"
            axes.set_title(f"{ADDED_TO.get(component, component)} [{unit_of}]", loc="left")
            axes.set_xlabel(f"{noun} [{unit}]" if unit else noun)
            axes.grid(visible=True)
            axes.margins(x=0.0)
        figure.subplots_adjust(left=0.1, right=0.97, bottom=0.24, top=0.88, wspace=0.35)

    return Picture(
        save_figure(file, (WIDTH_IN, HEIGHT_IN), draw),
        f"What is added to the motion as a function of {noun}.",
        f"What the motion has beside the model, as a function of {noun}, over the values recorded "
        "(but one in a hundred at either end). Band: 95 %.",
    )
