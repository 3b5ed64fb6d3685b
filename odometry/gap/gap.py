"""Locate the gap, name what is missing, add it, and measure what that closes."""

from collections.abc import Callable, Mapping, Sequence

from tqdm import tqdm

from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.errors import GapError
from odometry.gap.answer.answer import (
    drives_apart,
    is_first,
    leaves_most,
    named_effects,
    named_outliers,
    rivals_of,
    verdict_of,
)
from odometry.gap.answer.equivalent import equivalents, rivals_of_one_heading
from odometry.gap.answer.named_rounding import named_rounding
from odometry.gap.answer.new_places import terrain_instead
from odometry.gap.answer.result import Closing, GapResult
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.locate.locate import locate
from odometry.gap.name.names import explained
from odometry.gap.prepare.by_terrain import by_terrain
from odometry.gap.prepare.calibration import Calibration, calibrated
from odometry.gap.prepare.held_out import held_out_pieces
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.measures import measures_of
from odometry.gap.prepare.rounding import rounding_notes
from odometry.gap.prepare.scenes import (
    alike,
    dealt,
    for_chains,
    for_positions,
    scene_of,
    scenes_of,
    without_outliers,
)
from odometry.gap.prepare.statistic import Gap, Measure, floor_of, floor_there, gap_m, gap_of
from odometry.identification.identify import robot_of
from odometry.independent_runs import check_no_run_twice
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.positions.heading import headed
from odometry.run import Run
from odometry.windows.dense import DenseWindows


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
        Runs on which the answer is evaluated; pieces of the measured runs where there are none.
    model : KinematicModel, optional
        The base, `icr` when absent.
    given : Mapping of name to float, optional
        Parameters of the base, taken as they are.
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
    measured, calibration, holdout = dealt(headings.runs, len(measured), len(calibration))
    config = for_positions(for_chains(config, headings.runs), headings)
    known_scenes, whole, held = alike(
        [scene_of(run, config) for run in calibration],
        *scenes_of(measured, holdout, config),
    )
    known = by_terrain(
        calibrated(known_scenes, model or Icr(), robot, config, given), known_scenes, config
    )
    numbers = None if holdout else held_out_pieces(whole, config)
    raw_scenes, (fitted_scenes, held_scenes), outliers = without_outliers(
        (measured, holdout), (whole, held), numbers, (known_scenes, known), config
    )
    floor = floor_of(known.held_back, config.part_s)
    fitter = Fitter(known, measured_of(fitted_scenes, known, config))
    with tqdm(desc="candidates", unit="fit", disable=None if show_progress else True) as bar:
        for measure in measures_of(
            known, fitted_scenes, held_scenes, config, has_yaw=not headings.found
        ):
            own_floor = floor_of(known.held_back, config.part_s, measure)
            floors = (
                floor_there(own_floor, known, fitted_scenes, config),
                floor_there(own_floor, known, held_scenes, config),
            )
            found = explained(fitter, held_scenes, floors, config, _counting(bar))
            if found.has_name:
                break
    fit = found.fitted
    base = fit.base if found.steps or found.base_closes else known.base
    effects, held_scenes = with_own_moments(base, fit.effects, held_scenes, fitted_scenes, known)
    after = base, effects
    scenes = (fitted_scenes, held_scenes)
    befores = scenes if outliers is None else raw_scenes
    pairs = tuple(zip(befores, scenes, strict=True))
    closings = _closings(known, after, pairs, floor, config)
    shown = _closings(known, after, pairs, own_floor, config)
    believed_m = gap_m(known.base, (), fitted_scenes)
    named = named_effects(found, effects, believed_m)
    only_outliers = outliers is not None and not named
    if outliers is not None:
        alone = gap_of(known.base, (), held_scenes, config.part_s, measure)
        if is_first(shown[1], alone, config):
            named = (named_outliers(outliers, closings[0].before.value, believed_m), *named)
        else:
            raw_m = gap_m(base, effects, raw_scenes[0])
            named = (*named, named_outliers(outliers, raw_m, closings[0].after.value))
    rounding = named_rounding(fitted_scenes, held_scenes, known, floor, config)
    if rounding is not None:
        named = (rounding, *named) if measure is Measure.POSITION else (*named, rounding)
    verdict = named[0].added.effect.name if named else verdict_of(found, shown[1])
    if only_outliers and rounding is None and leaves_most(shown[1], config):
        verdict = "unknown"
    more = rivals_of_one_heading(found, fitter, config)
    equivalent = () if verdict == "none" else equivalents(found, more, fitter, config)
    equivalent = (*equivalent, *terrain_instead(fit.effects, equivalent, fitted_scenes))
    return GapResult(
        verdict=verdict,
        effects=named,
        equivalent=equivalent,
        location=locate(known.base, (), fitted_scenes, floor.value, config, calibration=known),
        measured=closings[0],
        holdout=closings[1],
        turns=shown if measure is not Measure.POSITION else None,
        rivals=rivals_of(found),
        calibration=known,
        base=base,
        measured_scenes=tuple(fitted_scenes),
        holdout_scenes=tuple(held_scenes),
        horizon_s=config.horizon_s,
        notes=(*headings.notes, *rounding_notes(known_scenes, fitted_scenes, held_scenes)),
        next_drives=drives_apart(found, (*found.first, *more), equivalent, fitter, config),
        refusals=found.refusals,
        holdout_before=() if outliers is None else tuple(raw_scenes[1]),
    )


def _closings(
    known: Calibration,
    after: tuple[Base, Sequence[Added]],
    pairs: Sequence[tuple[Sequence[DenseWindows], Sequence[DenseWindows]]],
    floor: Gap,
    config: GapConfig,
) -> tuple[Closing, Closing]:
    """Of windows before and after, measured and held out, by the measure of a floor."""
    fitted, held_out = (
        Closing(
            gap_of(known.base, (), before, config.part_s, floor.measure),
            gap_of(*after, of, config.part_s, floor.measure),
            floor_there(floor, known, of, config),
        )
        for before, of in pairs
    )
    return fitted, held_out


def _counting(bar: "tqdm[None]") -> Callable[[], None]:
    def count() -> None:
        bar.update()

    return count
