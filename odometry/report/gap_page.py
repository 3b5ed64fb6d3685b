"""One page and its figures from the gap between a model and measured runs."""

from pathlib import Path

from odometry.gap.result import GapResult
from odometry.gap.share_closed import Share, held_out_share
from odometry.gap.words import sentences
from odometry.report.gap_events import event_grids
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
    "is missing. Candidates were judged on windows that they were not fitted to; what was held out "
    "was not seen at all. Intervals are 95 % intervals."
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
