"""One page and its figures from the gap between a model and measured runs."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.checks.findings.warned import faults_words
from odometry.effects.interface.base import Effect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import CommandsInCourse, MotionInCourse
from odometry.effects.interface.time_course import InBursts
from odometry.effects.measurement.reference_outliers import ReferenceOutliers
from odometry.gap.answer.result import GapResult
from odometry.gap.prepare.simulate import simulated_poses
from odometry.gap.show.quantities import Share, held_out_share
from odometry.gap.show.words import sentences
from odometry.geometry import se2
from odometry.report.drawing.figure import REFERENCE_STYLE, save_figure
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page
from odometry.report.drawing.map_plots import plot_paths
from odometry.report.gap.gap_figures import (
    RUNS,
    STAGES,
    WIDTH_IN,
    closing_picture,
    evidence_picture,
    time_picture,
)
from odometry.report.gap.gap_map import map_picture
from odometry.report.gap.gap_shapes import shape_pictures
from odometry.report.gap.gap_tables import (
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
from odometry.trajectory import Trajectory
from odometry.windows.dense.dense import DenseWindows

MEASURED_NAME = "measured"
STYLES = {MEASURED_NAME: REFERENCE_STYLE, **STAGES}


def rollout_pictures(result: GapResult, folder: Path) -> list[Picture]:
    """One map for each held-out run, at most `RUNS`."""
    found = []
    for number, scene in enumerate(result.holdout_scenes[:RUNS], start=1):
        paths = rollouts(result, scene)
        spans = np.ptp(np.concatenate([path.poses[:, :2] for path in paths.values()]), axis=0)
        height_in = 0.9 + 5.0 * float(np.clip(spans[1] / max(spans[0], 1e-9), 0.4, 1.1))
        file = folder / f"gap_rollout_{number}.png"
        found.append(
            Picture(
                save_figure(file, (WIDTH_IN, height_in), _drawing(paths, height_in)),
                f"Paths of {scene.run.name}: measured, and open loop.",
                f"{scene.run.name}, open loop over the whole run of "
                f"{paths[MEASURED_NAME].stamps_s[-1]:.0f} s, starting at its first measured pose, "
                "without any correction: " + _ends(paths),
            )
        )
    return found


def rollouts(result: GapResult, scene: DenseWindows) -> dict[str, Trajectory]:
    """Paths by name at the stamps of the measured poses."""
    measured = {MEASURED_NAME: Trajectory(scene.pose_s, scene.poses)}
    stages = result.stages.items()
    return measured | {name: rollout(base, added, scene) for name, (base, added) in stages}


def rollout(base: Base, effects: Sequence[Added], scene: DenseWindows) -> Trajectory:
    """Simulated poses of a whole run, as the reference sensor measures them, from its first."""
    seen = simulated_poses(base, effects, scene)
    moved = se2.compose(scene.poses[:1], se2.between(seen[:1], seen))
    return Trajectory(scene.pose_s, moved)


def _drawing(paths: dict[str, Trajectory], height_in: float) -> Callable[[Figure], None]:
    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.1, 0.55 / height_in, 0.74, 1 - 0.7 / height_in))
        plot_paths(axes, paths, STYLES)

    return draw


def _ends(paths: dict[str, Trajectory]) -> str:
    true = paths[MEASURED_NAME].poses[:, :2]
    words = []
    for name, path in paths.items():
        if name == MEASURED_NAME:
            continue
        away = np.hypot(*(path.poses[:, :2] - true).T)
        words.append(
            f"{np.sqrt((away**2).mean()):.3g} m RMS and {away[-1]:.3g} m at the end {name}"
        )
    return f"{', '.join(words)}."


HOW = (
    "The gap is the root mean square distance between simulated and measured positions at the ends "
    "of short windows, each started at a measured pose. The noise floor is the same on stretches "
    "of the calibration runs, each by a model identified on the others: what is left where nothing "
    "is missing. Candidates were tested on windows that they were not fitted to; held-out data "
    "were not used at all. Where positions hardly show a gap, and headings or the gyroscope do, "
    "the answer is by these; the map, the regions and the worst stretches are of positions all "
    "the same. Intervals are 95 % intervals."
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
    short += filter(None, [faults_words(result.faults)])
    details = [*(one for one in others if one not in short), *(f"{note}." for note in result.notes)]
    sections = [
        Section("In short", [Listing(short), closing_picture(result, folder)]),
        Section(
            "The model", [base_grid(result), *_effects(result), *shape_pictures(result, folder)]
        ),
        Section("Where it is", _where(result, folder)),
        Section("Over time", [time_picture(result, folder), worst_grid(result)]),
        Section("Whole runs, open loop", rollout_pictures(result, folder)),
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
            grids.append(Grid(("run", "run time [s]"), rows, f"When: {effect.in_words}."))
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
