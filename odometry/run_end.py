"""Notes on a filter after the end of its run."""

import numpy as np

from odometry.estimates import Replay
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.filter_start import REINITIALISED
from odometry.estimation.sensor_watch import ongoing
from odometry.estimation.transition import GYRO_BIAS, YAW
from odometry.geometry.angles import wrap
from odometry.run import Run

REFUSED_SHARE = 0.03  # of the poses; fewer are usual
LAST_POSES = 20  # whose median distance is the error at the end
BIAS_RAD_S, BIAS_SIGMAS = 0.005, 4.0  # 0.3 degrees per second
DRIFT_RAD_S = 0.02  # four standard deviations of a bias that counts as found
KNOWN_BIAS_RAD_S = 0.005  # standard deviation from which on the bias is one that was found
FOLLOWED_SIGMAS = 2.0  # of the bias, by which one that was followed may be off in the mean
OFF_AT_END = "off_at_end"
DRIFT_FOLLOWED = "gyroscope_drift_followed"


def run_end_events(run: Run, replay: Replay) -> tuple[FilterEvent, ...]:
    """Events that last at the end, and those that only the whole run shows."""
    last = replay.estimates[-1]
    found = list(ongoing(last.watch, last.stamp_s)) if last.watch is not None else []
    found += _heading(last)
    found += _refused(replay)
    found += _bias(replay)
    found += _off_at_end(run, replay)
    return tuple(found)


def _heading(last: Estimate) -> list[FilterEvent]:
    if last.course is None:
        return []
    text = (
        "the heading cannot be determined: no yaw is measured, and the course of the "
        f"{last.course.count} positions over {last.course.travel_m:.1f} m of dead reckoning does "
        "not determine it; the estimate follows the positions, do not use its yaw"
    )
    return [FilterEvent("heading_unknown", last.course.begin_s, last.stamp_s, text)]


def _refused(replay: Replay) -> list[FilterEvent]:
    """Refusals that did not end with a new start."""
    measured = int(np.isfinite(replay.innovations_squared).sum())
    anew = [event for event in replay.events if event.kind == REINITIALISED]
    refused = measured - int(replay.accepted.sum())
    refused -= int(sum(event.values[0] for event in anew))
    if refused <= REFUSED_SHARE * measured:
        return []
    begin_s, end_s = replay.stamps_s[[0, -1]].tolist()
    text = f"{refused} of {measured} poses were refused as outliers"
    return [FilterEvent("refused_poses", begin_s, end_s, text)]


def _bias(replay: Replay) -> list[FilterEvent]:
    """A bias of the gyroscope that is clearly none of zero, and one that drifts."""
    of = slice(GYRO_BIAS, GYRO_BIAS + 1)
    biases = replay.numbers("mean", columns=of)[:, 0]
    sigmas = replay.sigmas_of(of)[:, 0]
    known = np.flatnonzero((sigmas > 0) & (sigmas < KNOWN_BIAS_RAD_S))
    if not len(known):
        return []
    bias, sigma = float(biases[-1]), float(sigmas[-1])
    least, most = float(biases[known].min()), float(biases[known].max())
    begin_s, end_s = float(replay.stamps_s[known[0]]), float(replay.stamps_s[-1])
    if most - least > DRIFT_RAD_S:
        text = f"the bias of the gyroscope drifted between {least:.4f} and {most:.4f} rad/s"
        off, stated = bias_error(replay, known[0]), float(sigmas[known].mean())
        if abs(off) <= FOLLOWED_SIGMAS * stated:
            return [FilterEvent(DRIFT_FOLLOWED, begin_s, end_s, f"{text}: the filter followed it")]
        text += (
            f", the estimated one was off by {abs(off):.4f} rad/s in the mean, where the filter "
            f"states {stated:.4f}: it was not followed"
        )
        return [FilterEvent("gyroscope_drift", begin_s, end_s, text)]
    if abs(bias) > max(BIAS_RAD_S, BIAS_SIGMAS * sigma):
        text = f"the gyroscope has a bias of {bias:.4f} +- {sigma:.4f} rad/s: it was removed"
        return [FilterEvent("gyroscope_bias", begin_s, end_s, text)]
    return []


def bias_error(replay: Replay, first: int) -> float:
    """Mean error of the estimated bias since an estimate [rad/s].

    How much more the gyroscope less that bias turned than the estimate, which follows the poses.
    """
    steps_s = np.diff(replay.stamps_s[first:])
    yaws, biases = (
        replay.numbers("mean", slice(first, None), slice(state, state + 1))[:, 0]
        for state in (YAW, GYRO_BIAS)
    )
    rates = replay.believed_yaw_rates_rad_s[first:]
    known = np.isfinite(rates) & (steps_s > 0)
    off = (rates - biases[:-1]) * steps_s - wrap(np.diff(yaws))
    duration_s = float(steps_s[known].sum())
    return float(off[known].sum()) / duration_s if duration_s > 0 else 0.0


def _off_at_end(run: Run, replay: Replay) -> list[FilterEvent]:
    """The estimate ends farther from the poses than the ideal differential drive."""
    if run.pose is None or replay.estimates[-1].course is not None:
        return []
    measured = run.pose.stack("x", "y")
    stamps_s = run.pose.stamps_s
    estimate = replay.trajectory()
    usable = np.isfinite(measured).all(axis=1) & estimate.covers(stamps_s)
    last = np.flatnonzero(usable)[-LAST_POSES:]
    if len(last) < LAST_POSES:
        return []
    ideal = replay.differential_drive(run.robot.track_width)
    ours_m, ideal_m = (
        float(np.median(np.hypot(*(one.at(stamps_s[last]).poses[:, :2] - measured[last]).T)))
        for one in (estimate, ideal)
    )
    if ours_m <= ideal_m:
        return []
    text = (
        f"the estimate ends {ours_m:.2f} m from the last {LAST_POSES} poses, the ideal drive "
        f"{ideal_m:.2f} m: do not trust the estimate at the end of this run"
    )
    return [FilterEvent(OFF_AT_END, float(stamps_s[last[0]]), float(replay.stamps_s[-1]), text)]
