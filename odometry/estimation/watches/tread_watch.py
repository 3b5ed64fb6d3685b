"""Tread speeds that are impossible: a single outlying sample, an encoder that is stuck."""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.noise_scale import width_sigma_m
from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT, GYRO_BIAS, Y_LEFT, Y_RIGHT
from odometry.estimation.watches.rest_watch import STILL_M_S
from odometry.recording.frames import Frame

JUMP_M_S, JUMP_M_S2 = 3.0, 10.0  # a change of speed by more needs a second row that agrees
SAME_S, CONTRADICTED_S = 0.5, 1.0  # for so long a reading must stay the same, then contradict
OFF_M_S = 0.15  # by how much it must contradict them, and ...
OFF_SHARE, SLIP_SHARE = 0.3, 0.15  # ... by these shares of the faster tread
KNOWN_WIDTH = 0.2  # relative standard deviation below which the width determines a tread's speed
SIDES = ("left", "right")
Speeds = tuple[float, float]


class TreadWatch(NamedTuple):
    """What is remembered of the tread speeds.

    Attributes
    ----------
    recorded_m_s : (left, right)
        Speeds in force, as recorded.
    row, row_s : int, float
        Row of odometry.csv in which they came first, and the stamp of that frame.
    same_since_s : (left, right)
        Stamp since when the reading of each tread is the same.
    before : (left, right)
        The estimate then.
    held_out : bool
        Whether the row is held out: it jumped from all before, and no second row agrees yet.
    off_since_s : float
        Stamp since when a reading contradicts the other one and the gyroscope; NaN if none does.
    stuck : int
        The tread whose encoder is stuck, 0 or 1; -1 if none is.
    """

    recorded_m_s: Speeds
    row: int
    row_s: float
    same_since_s: Speeds
    before: tuple[Gaussian, Gaussian]
    held_out: bool = False
    off_since_s: float = math.nan
    stuck: int = -1

    @property
    def is_doubtful(self) -> bool:
        """Whether a tread is stuck, or contradicts the rest."""
        return self.stuck >= 0 or not math.isnan(self.off_since_s)

    @property
    def before_both(self) -> Gaussian:
        """The estimate when the reading of either tread changed last."""
        left_s, right_s = self.same_since_s
        return self.before[0 if left_s > right_s else 1]


def begun(frame: Frame, belief: Gaussian) -> TreadWatch:
    """At the first frame."""
    left, right = frame.tread_speeds_m_s.tolist()
    stamp_s = frame.stamp_s
    row = frame.odometry_row
    return TreadWatch((left, right), row, stamp_s, (stamp_s, stamp_s), (belief, belief))


def watched(
    watch: TreadWatch, frame: Frame, step_s: float, kept_m_s: FloatArray, belief: Gaussian
) -> tuple[TreadWatch, FloatArray, tuple[FilterEvent, ...]]:
    """The speeds (2,) to use from a frame on, given those used over the step to it.

    A jump by more than `JUMP_M_S` and what `JUMP_M_S2` allows is held out until the next row
    confirms it.
    """
    left, right = frame.tread_speeds_m_s.tolist()
    was_left, was_right = watch.recorded_m_s
    if (left == was_left and right == was_right) or math.isnan(left + right + was_left):
        if not watch.held_out:
            return watch, frame.tread_speeds_m_s, ()
        if frame.odometry_row == watch.row:
            return watch, kept_m_s, ()
        return watch._replace(held_out=False), frame.tread_speeds_m_s, ()  # a second row agrees
    stamp_s = frame.stamp_s
    since, before = list(watch.same_since_s), list(watch.before)
    for tread, changed in enumerate((left != was_left, right != was_right)):
        if changed:
            since[tread], before[tread] = stamp_s, belief
    most = JUMP_M_S + JUMP_M_S2 * step_s
    then_left, then_right = kept_m_s.tolist()
    held_out = max(abs(left - then_left), abs(right - then_right)) > most and not (
        watch.held_out and max(abs(left - was_left), abs(right - was_right)) <= most
    )
    events: tuple[FilterEvent, ...] = ()
    returned = max(abs(left - was_left), abs(right - was_right)) > most
    if watch.held_out and not held_out and returned:
        fastest = was_left if abs(was_left) > abs(was_right) else was_right
        text = f"a tread speed of {fastest:.2f} m/s is a single outlier: the one before it was held"
        events = (FilterEvent("tread_spike", watch.row_s, stamp_s, text),)
    after = watch._replace(
        recorded_m_s=(left, right),
        row=frame.odometry_row,
        row_s=stamp_s,
        same_since_s=(since[0], since[1]),
        before=(before[0], before[1]),
        held_out=held_out,
    )
    return after, kept_m_s if held_out else frame.tread_speeds_m_s, events


