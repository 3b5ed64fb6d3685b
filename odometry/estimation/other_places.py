"""Where the robot may be besides the place of the estimate, once poses and treads disagree.

Poses that are refused and agree with each other have two explanations: the robot is where they
say (it was moved, or its treads slipped), or they are shifted (a reflection of satellite signals, a
wrong fix, a wrong match in a map) and it is where treads and gyroscope lead. The filter goes on
at one of the two places, and its covariance covers both until poses decide.
"""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian, Place, pose_measurement
from odometry.estimation.transition import YAW, X, Y
from odometry.geometry import se2
from odometry.geometry.angles import wrap_one

SHARE = 0.5  # of the probability that another place has at first; it falls to none over ...
LASTS_S = 120.0  # reflections of satellites seldom last longer; maps that were corrected stay so
AGREEING = 3  # refused poses in a row that make their place another one
NEAR, NEAR_SIGMAS = 0.25, 4.0  # of the way between both places, and of a pose's noise: at the other
IN_A_ROW, AWAY = 2, -1  # poses there, before the filter returns
MOST_PLACES = 3
SHIFTED_POSES = "shifted_poses"  # kind of the event of a return, whose value is the shift [m]


class OtherPlace(NamedTuple):
    """A place where the robot is if the poses are shifted, or were before.

    Attributes
    ----------
    since_s : float
        Stamp since when the estimate is elsewhere.
    motion : (3,)
        Rigid motion that carries the pose of the estimate there.
    covariance : (3, 3)
        Of the pose there when the estimate left it.
    near : int
        Poses in a row that were measured there, behind one at the place of the estimate; `AWAY`
        since one at neither.
    """

    since_s: float
    motion: FloatArray
    covariance: FloatArray
    near: int = 0

    def pose(self, mean: FloatArray) -> FloatArray:
        """The pose (3,) there, of the mean (9,) of the estimate."""
        return se2.compose_one(self.motion, mean[:3])


Others = tuple[OtherPlace, ...]


class Doubt(NamedTuple):
    """What a covariance that covers several places hides.

    Attributes
    ----------
    covariance : (9, 9)
        Of the estimate if it is at the right place: the filter goes on with it.
    others : tuple of OtherPlace
        The oldest first.
    """

    covariance: FloatArray
    others: Others


Covered = tuple[FloatArray, Doubt | None]  # a covariance (9, 9), and what it hides


def left(others: Others, before: Gaussian, after: Gaussian, stamp_s: float) -> Others:
    """Other places when the filter starts anew: those of before, and the one that it left.

    `before` and `after` are states and covariances. Where yaw agrees, poses are not turned.
    """
    back = se2.inverse(after[0][:3])
    kept = tuple(each._replace(motion=se2.compose(each.pose(before[0]), back)) for each in others)
    there = before[0][:3].copy()
    turn_rad = wrap_one(float(there[YAW] - after[0][YAW]))
    if abs(turn_rad) < NEAR_SIGMAS * math.sqrt(before[1][YAW, YAW] + after[1][YAW, YAW]):
        there[YAW] = after[0][YAW]
    covariance = before[1][:3, :3].copy()
    return (*kept, OtherPlace(stamp_s, se2.compose(there, back), covariance))[-MOST_PLACES:]


def watched(
    others: Others, mean: FloatArray, pose: FloatArray, pose_covariance: FloatArray, lever_m: Place
) -> tuple[Others, OtherPlace | None]:
    """The other places after a measured pose (3,), and the one to which the poses came back.

    They come back at once: poses that go there little by little are of a robot that slips.
    """
    after = []
    for place, each in enumerate(others):
        near = _nearer(each, mean, pose, pose_covariance, lever_m)
        if near >= IN_A_ROW:
            return others[:place], each
        after.append(each._replace(near=near))
    return tuple(after), None


def _nearer(
    other: OtherPlace,
    mean: FloatArray,
    pose: FloatArray,
    pose_covariance: FloatArray,
    lever_m: Place,
) -> int:
    """`OtherPlace.near` after a pose (3,)."""
    there = returned((mean, pose_covariance), other)[0]
    apart_m = math.hypot(*(there - mean)[:2])
    noise_m = NEAR_SIGMAS * math.sqrt(pose_covariance[0, 0])
    if math.isnan(pose[0] + pose[1]) or apart_m < 2 * noise_m:
        return other.near
    here_m, there_m = (
        math.hypot(*pose_measurement(of, pose, pose_covariance, lever_m).residual[:2])
        for of in (mean, there)
    )
    most_m = NEAR * apart_m + noise_m
    if there_m <= most_m and there_m < here_m / 2:
        return other.near + 1 if other.near >= 0 else AWAY
    return 0 if here_m <= most_m else AWAY


def returned(belief: Gaussian, other: OtherPlace) -> Gaussian:
    """The belief moved to the other place."""
    mean = belief[0].copy()
    mean[:3] = other.pose(mean)
    return mean, belief[1]


def return_event(belief: Gaussian, other: OtherPlace, stamp_s: float) -> FilterEvent:
    """Of poses that came back to where treads and gyroscope had led."""
    shift_m = math.hypot(*(other.pose(belief[0]) - belief[0][:3])[:2])
    text = (
        f"the poses were shifted by {shift_m:.2f} m and came back to where treads and gyroscope "
        "had led: a reflection of satellite signals, a wrong fix or a wrong match in a map is "
        "likelier than a motion of the robot; the estimate followed them, off by as much"
    )
    return FilterEvent(SHIFTED_POSES, other.since_s, stamp_s, text, (shift_m,))


def doubted(
    belief: Gaussian,
    others: Others,
    refused: FloatArray | None,
    pose_covariance: FloatArray,
    stamp_s: float,
) -> Covered:
    """The covariance (9, 9) that covers all places, and what it hides; None where there is one.

    `refused` is the residual (m,) of the last of poses that were refused and agree.
    """
    others = tuple(each for each in others if stamp_s - each.since_s < LASTS_S)
    if not others and refused is None:
        return belief[1], None
    covariance = belief[1].copy()
    of_pose = covariance[:3, :3]
    for each in others:
        apart = each.pose(belief[0]) - belief[0][:3]
        apart[YAW] = wrap_one(float(apart[YAW]))
        share = SHARE * (1 - (stamp_s - each.since_s) / LASTS_S)
        of_pose += share * (each.covariance + apart[:, None] * apart)
    if refused is not None:
        apart = np.zeros(3)
        apart[{1: [YAW], 2: [X, Y], 3: [X, Y, YAW]}[len(refused)]] = refused
        of_pose += SHARE * (pose_covariance + apart[:, None] * apart)
    return covariance, Doubt(belief[1], others)


def with_lasting_errors(belief: Gaussian, covered: Covered, sigma_m: float) -> Covered:
    """As of `doubted`, with errors of positions that last: no averaging lessens them."""
    if not sigma_m:
        return covered
    covariance, doubt = covered[0].copy(), covered[1]
    covariance[X, X] += sigma_m**2
    covariance[Y, Y] += sigma_m**2
    return covariance, doubt or Doubt(belief[1], ())
