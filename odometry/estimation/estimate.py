"""The estimate of a filter at one stamp."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import Course
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.noise_scale import NoiseScale
from odometry.estimation.other_places import Doubt
from odometry.estimation.transition import ALPHA_LEFT, GYRO_BIAS, X_ICR, Y_LEFT
from odometry.estimation.watches.sensor_watch import SensorWatch
from odometry.models.icr import icr_twist
from odometry.recording.frames import Frame

STATE_NAMES = (
    "x",
    "y",
    "yaw",
    "y_left",
    "y_right",
    "x_icr",
    "gyro_bias",
    "alpha_left",
    "alpha_right",
)
ICRS, ALPHAS = slice(Y_LEFT, X_ICR + 1), slice(ALPHA_LEFT, ALPHA_LEFT + 2)
OF_TERRAIN = np.array([*range(9)[ICRS], *range(9)[ALPHAS]])  # what is another on each terrain


class ComparedMotion(NamedTuple):
    """Travel of the treads (2,) with what effects add, turn by the gyroscope, and how long."""

    treads_m: FloatArray
    turned_rad: float
    lasts_s: float

    @property
    def is_known(self) -> bool:
        """Whether treads and gyroscope were measured all the time."""
        return math.isfinite(self.turned_rad + sum(self.treads_m.tolist()))


@dataclass(frozen=True)
class IcrBelief:
    """ICRs of one terrain, and how sure of them one is.

    Attributes
    ----------
    icrs : (3,)
        y_left, y_right, x_icr [m].
    alphas : (2,)
        Slip factors of the left and the right tread.
    covariance : (5, 5)
        Of `icrs` and `alphas`.
    """

    icrs: FloatArray
    alphas: FloatArray
    covariance: FloatArray


@dataclass(frozen=True, slots=True)
class Crossing:
    """A robot astride an edge.

    Attributes
    ----------
    shares : Mapping of terrain to float
        Of the footprint; they add up to 1.
    known : Mapping of terrain to IcrBelief
        ICRs between which those in force lie; they stay the same until the robot is over.
    """

    shares: Mapping[str, float]
    known: Mapping[str, IcrBelief]


class Innovation(NamedTuple):
    """A measured pose compared with the prediction.

    Attributes
    ----------
    residual : (m,)
        Measured less predicted x, y [m], yaw [rad], yaw wrapped; without what was not measured.
    normalised_squared : float
        Squared Mahalanobis length of the residual.
    accepted : bool
        Whether it passed the gate.
    """

    residual: FloatArray
    normalised_squared: float
    accepted: bool


@dataclass(frozen=True, slots=True)
class Estimate:
    """State estimate of the filter at one stamp.

    Attributes
    ----------
    stamp_s : float
    mean : (9,)
        x, y [m], yaw [rad] in the reference frame; y_left, y_right, x_icr [m] in the robot
        frame; bias of the gyroscope [rad/s]; slip factors alpha_left, alpha_right.
    covariance : (9, 9)
        It covers all places where the robot may be.
    tread_speeds_m_s : (2,)
        Measured tread speeds in force from this stamp on.
    terrain : str
        The terrain in force.
    yaw_rate_rad_s : float
        Mean of the gyroscope's yaw rate since the estimate before, as recorded; NaN where it was
        silent.
    believed_yaw_rate_rad_s : float
        The one that turned the robot since then, its bias included; NaN where the treads did.
    added_speeds_m_s, added_twist : (2,), (3,)
        What the effects of the terrain change of these speeds, and of the twist of the ICRs.
    innovation : Innovation or None
        None where no pose was measured at this stamp.
    refused : tuple of (m,)
        Residuals of the latest poses that failed the gate since the last that passed.
    recent : tuple of float
        The latest normalised innovations squared, for the jump detector.
    jumped : bool
        Whether a jump of the ICRs was detected at this stamp.
    learned : Mapping[str, IcrBelief]
        The last estimates on the terrains that were left.
    crossing : Crossing or None
        None while the robot is on one terrain. Nothing that it learns astride an edge counts
        for the terrain that it leaves.
    scale : NoiseScale
        How much larger than stated the noises are.
    course : Course or None
        The search for a heading that is not known yet: until it is found, the pose follows the
        positions, with a yaw that starts at 0 and is not to be used.
    watch : SensorWatch or None
        What is remembered of the sensors; None where they are not watched.
    events : tuple of FilterEvent
        What the filter noticed at this stamp.
    doubt : Doubt or None
        Where else the robot may be, while poses and treads disagree.
    compared_later : ComparedMotion or None
        Motion since treads and gyroscope were compared; None where each row is.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> frame = odometry.Frame(0.0, np.array([0.5, 0.5]), 0, pose=np.zeros(3), image=None)
    >>> estimate = odometry.IcrEkf(track_width=0.4).start(frame, "grass")
    >>> estimate.mean[3:6].tolist()  # y_left, y_right, x_icr [m]
    [0.2, -0.2, 0.0]
    """

    stamp_s: float
    mean: FloatArray
    covariance: FloatArray
    tread_speeds_m_s: FloatArray
    terrain: str
    yaw_rate_rad_s: float = math.nan
    believed_yaw_rate_rad_s: float = math.nan
    added_speeds_m_s: FloatArray = field(default_factory=lambda: np.zeros(2))
    added_twist: FloatArray = field(default_factory=lambda: np.zeros(3))
    innovation: Innovation | None = None
    refused: tuple[FloatArray, ...] = ()
    recent: tuple[float, ...] = ()
    jumped: bool = False
    learned: Mapping[str, IcrBelief] = field(default_factory=dict)
    crossing: Crossing | None = None
    scale: NoiseScale = field(default_factory=NoiseScale)
    course: Course | None = None
    watch: SensorWatch | None = None
    events: tuple[FilterEvent, ...] = ()
    doubt: Doubt | None = None
    compared_later: ComparedMotion | None = None

    def motion_until(self, lasts_s: float, yaw_rate_rad_s: float) -> ComparedMotion:
        """Motion that waits to be compared, and that of a time after this stamp."""
        treads_m = (self.tread_speeds_m_s + self.added_speeds_m_s) * lasts_s
        turned_rad = yaw_rate_rad_s * lasts_s
        if (before := self.compared_later) is not None:
            treads_m, turned_rad = before.treads_m + treads_m, before.turned_rad + turned_rad
            lasts_s += before.lasts_s
        return ComparedMotion(treads_m, turned_rad, lasts_s)

    def waiting(
        self, frame: Frame, yaw_rate_rad_s: float, compare_s: float
    ) -> ComparedMotion | None:
        """Motion that still waits after a frame; None where each row is compared."""
        if compare_s == 0 or frame.in_gap:
            return None
        motion = self.motion_until(frame.stamp_s - self.stamp_s, yaw_rate_rad_s)
        return motion if motion.is_known and motion.lasts_s < compare_s else None

    @property
    def certain(self) -> Gaussian:
        """Mean (9,) and covariance (9, 9) with which the filter goes on, see `doubt`."""
        return self.mean, self.covariance if self.doubt is None else self.doubt.covariance

    @property
    def alphas(self) -> FloatArray:
        """Estimated slip factors (2,)."""
        return self.mean[ALPHAS]

    @property
    def gyro_bias_rad_s(self) -> float:
        """Estimated bias of the gyroscope."""
        return float(self.mean[GYRO_BIAS])

    @property
    def belief(self) -> IcrBelief:
        """Estimated ICRs with their covariance."""
        covariance = self.covariance[np.ix_(OF_TERRAIN, OF_TERRAIN)]
        return IcrBelief(self.mean[ICRS], self.alphas, covariance)

    @property
    def effective_speeds_m_s(self) -> FloatArray:
        """Tread speeds (2,) in force after effects and slip."""
        return np.asarray(self.alphas * (self.tread_speeds_m_s + self.added_speeds_m_s))

    @property
    def twist(self) -> FloatArray:
        """Body twist (3,) at the tread speeds in force, without a gyroscope; zero where unknown."""
        if not np.all(np.isfinite(self.tread_speeds_m_s)):
            return np.zeros(3)
        return np.asarray(icr_twist(self.mean[ICRS], self.effective_speeds_m_s) + self.added_twist)