def contradicted(
    watch: TreadWatch, stamp_s: float, belief: Gaussian, yaw_rate: float, slip_scale: float
) -> TreadWatch:
    """The watch after a step whose yaw rate the gyroscope measured.

    An encoder is stuck where its reading stays exactly the same while the other tread and the
    gyroscope say, through the estimated ICRs, that it moves otherwise by more than treads slip.
    Where both stand, the robot is turned from outside.
    """
    left_s, right_s = watch.same_since_s
    if watch.stuck >= 0:
        return watch
    tread = 0 if left_s < right_s else 1
    if left_s == right_s or stamp_s - min(left_s, right_s) < SAME_S or _stand(watch):
        return _agreeing(watch)
    implied = implied_speed(watch.recorded_m_s, tread, belief, yaw_rate)
    fastest = max(abs(watch.recorded_m_s[0]), abs(watch.recorded_m_s[1]))
    most = OFF_M_S + (OFF_SHARE + SLIP_SHARE * math.sqrt(slip_scale)) * fastest
    if abs(implied - watch.recorded_m_s[tread]) <= most or not _is_width_known(belief):
        return _agreeing(watch)
    if math.isnan(watch.off_since_s):
        return watch._replace(off_since_s=stamp_s)
    if stamp_s - watch.off_since_s < CONTRADICTED_S:
        return watch
    return watch._replace(stuck=tread, off_since_s=watch.same_since_s[tread])


def _stand(watch: TreadWatch) -> bool:
    left, right = watch.recorded_m_s
    return max(abs(left), abs(right)) <= STILL_M_S


def _agreeing(watch: TreadWatch) -> TreadWatch:
    return watch if math.isnan(watch.off_since_s) else watch._replace(off_since_s=math.nan)


def freed(watch: TreadWatch, stamp_s: float) -> tuple[TreadWatch, tuple[FilterEvent, ...]]:
    """The watch once the reading of a stuck tread changes again."""
    if watch.stuck < 0 or watch.same_since_s[watch.stuck] != stamp_s:
        return watch, ()
    text = (
        f"the encoder of the {SIDES[watch.stuck]} tread was stuck: the other tread and the "
        "gyroscope gave its speed, and the ICRs were not updated"
    )
    event = FilterEvent("stuck_tread", watch.off_since_s, stamp_s, text)
    return watch._replace(stuck=-1, off_since_s=math.nan), (event,)


def implied_speed(speeds: Speeds, tread: int, belief: Gaussian, yaw_rate: float) -> float:
    """Speed of one tread that follows from the other, the ICRs and the gyroscope [m/s]."""
    mean = belief[0]
    across = float(mean[Y_LEFT] - mean[Y_RIGHT]) * (yaw_rate - float(mean[GYRO_BIAS]))
    alpha_left, alpha_right = float(mean[ALPHA_LEFT]), float(mean[ALPHA_RIGHT])
    if tread == 0:
        return (alpha_right * speeds[1] - across) / alpha_left
    return (alpha_left * speeds[0] + across) / alpha_right


def with_implied(
    watch: TreadWatch, speeds_m_s: FloatArray, belief: Gaussian, yaw_rate: float
) -> FloatArray:
    """Speeds (2,) with that of a stuck tread replaced; straight on where no yaw rate is known."""
    left, right = speeds_m_s.tolist()
    replaced = speeds_m_s.copy()
    rate = float(belief[0][GYRO_BIAS]) if math.isnan(yaw_rate) else yaw_rate
    replaced[watch.stuck] = implied_speed((left, right), watch.stuck, belief, rate)
    return replaced


def parted(belief: Gaussian, watch: TreadWatch, *, newly_stuck: bool) -> Gaussian:
    """State estimate whose pose is uncorrelated with the rest: a pose then corrects the pose alone.

    Where a tread was found stuck, the rest is as it was before its reading stood still.
    """
    mean, covariance = belief[0].copy(), belief[1].copy()
    if newly_stuck:
        then_mean, then_covariance = watch.before[watch.stuck]
        mean[3:], covariance[3:, 3:] = then_mean[3:], then_covariance[3:, 3:]
    covariance[:3, 3:], covariance[3:, :3] = 0.0, 0.0
    return mean, covariance


def _is_width_known(belief: Gaussian) -> bool:
    mean, covariance = belief
    width = float(mean[Y_LEFT] - mean[Y_RIGHT])
    return width_sigma_m(covariance) < KNOWN_WIDTH * width
