"""One page and its figures from the gap between a model and measured runs."""

from collections.abc import Sequence
from pathlib import Path

from odometry.effects.base import Effect
from odometry.effects.in_course import CommandsInCourse, MotionInCourse
from odometry.effects.reference_outliers import ReferenceOutliers
from odometry.effects.time_course import InBursts
from odometry.gap.result import GapResult
from odometry.gap.share_closed import Share, held_out_share
from odometry.gap.words import sentences
from odometry.report.gap_figures import closing_picture, evidence_picture, time_picture
from odometry.report.gap_map import map_picture
from odometry.report.gap_rollouts import rollout_pictures
from odometry.report.gap_shapes import shape_pictures
from odometry.report.gap_tables import (
    base_grid,
    closing_grid,
    effect_grid,
    equivalent_grid,
    parameter_grid,
    predictor_grid,
    region_grid,
    rival_grid,
    worst_grid,
)
from odometry.report.html import Grid, Listing, Paragraph, Picture, Section, write_page

HOW = (
    "The gap is the root mean square distance between simulated and measured positions at the ends "
    "of short windows, each started at a measured pose. The noise floor is the same on stretches "
    "of the calibration runs, each by a model identified on the others: what is left where nothing "
    "is missing. Candidates were tested on windows that they were not fitted to; held-out data "
    "were not used at all. Intervals are 95 % intervals."
)


def write_gap_report(result: GapResult, out: Path) -> list[Path]:
    """Write `figures/gap_*.png` and `report.html`.

    Parameters
    ----------
    result : GapResult
    out : path
        Folder; made if it is missing.

    Returns
    -------
    list of Path
        The files written, the page last. Figures of an earlier gap are removed.
    """
    folder = Path(out) / "figures"
    share = held_out_share(result)
    missing, how_sure, to_do, *others = sentences(result)
    short = [f"What is missing: {missing}", f"How sure: {how_sure}", f"What to do: {to_do}"]
    details = [*others, *(f"{note}." for note in result.notes)]
    sections = [
        Section("In short", [Listing(short), closing_picture(result, folder)]),
        Section(
            "The model", [base_grid(result), *_effects(result), *shape_pictures(result, folder)]
        ),
        Section("Where it is", _where(result, folder)),
        Section("Over time", [time_picture(result, folder), worst_grid(result)]),
        Section("Whole runs that were held out", rollout_pictures(result, folder)),
        Section("Evidence", _evidence(result, folder, share)),
        Section("In words", [Listing(details)]),
        Section("How to read this", [Paragraph(HOW)]),
    ]
    title = f"The gap between {result.calibration.base.model.name} and measured motion"
    page = write_page(Path(out) / "report.html", title, "", sections)
    pictures = [b.file for s in sections for b in s.blocks if isinstance(b, Picture)]
    for file in set(folder.glob("gap_*.png")) - set(pictures):
        file.unlink()
    return [*pictures, page]


def _where(result: GapResult, folder: Path) -> list[Grid | Picture]:
    blocks: list[Grid | Picture] = []
    picture = map_picture(result, folder)
    blocks += [picture] if picture is not None else []
    blocks += [region_grid(result)] if result.location.regions else []
    blocks += [predictor_grid(result)] if result.location.predictors else []
    return blocks


def _effects(result: GapResult) -> list[Grid]:
    if not result.effects:
        return []
    return [effect_grid(result), parameter_grid(result), *event_grids(result)]


def _evidence(result: GapResult, folder: Path, share: Share | None) -> list[Grid | Picture]:
    blocks: list[Grid | Picture] = [closing_grid(result, share)]
    blocks += [equivalent_grid(result)] if result.equivalent else []
    picture = evidence_picture(result, folder)
    blocks += [picture, rival_grid(result)] if picture is not None else []
    return blocks


def event_grids(result: GapResult) -> list[Grid]:
    """Events of effects in bursts, and poses that are left out, run by run; none where none are."""
    scenes = (*result.measured_scenes, *result.holdout_scenes)
    folders = list(dict.fromkeys(scene.run.folder.name for scene in scenes))
    grids = []
    for one in result.effects:
        effect = one.added.effect
        runs = [words_of_events(events) for events in events_of(effect)]
        if any(runs):
            rows = list(zip(folders, runs, strict=False))
            grids.append(Grid(("run", "run time s"), rows, f"When: {effect.in_words}."))
    return grids


def events_of(effect: Effect) -> tuple[tuple[tuple[float, ...], ...], ...]:
    """Run by run: (begin, end) of each event, or the time of each pose left out."""
    if isinstance(effect, ReferenceOutliers):
        return tuple(tuple((at_s,) for at_s in stamps) for stamps in effect.stamps_s)
    if isinstance(effect, CommandsInCourse | MotionInCourse) and isinstance(
        effect.in_time, InBursts
    ):
        return effect.in_time.events_s
    return ()


def words_of_events(events_s: Sequence[Sequence[float]]) -> str:
    """Events in one line."""
    return "; ".join(" to ".join(f"{at_s:.1f}" for at_s in event) for event in events_s)
