"""Locate the gap, name what is missing, add it, and measure what that closes."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
from tqdm import tqdm

from odometry.effects.corrected import Added
from odometry.effects.residual import Residual
from odometry.gap.calibration import Calibration, calibrated
from odometry.gap.calibration_by_terrain import by_terrain
from odometry.gap.config import GapConfig
from odometry.gap.equivalent import equivalents
from odometry.gap.errors import GapError
from odometry.gap.explanation import Explanation
from odometry.gap.fit import Fitter
from odometry.gap.locate import locate
from odometry.gap.measured import measured_of
from odometry.gap.name import explained
from odometry.gap.next_drives import NextDrive, next_drives
from odometry.gap.outliers import Outliers, cleaned_runs, closes, outliers_of
from odometry.gap.own_moments import SPACING_S, with_own_moments
from odometry.gap.pieces import held_back
from odometry.gap.result import Closing, GapResult, NamedEffect, Rival
from odometry.gap.statistic import floor_of, floor_there, gap_of
from odometry.identification.identify import robot_of
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.positions.heading import Headed, headed
from odometry.run import Run
from odometry.runs import check_no_run_twice
from odometry.windows.averaged import averaged_windows
from odometry.windows.dense import DenseWindows, covered_s, dense_windows_of, thinned

SHORTER = (1.0, 0.75, 0.5)  # of the usual duration of windows, where stretches ask for it
WITHIN_95 = 1.96  # standard deviations
MOMENT_KNOWN_S = SPACING_S  # the moment of a run held out is known as well as it was searched
SLOWEST_M_S = 0.05  # of a mean speed: a robot that stands has no horizon


def find_gap(
    measured: Sequence[Run],
    calibration: Sequence[Run],
    holdout: Sequence[Run] = (),
    *,
    model: KinematicModel | None = None,
    given: Mapping[str, float] | None = None,
    config: GapConfig | None = None,
    show_progress: bool = False,
) -> GapResult:
    """Find where a model and measured runs disagree, and which effect is missing.

    Parameters
    ----------
    measured : sequence of Run
        Runs on which the gap shows, with poses.
    calibration : sequence of Run
        Runs on which the base is identified (unless `given`), and the noise.
    holdout : sequence of Run
        Runs on which the answer is judged; pieces of the measured runs where there are none.
    model : KinematicModel, optional
        The base, `icr` when absent.
    given : Mapping of name to float, optional
        Parameters of the base, believed as they are.
    config : GapConfig, optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    GapError
        If runs are missing or too short.
    WindowError
        If a run has no poses, or the runs are of different robots.
    RunFolderError
        If a run is given twice.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> try:
    ...     odometry.find_gap([run], calibration=[run])
    ... except odometry.OdometryError as error:
    ...     print(str(error).split("; ")[1])
    expected each run once: none can be its own test
    """
    config = config or GapConfig()
    if not measured or not calibration:
        raise GapError(
            f"{len(measured)} measured and {len(calibration)} calibration runs, expected one or "
            "more of each"
        )
    check_no_run_twice([*measured, *calibration, *holdout])
    robot = robot_of([*calibration, *measured, *holdout])
    headings = headed([*measured, *calibration, *holdout])
    measured, calibration, holdout = _dealt(headings.runs, len(measured), len(calibration))
    config = for_positions(for_chains(config, headings.runs), headings)
    known_scenes, fitted_scenes, held_scenes = alike(
        [_scene(run, config) for run in calibration],
        *_scenes(measured, holdout, config),
    )
    known = by_terrain(
        calibrated(known_scenes, model or Icr(), robot, config, given), known_scenes, config
    )
    raw_scenes = fitted_scenes, held_scenes
    fitted_scenes, held_scenes, outliers = _cleaned(
        (measured, holdout), raw_scenes, known_scenes, known, config
    )
    floor = floor_of(known.held_back, config.part_s)
    fitter = Fitter(known, measured_of(fitted_scenes, known, config))
    with tqdm(desc="candidates", unit="fit", disable=None if show_progress else True) as bar:
        floors = (
            floor_there(floor, known, fitted_scenes),
            floor_there(floor, known, held_scenes),
        )
        found = explained(fitter, held_scenes, floors, config, _counting(bar))
    fit = found.fitted
    base = fit.base if found.steps or found.base_closes else known.base
    effects, held_scenes = with_own_moments(base, fit.effects, held_scenes, fitted_scenes, known)
    closings = [
        Closing(
            gap_of(known.base, (), scenes if outliers is None else raw, config.part_s),
            gap_of(base, effects, scenes, config.part_s),
            floor_there(floor, known, scenes),
        )
        for scenes, raw in zip((fitted_scenes, held_scenes), raw_scenes, strict=True)
    ]
    believed_m = gap_of(known.base, (), fitted_scenes, config.part_s).value
    named = _named(found, effects, believed_m)
    if outliers is not None:
        named = (_named_outliers(outliers, closings[0].before.value, believed_m), *named)
    equivalent = equivalents(found, config)
    return GapResult(
        verdict=named[0].added.effect.name if named else verdict_of(found, closings[1]),
        effects=named,
        equivalent=equivalent,
        location=locate(known.base, (), fitted_scenes, floor.value, config, calibration=known),
        measured=closings[0],
        holdout=closings[1],
        rivals=tuple(
            Rival(
                one.effect.name,
                one.effect.form,
                one.evidence,
                one.gap_after,
                one.effect.course,
            )
            for one in found.first
        ),
        calibration=known,
        base=base,
        measured_scenes=tuple(fitted_scenes),
        holdout_scenes=tuple(held_scenes),
        horizon_s=config.horizon_s,
        notes=headings.notes,
        next_drives=_next_drives(found, [one.name for one in equivalent], fitter, config),
        refusals=found.refusals,
        holdout_before=() if outliers is None else tuple(raw_scenes[1]),
    )


def _cleaned(
    runs: tuple[Sequence[Run], Sequence[Run]],
    scenes: tuple[list[DenseWindows], list[DenseWindows]],
    known_scenes: Sequence[DenseWindows],
    known: Calibration,
    config: GapConfig,
) -> tuple[list[DenseWindows], list[DenseWindows], Outliers | None]:
    """Measured and held-out scenes without poses that are far off, where that closes some gap."""
    held_out = scenes[1] if runs[1] else ()
    outliers = outliers_of(scenes[0], held_out, known_scenes, known, config)
    if outliers is None:
        return *scenes, None
    cut = _scenes(*cleaned_runs(*runs, outliers), config)
    _, fitted_scenes, held_scenes = alike(known_scenes, *cut)
    if not closes(scenes[1], held_scenes, known.base, config):
        return *scenes, None
    return fitted_scenes, held_scenes, outliers


def verdict_of(found: Explanation, held_out: Closing) -> str:
    """The first name; else "none" where noise explains what the base leaves, also held out."""
    if found.names:
        return found.names[0]
    above = held_out.before.low > held_out.noise_floor.high
    return "unknown" if found.unexplained or above else "none"


def _next_drives(
    found: Explanation, equivalent: Collection[str], fitter: Fitter, config: GapConfig
) -> tuple[NextDrive, ...]:
    """What would tell the first effect from what came as near in its place."""
    fits = {one.effect.name: one.fitted for one in reversed(found.first)}
    rivals = {name: fits[name] for name in equivalent if name in fits}
    if not rivals or found.names[0] not in fits:
        return ()
    first = {found.names[0]: fits[found.names[0]]}
    return next_drives({**first, **rivals}, fitter.measured.scenes, fitter.calibration, config)


def _dealt(
    runs: Sequence[Run], measured: int, calibration: int
) -> tuple[Sequence[Run], Sequence[Run], Sequence[Run]]:
    """Measured, calibration and held-out runs of all, in this order."""
    known = measured + calibration
    return runs[:measured], runs[measured:known], runs[known:]


def for_chains(config: GapConfig, runs: Sequence[Run]) -> GapConfig:
    """Shorter windows where poses are chained in stretches that longer ones do not fit into.

    The longest of those tried that leave out hardly more of the poses than the best does.
    """
    tried_s = [share * config.horizon_s for share in SHORTER]
    covered = np.sum([covered_s(run, tried_s) for run in runs], axis=0)
    enough = covered >= config.least_covered * covered.max()
    return replace(config, horizon_s=tried_s[int(np.argmax(enough))])


def for_positions(config: GapConfig, headings: Headed) -> GapConfig:
    """Longer windows where positions without yaw are too noisy for short ones.

    At most half of a piece, so that pieces still hold windows.
    """
    speeds_m_s = [
        each.run.wheel_travel_m[-1] / np.ptp(each.run.odometry.stamps_s) for each in headings.found
    ]
    if not speeds_m_s:
        return config
    needed_s = headings.least_horizon_m / max(min(speeds_m_s), SLOWEST_M_S)
    return replace(config, horizon_s=max(config.horizon_s, min(needed_s, config.part_s / 2)))


def _counting(bar: "tqdm[None]") -> Callable[[], None]:
    def count() -> None:
        bar.update()

    return count


def _scene(run: Run, config: GapConfig) -> DenseWindows:
    return averaged_windows(dense_windows_of(run, config.horizon_s))


def _scenes(
    measured: Sequence[Run], holdout: Sequence[Run], config: GapConfig
) -> tuple[list[DenseWindows], list[DenseWindows]]:
    """Scenes to fit and scenes to judge by."""
    scenes = [_scene(run, config).numbered(number) for number, run in enumerate(measured)]
    if holdout:
        held = [
            _scene(run, config).numbered(number)
            for number, run in enumerate(holdout, start=len(measured))
        ]
    else:
        outs = [held_back(scene, config.part_s, config.held_back) for scene in scenes]
        held = [s.where(out) for s, out in zip(scenes, outs, strict=True) if out.any()]
        scenes = [s.where(~out) for s, out in zip(scenes, outs, strict=True) if not out.all()]
        if not held or not scenes:
            raise GapError(
                "the measured runs are too short to hold stretches of them back: expected "
                f"{config.held_back * config.part_s:g} s or more with moving treads, or --holdout"
            )
    return [thinned(scene, config.most_windows) for scene in scenes], held


def alike(*groups: Sequence[DenseWindows]) -> tuple[list[DenseWindows], ...]:
    """The same scenes without the gyroscope where one of them has none."""
    if all(scene.reported_turns is not None for scenes in groups for scene in scenes):
        return tuple(list(scenes) for scenes in groups)
    return tuple([scene.without_gyroscope() for scene in scenes] for scenes in groups)


def _named_outliers(outliers: Outliers, before_m: float, after_m: float) -> NamedEffect:
    return NamedEffect(
        outliers.named, outliers.low, outliers.high, before_m, after_m, outliers.evidence
    )


def _named(
    found: Explanation, effects: Sequence[Added], before_m: float
) -> tuple[NamedEffect, ...]:
    fit = found.fitted
    sigmas = np.sqrt(np.maximum(np.diag(fit.covariance), 0.0))
    named, place, gap_m = [], 0, before_m
    for step, own, added in zip(found.steps, fit.effects, effects, strict=True):
        spread = WITHIN_95 * sigmas[place : place + len(own.values)]
        more = len(added.values) - len(own.values)
        likely = spread if isinstance(own.effect, Residual) else [MOMENT_KNOWN_S]
        spread = np.append(spread, np.resize(likely, more))
        place += len(own.values)
        lows, highs = np.array([(p.low, p.high) for p in added.effect.parameters]).T
        named.append(
            NamedEffect(
                added,
                np.maximum(added.values - spread, lows),
                np.minimum(added.values + spread, highs),
                gap_m,
                step.gap_after,
                step.evidence,
            )
        )
        gap_m = step.gap_after
    return tuple(named)
