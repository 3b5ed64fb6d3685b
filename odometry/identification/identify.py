"""Identify one model from recorded runs, terrain by terrain, and a simpler one where it fails."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from tqdm import tqdm

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.measured import on_measurement, robot_run
from odometry.effects.tables import effects_of
from odometry.errors import IdentificationError, OdometryError, ParameterError
from odometry.identification.fit import Fit
from odometry.identification.fitters import FitTo, TerrainModel, Wanted, fitter, model_on_terrain
from odometry.identification.halves import (
    MOST_FOLDS,
    Halves,
    by_halves,
    by_runs,
    halves_of,
    held_out_errors,
)
from odometry.identification.identification import Identification, Identified
from odometry.identification.runs_apart import runs_apart
from odometry.identification.shorter_windows import enough_of
from odometry.identification.start import SolverConfig
from odometry.identification.stretch_fit import windows_or_stretches
from odometry.identification.two_kinds import two_kinds
from odometry.models.catalogue import MODELS
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import UNKNOWN, Robot, Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.windows.config import WindowConfig
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows, windows_of
from odometry.windows.window_errors import WindowErrors, errors_over

SIMPLE = "icr_symmetric"  # two factors: a scale and an effective width


def identify(
    runs: Sequence[Run],
    model: Wanted,
    *,
    fixed: Mapping[str, float] | None = None,
    released: Sequence[str] = (),
    terrain: str | None = None,
    window_config: WindowConfig | None = None,
    solver_config: SolverConfig | None = None,
    show_progress: bool = False,
) -> Identification:
    """Fit a model to runs, one fit for each terrain that they name.

    Parameters
    ----------
    runs : sequence of Run
        Of one robot, with poses; or with positions, where fewer than half of them have a yaw.
    model : str, KinematicModel or ParameterSet
        A name of the catalogue; or a set, of which the models are taken with their effects and
        with what they know of the robot, and all else is identified anew.
    fixed : Mapping of name to float, optional
        Parameters held at a value.
    released : sequence of str
        Known parameters (the track width, the mass ...) to identify all the same.
    terrain : str, optional
        The terrain of runs that name none.
    window_config, solver_config : optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    IdentificationError
        If the runs are of robots of different width, or too short, or lack poses.
    ParameterError
        If there is no such model, effect or parameter, a set with several tables lacks a terrain,
        or `terrain` is the reserved name.
    RunFolderError
        If a run is given twice.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> identified = odometry.identify([run], "icr", terrain="yard")
    >>> fit = identified.terrains["yard"].fit
    >>> f"y_left - y_right = {fit.values['y_left'] - fit.values['y_right']:.1f} m"
    'y_left - y_right = 0.8 m'
    >>> identified.to_parameter_set().terrains["yard"].model
    'icr'
    """
    window_config, solver_config = window_config or WindowConfig(), solver_config or SolverConfig()
    if terrain == UNKNOWN:
        raise ParameterError(f"the terrain name {UNKNOWN!r} is reserved; name another, or none")
    check_no_run_twice(runs)
    robot = robot_of(runs)
    named = [with_named_terrain(run, terrain) for run in runs]
    windows = windows_or_stretches(named, window_config)
    models = {
        str(name): model_on_terrain(str(name), model, robot)
        for name in dict.fromkeys(windows.terrain)
    }
    by_terrain = {
        name: _windows_on(name, effects_of(of.model), named, windows, window_config)
        for name, of in models.items()
    }
    runs_by_terrain = (len(set(here.run)) for here, _ in by_terrain.values())
    fits = sum(
        3 + (min(count, MOST_FOLDS) + count if count > 1 else 0) for count in runs_by_terrain
    )
    terrains = {}
    with tqdm(total=fits, unit="fit", disable=None if show_progress else True) as bar:
        for name, (here, cut) in by_terrain.items():
            bar.set_description(models[name].model.name)
            given = _given(models[name], fixed or {}, released)
            fit_to = fitter(
                models[name].model,
                robot,
                fixed=given,
                released=frozenset(released),
                window_config=window_config,
                solver_config=solver_config,
            )
            found = _identified(here, _counted(fit_to, bar), robot, given)
            kinds = None if found.apart else two_kinds(here, fit_to, found.fit)
            terrains[name] = replace(found, kinds=kinds, horizon_m=cut.travel_m)
    return Identification(robot, terrains, window_config)


def _given(
    model: TerrainModel, fixed: Mapping[str, float], released: Sequence[str]
) -> Mapping[str, float]:
    """Parameters that are held: those of `fixed`, then what a set knows of the robot."""
    known = {name: value for name, value in model.known.items() if name not in released}
    return {**known, **fixed}


def _windows_on(
    terrain: str,
    effects: Sequence[Added],
    runs: Sequence[Run],
    as_measured: Windows | Stretches,
    config: WindowConfig,
) -> tuple[Windows | Stretches, WindowConfig]:
    """Windows on one terrain, of the robot's poses, and the settings by which they were cut."""
    windows = as_measured
    if on_measurement(effects):
        if isinstance(windows, Stretches):
            raise IdentificationError(
                f"[{terrain}] the set has effects on the measured pose, which are undone where yaw "
                "was measured; pose.csv has positions alone: state [sensors] pose instead"
            )
        runs = [robot_run(run, effects) for run in runs]
        windows = windows_of(runs, config)
    here = windows.where(windows.terrain == terrain)
    return (here, config) if isinstance(here, Stretches) else enough_of(here, runs, config)


