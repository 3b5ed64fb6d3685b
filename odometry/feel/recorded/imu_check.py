"""Whether inertial measurements have the expected units and axes: gravity, and the yaw rate."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray

GRAVITY_M_S2 = 9.81
GRAVITY_SHARE = 0.15  # by which the mean size may differ
MOST_TILT_RAD = 0.79  # of gravity from the robot's z: 45 degrees are no slope that one drives
MOST_YAW_GAIN = 5.0  # yaw rate over that of the treads; a skid-steer robot has less than 1.2
LEAST_TURN_RAD_S = 0.05  # of the treads, root mean square, for its gain to be determined
LEAST_S = 10.0  # of samples for its sense: on ice a robot turns on against its treads for 4 s
MOST_BIAS_RAD_S = 0.02  # of a gyroscope: what it turns against the treads beyond is no bias


@dataclass(frozen=True)
class ImuSums:
    """Sums over samples; every method gives new ones.

    Attributes
    ----------
    accel : (3,)
        Of accelerations [m/s2], with the number of samples of each in `accel_counts` (3,).
    yaw : (3,)
        Of the product of measured yaw rate and that of the treads, of the square of the latter
        [rad2/s2], and how many.
    seconds : float
        Of these samples.
    """

    accel: FloatArray = field(default_factory=lambda: np.zeros(3))
    accel_counts: FloatArray = field(default_factory=lambda: np.zeros(3))
    yaw: FloatArray = field(default_factory=lambda: np.zeros(3))
    seconds: float = 0.0

    def plus(
        self,
        axes: Mapping[str, FloatArray],
        treads_m_s: FloatArray,
        rate_hz: float,
        track_width_m: float,
    ) -> "ImuSums":
        """With N samples more, in the robot frame; NaN is left out.

        Parameters
        ----------
        axes : Mapping of str to (N,)
        treads_m_s : (N, 2)
        rate_hz, track_width_m : float
        """
        accel, counts, yaw, seconds = self.accel, self.accel_counts, self.yaw, self.seconds
        names = [f"accel_{axis}" for axis in "xyz"]
        if all(name in axes for name in names):
            table = np.stack([axes[name] for name in names])
            accel = accel + np.nansum(table, axis=1)
            counts = counts + np.isfinite(table).sum(axis=1)
        if "gyro_z" in axes:
            turning = np.diff(treads_m_s)[:, 0] / track_width_m
            both = np.isfinite(turning) & np.isfinite(axes["gyro_z"])
            turning, yaw_rate = turning[both], axes["gyro_z"][both]
            yaw = yaw + np.array([yaw_rate @ turning, turning @ turning, len(turning)])
            seconds += len(turning) / rate_hz
        return ImuSums(accel, counts, yaw, seconds)

    def fault(self) -> str:
        """What contradicts rad/s and m/s2 with gravity along z; "" if nothing does."""
        return self._of_gravity() or self._of_yaw_rate()

    def _of_gravity(self) -> str:
        if not self.accel_counts.all():
            return ""
        mean = self.accel / self.accel_counts
        size = float(np.linalg.norm(mean))
        if abs(size / GRAVITY_M_S2 - 1) > GRAVITY_SHARE:
            return (
                f"the mean acceleration has a size of {size:.4g}, expected {GRAVITY_M_S2} m/s2, "
                "gravity included; are they in g or mg?"
            )
        if np.arccos(np.clip(mean[2] / size, -1, 1)) > MOST_TILT_RAD:
            return (
                f"the mean acceleration is {np.round(mean, 1).tolist()} m/s2, expected gravity "
                "along z; state the attitude of the IMU as [sensors] imu in run.toml"
            )
        return ""

    def _of_yaw_rate(self) -> str:
        product, power, count = self.yaw.tolist()
        if power <= count * LEAST_TURN_RAD_S**2:
            return ""
        gain = product / power
        if abs(gain) > MOST_YAW_GAIN:
            return (
                f"gyro_z is {gain:.0f} times the yaw rate that the treads give, expected at most "
                "about 1; is it in degrees a second?"
            )
        against_rad_s = -gain * np.sqrt(power / count)  # that goes with the turns of the treads
        if self.seconds >= LEAST_S and against_rad_s > MOST_BIAS_RAD_S:
            return (
                f"gyro_z turns against the treads ({gain:.2f} times their yaw rate, over "
                f"{self.seconds:.0f} s); expected the same sense: left is positive; is a sign, or "
                "left and right, the other way round, or are these the stamps of two clocks?"
            )
        return ""
