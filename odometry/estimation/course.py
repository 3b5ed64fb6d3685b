"""Unknown heading, found from the course of measured positions against dead reckoning."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray

LEAST_POSITIONS = 8
LEAST_TRAVEL_M = 6.0  # turns to both sides, so that sideways motion in them averages out
CERTAIN_SIGMA_RAD = 0.05  # 2.9 degrees
PATIENCE_M = 12.0  # of dead reckoning; after it less must do, or the search begins anew
ENOUGH_SIGMA_RAD = 0.25  # without a gyroscope too: the filter finds the rest with the ICRs
CRAB_SIGMA_RAD = 0.02  # by which the robot moves aside of its heading while nothing is known of it
ASIDE_SHARE = 0.3  # a robot whose treads slip moves aside by as much of the slip
UNKNOWN_YAW_VARIANCE = math.pi**2 / 3  # of an angle that may be any


class Heading(NamedTuple):
    """By what a dead-reckoned frame is to be turned and moved.

    Attributes
    ----------
    yaw_rad, sigma_rad : float
    centre_m, measured_m : (2,), (2,)
        Mean dead-reckoned place, and the mean measured place that it belongs to.
    position_sigma_m : float
        Of one position against dead reckoning.
    """

    yaw_rad: float
    sigma_rad: float
    centre_m: FloatArray
    measured_m: FloatArray
    position_sigma_m: float


@dataclass(frozen=True, slots=True)
class Course:
    """Sums over measured positions p and the dead-reckoned places q of the same reference point.

    Attributes
    ----------
    begin_s : float
        Stamp of the first.
    count : int
    reckoned_m, measured_m : (2,), (2,)
        Means of q and p.
    last_reckoned_m, last_measured_m : (2,), (2,)
    dot, cross : float
        Sums of q . p and q x p about the means [m^2].
    reckoned_square, measured_square : float
        Sums of |q|^2 and |p|^2 about the means [m^2].
    travel_m : float
        Sum of the steps of q.
    step_square : float
        Sum of (|step of p| - |step of q|)^2 [m^2]: whatever the heading, it gives the noise.
    began_anew : bool
        Whether a search before this one found nothing.
    """

    begin_s: float
    count: int
    reckoned_m: FloatArray
    measured_m: FloatArray
    last_reckoned_m: FloatArray
    last_measured_m: FloatArray
    dot: float = 0.0
    cross: float = 0.0
    reckoned_square: float = 0.0
    measured_square: float = 0.0
    travel_m: float = 0.0
    step_square: float = 0.0
    began_anew: bool = False

    @classmethod
    def begun(cls, stamp_s: float, reckoned_m: FloatArray, measured_m: FloatArray) -> "Course":
        """At a first pair of positions (2,), of dead reckoning and measured."""
        return cls(stamp_s, 1, reckoned_m, measured_m, reckoned_m, measured_m)

    def with_position(self, reckoned_m: FloatArray, measured_m: FloatArray) -> "Course":
        """The sums with one more pair (Welford's updates of means and products)."""
        count = self.count + 1
        q, p = reckoned_m - self.reckoned_m, measured_m - self.measured_m
        left = self.count / count
        reckoned_step_m = math.dist(reckoned_m, self.last_reckoned_m)
        measured_step_m = math.dist(measured_m, self.last_measured_m)
        return Course(
            self.begin_s,
            count,
            self.reckoned_m + q / count,
            self.measured_m + p / count,
            reckoned_m,
            measured_m,
            self.dot + left * float(q @ p),
            self.cross + left * float(q[0] * p[1] - q[1] * p[0]),
            self.reckoned_square + left * float(q @ q),
            self.measured_square + left * float(p @ p),
            self.travel_m + reckoned_step_m,
            self.step_square + (measured_step_m - reckoned_step_m) ** 2,
            self.began_anew,
        )

    def anew(self, stamp_s: float) -> "Course":
        """A search that begins at the last pair."""
        begun = Course.begun(stamp_s, self.last_reckoned_m, self.last_measured_m)
        return replace(begun, began_anew=True)

    @property
    def is_over(self) -> bool:
        """Whether the search is to begin anew: dead reckoning is no longer of one piece."""
        return self.travel_m >= PATIENCE_M

    def heading(self, position_sigma_m: float, *, by_gyroscope: bool) -> Heading | None:
        """The turn that fits best; None while it is undetermined.

        Least squares over rotations and one scale, for treads that slip, about the means (Umeyama
        1991 in the plane). Driving forward or
        back makes no difference: dead reckoning knows the direction. The lengths of steps give the
        noise of positions where it is more than `position_sigma_m`. Residuals above it count as
        errors of dead reckoning, which are of one piece: they do not average. The scale shows
        the slip of the treads, and so by how much the course may differ from the heading.
        A gyroscope keeps the shape of the path, so that `CERTAIN_SIGMA_RAD` is required over
        `PATIENCE_M`; treads whose ICRs are not known yet do not keep it, nor does a robot that
        slides: `ENOUGH_SIGMA_RAD` must do then.
        """
        if self.count < LEAST_POSITIONS or self.travel_m < LEAST_TRAVEL_M:
            return None
        fitted = math.hypot(self.dot, self.cross)
        residual = self.measured_square - fitted**2 / self.reckoned_square
        noise = max(position_sigma_m**2, self.step_square / (2 * (self.count - 1)))
        excess = max(residual / (2 * self.count - 4) - noise, 0.0)
        by_noise = (noise + excess * self.count) / self.reckoned_square
        slip = 1 - fitted / self.reckoned_square
        sigma = math.sqrt(by_noise + CRAB_SIGMA_RAD**2 + (ASIDE_SHARE * slip) ** 2)
        certain = by_gyroscope and self.travel_m < PATIENCE_M
        if sigma > (CERTAIN_SIGMA_RAD if certain else ENOUGH_SIGMA_RAD):
            return None
        return Heading(
            math.atan2(self.cross, self.dot),
            sigma,
            self.reckoned_m,
            self.measured_m,
            math.sqrt(noise + excess),
        )


def aligned(heading: Heading, pose: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A dead-reckoned pose (3,) in the frame of the positions, and its covariance (3, 3)."""
    cosine, sine = math.cos(heading.yaw_rad), math.sin(heading.yaw_rad)
    q = pose[:2] - heading.centre_m
    away = np.array([cosine * q[0] - sine * q[1], sine * q[0] + cosine * q[1]])
    by_yaw = np.array([-away[1], away[0], 1.0])
    covariance = np.outer(by_yaw, by_yaw) * heading.sigma_rad**2
    covariance[[0, 1], [0, 1]] += heading.position_sigma_m**2
    return np.append(heading.measured_m + away, pose[2] + heading.yaw_rad), covariance