def _counted(fit_to: FitTo, bar: tqdm) -> FitTo:
    def counted(windows: Windows | Stretches, near: Mapping[str, float] | None = None) -> Fit:
        fitted = fit_to(windows, near)
        bar.update()
        return fitted

    return counted


def robot_of(runs: Sequence[Run]) -> Robot:
    """The robot that all runs share: the first one's, with what only others state of its size.

    Raises
    ------
    IdentificationError
        If there is no run, or two state different track widths, lengths or masses.
    """
    if not runs:
        raise IdentificationError("no run was given; expected one or more")
    robot = runs[0].robot
    for name in ("track_width", "length", "mass"):
        stated = {getattr(r.robot, name): r for r in runs if getattr(r.robot, name) is not None}
        if len(stated) > 1:
            (here, first), (there, second), *_ = stated.items()
            raise IdentificationError(
                f"{second.folder}: [robot] {name} = {there}, but {first.folder} has {here}; "
                "expected runs of one robot"
                + (", with its own mass also where it carries a load" if name == "mass" else "")
            )
        if stated:
            robot = replace(robot, **{name: next(iter(stated))})
    return robot


def _identified(
    windows: Windows | Stretches, fit_to: FitTo, robot: Robot, given: Mapping[str, float]
) -> Identified:
    fitted = fit_to(windows)
    ideal = errors_over(MODELS["differential_drive"], np.array([robot.track_width]), windows)
    halves = halves_of(windows, fit_to, fitted.values)
    held_out = _held_out(windows, fit_to, fitted.values, halves)
    apart = runs_apart(windows, fit_to, fitted.values)
    return Identified(fitted, *held_out, ideal, given, halves, apart)


def _held_out(
    windows: Windows | Stretches,
    fit_to: FitTo,
    near: Mapping[str, float],
    halves: Halves | None,
) -> tuple[WindowErrors | None, str]:
    """Errors by runs, else by halves of every run, and which it was.

    The fit to all windows is where these searches start, and nothing else.
    """
    try:
        by_run = held_out_errors(windows, by_runs(windows), lambda part: fit_to(part, near))
    except IdentificationError:
        if halves is None:
            return None, ""
        others = iter((halves.second, halves.first))
        return held_out_errors(windows, by_halves(windows), lambda _: next(others)), "halves"
    return by_run, "runs"


def simpler_model(found: Identification) -> Identification | None:
    """`SIMPLE` on the same windows, where a refused identification left parameters open.

    None where the identified model does not explain the runs, has effects or is as simple, or
    where the runs do not determine this one either. Nothing is held out.
    """
    models = [one.fit.model for one in found.terrains.values()]
    if found.unexplained or any(model.name == SIMPLE or effects_of(model) for model in models):
        return None
    fit_to = fitter(
        MODELS[SIMPLE],
        found.robot,
        fixed={},
        window_config=found.window_config,
        solver_config=SolverConfig(),
    )
    try:
        terrains = {
            terrain: replace(one, fit=fit_to(one.fit.windows), held_out=None, given={})
            for terrain, one in found.terrains.items()
        }
        simpler = replace(found, terrains=terrains)
        simpler.require_determined()
    except OdometryError:
        return None
    return simpler
