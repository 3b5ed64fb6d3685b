"""ICRs that recordings show, window by window."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.geometry import se2
from odometry.icrs.points import NO_SLIP, icr_covariances, icrs_of_twist, turn_is_told
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.noise import pose_variances, window_covariances
from odometry.windows.windows import Windows, windows_of

SHORT_WINDOWS = WindowConfig(horizon_s=1.0)  # in which speeds hardly change
SPEED_SHARE = 0.02  # by which a mean tread speed may be off
SURE = 0.9999  # probability of the side to which a window turned
HALF_TURN_RAD = np.pi  # beyond it the ends of a window determine its mean twist poorly


@dataclass(frozen=True)
class MeasuredIcrs:
    """ICRs of K windows in which the robot turned.

    Attributes
    ----------
    start_s, duration_s : (K,)
    run, terrain : (K,) of str
    twists : (K, 3)
        Mean v_x, v_y [m/s], omega [rad/s].
    tread_speeds_m_s : (K, 2)
        Mean v_left, v_right.
    icrs : (K, 3)
        y_left, y_right, x_icr [m].
    covariances : (K, 3, 3)
        Of the ICRs, to first order [m^2].
    """

    start_s: FloatArray
    duration_s: FloatArray
    run: AnyArray
    terrain: AnyArray
    twists: FloatArray
    tread_speeds_m_s: FloatArray
    icrs: FloatArray
    covariances: FloatArray

    def __len__(self) -> int:
        return len(self.start_s)

    @property
    def sigmas_m(self) -> FloatArray:
        """Standard deviations (K, 3) of y_left, y_right, x_icr."""
        return np.sqrt(np.diagonal(self.covariances, axis1=1, axis2=2))

    @property
    def turn_radius_m(self) -> FloatArray:
        """The vehicle's own ICR (K,), y_v of Baril 2020 eq. 4: above 0 to the robot's left."""
        return np.asarray(self.twists[:, 0] / self.twists[:, 2])

    @property
    def side(self) -> AnyArray:
        """To which side (K,) each window turned: "left" or "right"."""
        return np.where(self.twists[:, 2] > 0, "left", "right")

    def where(self, chosen: BoolArray) -> "MeasuredIcrs":
        """The chosen (K,) windows."""
        return MeasuredIcrs(**{one.name: getattr(self, one.name)[chosen] for one in fields(self)})


def measured_icrs(
    runs: Sequence[Run],
    window_config: WindowConfig = SHORT_WINDOWS,
    *,
    alphas: ArrayLike = NO_SLIP,
    probability: float = SURE,
) -> MeasuredIcrs:
    """ICRs of all windows in which runs turned; see `icrs_of_windows`.

    Raises
    ------
    WindowError
        If a run has no measured poses, or there is no window in any of them.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> measured = odometry.measured_icrs([run])
    >>> measured.icrs.shape[1], bool((measured.icrs[:, 0] > measured.icrs[:, 1]).all())
    (3, True)
    """
    windows = windows_of(runs, window_config)
    return icrs_of_windows(windows, window_config, alphas=alphas, probability=probability)


def icrs_of_windows(
    windows: Windows,
    config: WindowConfig,
    *,
    alphas: ArrayLike = NO_SLIP,
    probability: float = SURE,
) -> MeasuredIcrs:
    """ICRs from the measured motion of windows and the mean tread speeds in them.

    The twist is the one whose arc leads from pose to pose (logarithm of SE(2)), in the plane:
    it is that of the robot where speeds hold. Its noise is that of the poses; a mean tread speed
    may be off by 2 %, which matters on wide curves. Left out are windows of more than half a
    turn, and those in which it is not sure to which side the robot turned.

    Parameters
    ----------
    windows : Windows
    config : WindowConfig
        States the noise of the poses.
    alphas : (2,)
        Slip factors of the left and the right tread.
    probability : float
        Of the side of a turn: see `turn_is_told`.
    """
    moved = np.abs(windows.measured[:, 2]) < HALF_TURN_RAD
    windows = windows.where(moved)
    displacements = se2.log(windows.measured)
    to_displacement = np.linalg.inv(se2.exp_jacobian(displacements))
    of_motion = window_covariances(windows, pose_variances(config))
    of_displacement = to_displacement @ of_motion @ to_displacement.swapaxes(1, 2)
    duration_s, speeds = _mean_speeds(windows)
    twists = displacements / duration_s[:, None]
    of_twist = of_displacement / np.square(duration_s)[:, None, None]
    told = turn_is_told(twists[:, 2], np.sqrt(of_twist[:, 2, 2]), probability)
    of_speeds = np.square(SPEED_SHARE * speeds)
    return MeasuredIcrs(
        windows.start_s,
        duration_s,
        windows.run,
        windows.terrain,
        twists,
        speeds,
        icrs_of_twist(twists, speeds, alphas),
        icr_covariances(twists, speeds, of_twist, of_speeds, alphas),
    ).where(told)


def _mean_speeds(windows: Windows) -> tuple[FloatArray, FloatArray]:
    """Duration (K,) and mean tread speeds (K, 2) of windows."""
    steps_s = windows.steps_s[:, None]
    steps = np.hstack([steps_s, windows.inputs.tread_speeds_m_s * steps_s])
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    duration_s, *travel_m = (sums[windows.last] - sums[windows.first]).T
    return duration_s, np.column_stack(travel_m) / duration_s[:, None]
