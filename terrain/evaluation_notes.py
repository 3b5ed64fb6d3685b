"""Sentences beside the errors: where a method without a fit is as good, and the covariance."""

import math
from collections.abc import Mapping, Sequence

from odometry.estimation.filter_event import FilterEvent
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import DEGREES, OpenLoopConsistency
from odometry.evaluation.score import JUDGED_EVERY_S, SILENT_S, Score
from odometry.run_end import OFF_AT_END
from terrain.run_result import SecondReplay

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


def verdict(check: OpenLoopConsistency) -> str:
    """Whether a covariance is as large as the errors, as a sentence."""
    if check.is_consistent:
        return "consistent"
    return "too small" if check.mean > check.bounds[1] else "too large"


def not_checked(uncertainty: OdometerUncertainty, distance_m: float, reference_name: str) -> str:
    """Why the covariance was not checked over a distance."""
    if reference_name == "truth":
        return f"not checked: the truth holds no {distance_m:g} m"
    if uncertainty.noise is None:
        return "not checked: no pose to check it by"
    return f"not checked: too few poses {distance_m:g} m apart in a half of the run"


def judging(uncertainty: OdometerUncertainty) -> list[OpenLoopConsistency]:
    """The check of each distance: by the truth or by halves, else by the run's own poses."""
    found = {check.distance_m: check for check in uncertainty.own_checks}
    found |= {check.distance_m: check for check in uncertainty.checks}
    return [found[distance_m] for distance_m in sorted(found)]


def advice(uncertainty: OdometerUncertainty, reference_name: str) -> str:
    """What the check found, and what to do, in one or two sentences.

    Parameters
    ----------
    uncertainty : OdometerUncertainty
    reference_name : str
        "truth", "pose" or "".
    """
    checks = judging(uncertainty)
    small = [check for check in checks if verdict(check) == "too small"]
    large = [check for check in checks if verdict(check) == "too large"]
    how = "Checked against the truth" if reference_name == "truth" else "Checked against the poses"
    if small:
        factor = max(check.mean for check in small) / DEGREES
        return (
            f"{how}, the odometer's covariance is too small over {_distances(small)}: its errors "
            f"are about {math.sqrt(factor):.1f} times as large as sigma_x, sigma_y and sigma_yaw "
            f"say. Multiply the covariance by {factor:.1f} before you rely on it."
        )
    if large:
        factor = min(check.mean for check in large) / DEGREES
        return (
            f"{how}, the odometer's covariance is too large over {_distances(large)}: its errors "
            f"are about {math.sqrt(factor):.1f} times what sigma_x, sigma_y and sigma_yaw say. "
            "That is safe: nothing needs to be done."
        )
    if checks:
        return (
            f"{how}, the odometer's covariance is as large as its errors over {_distances(checks)}."
        )
    return (
        "The odometer's covariance was not checked: no poses reach over 5 m of wheel travel twice."
        if uncertainty.noise is not None
        else "The odometer's covariance was not checked: the filter took in no pose."
    )


def _distances(checks: Sequence[OpenLoopConsistency]) -> str:
    return " and ".join(f"{check.distance_m:g}" for check in checks) + " m"
