"""Sentences beside the errors, and what the filter noticed of its sensors."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.filter_start import INITIAL_YAW, LATER_YAW, REINITIALISED
from odometry.estimation.transition import GYRO_BIAS
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import DEGREES, OpenLoopConsistency
from odometry.evaluation.score import JUDGED_EVERY_S, SILENT_S, Score
from odometry.replays.estimates import MOST, Replay
from odometry.replays.gyroscope_bias import DRIFT_FOLLOWED
from odometry.replays.run_end import OFF_AT_END
from terrain.result.evaluated import SecondReplay

NEEDS_NO_FIT = {
    "gyroscope": "the gyroscope with mean wheel speed",
    "differential_drive": "the ideal differential drive",
}
JUDGED_AT_THE_END = {"odometer": "the odometer", "estimate": "the estimate"}


def without_gyroscope_row(replay: Replay) -> list[str]:
    """Why the errors have no gyroscope row; empty where they have one."""
    share = replay.gyroscope_share
    if share >= MOST:
        return []
    if not share:
        return [
            "The run has no gyroscope: there is no gyroscope row, and the odometer is turned by "
            "the treads."
        ]
    percent = int(100 * share)  # below MOST in words as well
    return [
        f"The gyroscope measured for {percent or 'less than 1'} % of the time: elsewhere the "
        "odometer is turned by the treads, and there is no gyroscope row."
    ]


HARMLESS = {  # kinds of events after which the estimate is still valid
    DRIFT_FOLLOWED,
    INITIAL_YAW,
    LATER_YAW,
    "coarse_speeds",
    *("gyroscope_bias", "gyroscope_bias_changed"),
    "gyroscope_held",
    "gyroscope_silence",
    "gyroscope_spike",
    "interpolated_poses",
    *("late_poses", "late_rows"),
    "noisy_positions",
    "odometry_gap",
    "pose_outage",
    "refused_poses",
    "rounded_positions",
    "row_rates",
    "tread_spike",
}


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
    if not scores:
        return []
    return [*simple_is_better(scores), *worse_at_the_end(off_m), *contradicted(events)]


def contradicted(events: Sequence[FilterEvent]) -> list[str]:
    """A sentence where the filter started again more than once."""
    again = sum(event.kind == REINITIALISED for event in events)
    if again < 2:
        return []
    return [
        f"The filter started again {again} times: poses and odometry contradict each other, and "
        "errors against the poses do not say which is at fault. Run check."
    ]


def evaluated_with(second: SecondReplay) -> str:
    """The poses of the evaluation, of an estimate that used the others."""
    withheld = second.withheld
    return (
        f"{len(withheld.judged)} poses, one every {JUDGED_EVERY_S:g} s: a second replay was not "
        f"given them, nor any pose of the last {SILENT_S:g} s before ({withheld.poses} in all)."
    )


def simple_is_better(scores: Mapping[str, Score]) -> list[str]:
    """A sentence where a trajectory that needs no fit has no larger error than the odometer."""
    own = scores["odometer"].mean_translation_per_m
    errors = {name: scores[name].mean_translation_per_m for name in NEEDS_NO_FIT if name in scores}
    better = {error: name for name, error in errors.items() if error is not None}
    if own is None or not better or min(better) >= own:
        return []
    least = min(better)
    stated, of_own = f"{least:.4f}", f"{own:.4f}"
    return [
        f"{_capital(NEEDS_NO_FIT[better[least]])}, which needs no fit, is "
        f"{'as good' if stated == of_own else 'better'} here: {stated} against {of_own} m per m "
        "of wheel travel."
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
        if round(off_m.get(name, 0.0), 2) > round(ideal_m, 2)
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
    if not uncertainty.poses:
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
        if uncertainty.poses
        else "The odometer's covariance was not checked: the filter took in no pose. It is that "
        "of other recordings: the errors of single ones are a tenth to three times of it."
    )


def _distances(checks: Sequence[OpenLoopConsistency]) -> str:
    *others, last = (f"{check.distance_m:g}" for check in checks)
    return f"{', '.join(others)} and {last} m" if others else f"{last} m"


def filter_table(replay: Replay) -> dict[str, Any]:
    """What result.json holds of the filter: plain values, units in the names."""
    squared = replay.innovations_squared
    squared = squared[~np.isnan(squared)]
    last = replay.estimates[-1]
    yaw = next((event.values for event in replay.events if event.kind == INITIAL_YAW), None)
    return {
        "poses": len(squared),
        "poses_refused": len(squared) - int(replay.accepted.sum()),
        "median_normalised_innovation_squared": float(np.median(squared)) if len(squared) else None,
        "jumps_s": replay.stamps_s[replay.jumps].tolist(),
        "gyro_bias_rad_s": float(last.mean[GYRO_BIAS]) if replay.used_gyroscope else None,
        "sigma_gyro_bias_rad_s": (
            math.sqrt(max(last.covariance[GYRO_BIAS, GYRO_BIAS], 0.0))
            if replay.used_gyroscope
            else None
        ),
        "initial_yaw": None if yaw is None else {"yaw_rad": yaw[0], "sigma_rad": yaw[1]},
        "events": [
            {
                "kind": event.kind,
                "begin_s": event.begin_s,
                "end_s": event.end_s,
                "text": event.text,
            }
            for event in replay.events
        ],
    }


def misleading(replay: Replay) -> list[FilterEvent]:
    """Events that show that the run misled the filter: its estimates are then in doubt."""
    return [event for event in replay.events if event.kind not in HARMLESS]


def event_line(event: FilterEvent, began_s: float) -> str:
    """When, in seconds since a stamp, and what, in one line."""
    begin_s, end_s = event.begin_s - began_s, event.end_s - began_s
    if end_s > begin_s:
        return f"{begin_s:.1f} to {end_s:.1f} s: {event.text}"
    return f"{begin_s:.1f} s: {event.text}"
