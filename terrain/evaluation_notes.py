"""Sentences beside the errors: where a method without a fit is as good or better."""

from collections.abc import Mapping, Sequence

from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.score import Score
from odometry.evaluation.withheld import JUDGED_EVERY_S, SILENT_S
from odometry.run_end import OFF_AT_END
from terrain.evaluated_trajectories import SecondReplay

NEEDS_NO_FIT = {
    "gyroscope": "the gyroscope with mean wheel speed",
    "differential_drive": "the ideal differential drive",
}
JUDGED_AT_THE_END = {"odometer": "the odometer", "estimate": "the estimate"}


NO_GYROSCOPE = (
    "The run has no gyroscope: there is no gyroscope row, and the odometer is turned by the treads."
)


def remarks(
    scores: Mapping[str, Score],
    off_m: Mapping[str, float],
    events: Sequence[FilterEvent] = (),
) -> list[str]:
    """Sentences that belong beside the errors; none without a reference.

    Parameters
    ----------
    scores : Mapping of trajectory to Score
    off_m : Mapping of trajectory to float
        Distance from the reference at its last stamp, see `RunResult.off_at_the_end_m`.
    events : sequence of FilterEvent
        Events shown beside: what one of them has of the estimate's end is not repeated.
    """
    if any(event.kind == OFF_AT_END for event in events):
        off_m = {name: off for name, off in off_m.items() if name != "estimate"}
    return [*simple_is_better(scores), *worse_at_the_end(off_m)] if scores else []


def evaluated_with(second: SecondReplay) -> str:
    """The poses of the evaluation, of an estimate that used the others."""
    withheld = second.withheld
    return (
        f"{len(withheld.judged)} poses, one every {JUDGED_EVERY_S:g} s: a second replay was not "
        f"given them, nor any pose of the last {SILENT_S:g} s before ({withheld.poses} in all)."
    )


def simple_is_better(scores: Mapping[str, Score]) -> list[str]:
    """A sentence where a trajectory that needs no fit errs less than the odometer."""
    own = scores["odometer"].mean_translation_per_m
    errors = {name: scores[name].mean_translation_per_m for name in NEEDS_NO_FIT if name in scores}
    better = {error: name for name, error in errors.items() if error is not None}
    if own is None or not better or min(better) >= own:
        return []
    least = min(better)
    return [
        f"{_capital(NEEDS_NO_FIT[better[least]])}, which needs no fit, is better here: "
        f"{least:.4f} against {own:.4f} m per m of wheel travel."
    ]


def worse_at_the_end(off_m: Mapping[str, float]) -> list[str]:
    """A sentence for each trajectory that ends farther off than the ideal differential drive.

    Also for the estimate, which may have used the reference and is no better for that.
    """
    ideal_m = off_m.get("differential_drive")
    if ideal_m is None:
        return []
    return [
        f"{_capital(words)} ends farther off than the ideal differential drive: "
        f"{off_m[name]:.2f} against {ideal_m:.2f} m."
        for name, words in JUDGED_AT_THE_END.items()
        if off_m.get(name, 0.0) > ideal_m
    ]


def _capital(words: str) -> str:
    return words[0].upper() + words[1:]
