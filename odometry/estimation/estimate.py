"""What a filter believes at one stamp."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.icr import icr_twist

STATE_NAMES = ("x", "y", "yaw", "y_left", "y_right", "x_icr")


@dataclass(frozen=True)
class IcrBelief:
    """ICRs of one terrain, and how sure of them one is.

    Attributes
    ----------
    icrs : (3,)
        y_left, y_right, x_icr [m].
    alphas : (2,)
        Slip factors of the left and the right tread.
    covariance : (3, 3)
        Of `icrs`.
    """

    icrs: FloatArray
    alphas: FloatArray
    covariance: FloatArray


@dataclass(frozen=True)
class Innovation:
    """What one measurement said against the prediction.

    Attributes
    ----------
    residual : (3,)
        Measured less predicted x, y [m], yaw [rad], yaw wrapped.
    normalised_squared : float
        Squared Mahalanobis length of the residual.
    accepted : bool
        Whether it passed the gate.
    """

    residual: FloatArray
    normalised_squared: float
    accepted: bool


@dataclass(frozen=True)
class Estimate:
    """Belief of the filter at one stamp.

    Attributes
    ----------
    stamp_s : float
    mean : (6,)
        x, y [m], yaw [rad] in the reference frame; y_left, y_right, x_icr [m] in the robot frame.
    covariance : (6, 6)
    alphas : (2,)
        Slip factors in force.
    tread_speeds_m_s : (2,)
        Measured tread speeds in force from this stamp on.
    added_speeds_m_s, added_twist : (2,), (3,)
        What the effects of the terrain change of these speeds, and of the twist of the ICRs.
    terrain : str
        The terrain in force.
    innovation : Innovation or None
        None where nothing was measured at this stamp.
    rejected_in_row : int
        Measurements that failed the gate since the last that passed.
    recent : tuple of float
        The latest normalised innovations squared, for the jump detector.
    jumped : bool
        Whether a jump of the ICRs was detected at this stamp.
    learned : Mapping[str, IcrBelief]
        What was last believed on the terrains that were left.
    yaw_rate_rad_s : float
        Mean of the gyroscope's yaw rate since the estimate before; NaN where it was silent.
    """

    stamp_s: float
    mean: FloatArray
    covariance: FloatArray
    alphas: FloatArray
    tread_speeds_m_s: FloatArray
    terrain: str
    added_speeds_m_s: FloatArray = field(default_factory=lambda: np.zeros(2))
    added_twist: FloatArray = field(default_factory=lambda: np.zeros(3))
    innovation: Innovation | None = None
    rejected_in_row: int = 0
    recent: tuple[float, ...] = ()
    jumped: bool = False
    learned: Mapping[str, IcrBelief] = field(default_factory=dict)
    yaw_rate_rad_s: float = math.nan

    @property
    def belief(self) -> IcrBelief:
        """What is believed of the ICRs now."""
        return IcrBelief(self.mean[3:], self.alphas, self.covariance[3:, 3:])

    @property
    def effective_speeds_m_s(self) -> FloatArray:
        """Tread speeds (2,) in force after effects and slip."""
        return np.asarray(self.alphas * (self.tread_speeds_m_s + self.added_speeds_m_s))

    @property
    def twist(self) -> FloatArray:
        """Body twist (3,) at the tread speeds in force; zero where they are not known."""
        if not np.all(np.isfinite(self.tread_speeds_m_s)):
            return np.zeros(3)
        return np.asarray(icr_twist(self.mean[3:], self.effective_speeds_m_s) + self.added_twist)
