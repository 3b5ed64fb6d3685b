"""Whether the numbers of an IMU are in rad/s and m/s2 along the robot's axes."""

from collections.abc import Mapping

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError

GRAVITY_M_S2 = 9.81
GRAVITY_SHARE = 0.15  # by which the mean size may differ
MOST_TILT_RAD = 0.79  # of gravity from the robot's z: 45 degrees are no slope that one drives
MOST_YAW_GAIN = 5.0  # yaw rate over that of the treads; a skid-steer robot has less than 1.2
LEAST_TURN_RAD_S = 0.05  # of the treads, root mean square, for its gain to be determined


def check_imu(
    axes: Mapping[str, FloatArray], treads_m_s: FloatArray, track_width_m: float, file: str
) -> None:
    """Compare gravity and the yaw rate with what they must be.

    Parameters
    ----------
    axes : Mapping of str to (N,)
    treads_m_s : (N, 2)
    track_width_m : float
    file : str
        For the message.

    Raises
    ------
    RunFolderError
        If accelerations have not the size of gravity, gravity is not along z, or the yaw rate is
        many times that of the treads.
    """
    if all(f"accel_{axis}" in axes for axis in "xyz"):
        mean = np.array([np.nanmean(axes[f"accel_{axis}"]) for axis in "xyz"])
        size = float(np.linalg.norm(mean))
        if abs(size / GRAVITY_M_S2 - 1) > GRAVITY_SHARE:
            raise RunFolderError(
                f"{file}: the mean acceleration has a size of {size:.4g}, expected "
                f"{GRAVITY_M_S2} m/s2, gravity included; are they in g or mg?"
            )
        if np.arccos(np.clip(mean[2] / size, -1, 1)) > MOST_TILT_RAD:
            raise RunFolderError(
                f"{file}: the mean acceleration is {np.round(mean, 1).tolist()} m/s2, expected "
                "gravity along z; state the attitude of the IMU as [sensors] imu in run.toml"
            )
    if "gyro_z" not in axes:
        return
    turning = np.diff(treads_m_s)[:, 0] / track_width_m
    both = np.isfinite(turning) & np.isfinite(axes["gyro_z"])
    turning, yaw_rate = turning[both], axes["gyro_z"][both]
    power = float(turning @ turning)
    if power <= len(turning) * LEAST_TURN_RAD_S**2:
        return
    gain = float(yaw_rate @ turning) / power
    if abs(gain) > MOST_YAW_GAIN:
        raise RunFolderError(
            f"{file}: gyro_z is {gain:.0f} times the yaw rate that the treads give, expected at "
            "most about 1; is it in degrees a second?"
        )
