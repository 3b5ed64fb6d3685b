"""When effects in bursts are there, and which poses are left out, as tables."""

from collections.abc import Sequence

from odometry.effects.base import Effect
from odometry.effects.in_course import CommandsInCourse, MotionInCourse
from odometry.effects.reference_outliers import ReferenceOutliers
from odometry.effects.time_course import InBursts
from odometry.gap.result import GapResult
from odometry.report.html import Grid


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
