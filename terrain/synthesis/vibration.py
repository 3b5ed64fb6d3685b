"""What an IMU on the simulated robot would feel: noise of a band by terrain, growing with speed."""

import numpy as np
from scipy.signal import butter, sosfilt

from odometry.arrays import AnyArray, FloatArray
from odometry.simulation.drive import Drive

RATE_HZ = 100.0
GRAVITY_M_S2 = 9.81
# centre of the band [Hz], size at 1 m/s [m/s2]
_KNOWN = {"gravel": (14.0, 1.6), "grass": (9.0, 1.2), "brick": (20.0, 1.4)}
CENTRES_HZ, SIZE_M_S2 = (6.0, 26.0), 1.4  # of other terrains, spread in the order given
BAND = 1.6  # from centre / BAND to centre * BAND
ROTATION = 0.04  # rad/s for each m/s2
SENSOR_M_S2, SENSOR_RAD_S = 0.05, 0.003  # white noise
SPREAD_HZ, SPREAD_SIZE = 0.1, 0.25  # of the logarithms, from run to run


def vibration_bands(terrains: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Centre [Hz] and size at 1 m/s [m/s2] by terrain."""
    centres = np.geomspace(*CENTRES_HZ, max(len(terrains), 2))
    return {
        name: _KNOWN.get(name, (float(centres[place]), SIZE_M_S2))
        for place, name in enumerate(terrains)
    }


def imu_table(
    drive: Drive, terrains: tuple[str, ...], rng: np.random.Generator
) -> dict[str, AnyArray]:
    """Columns of imu.csv at RATE_HZ.

    Each axis is white noise through a band-pass of the terrain beneath, times tread speed, plus
    white noise of the sensor, gravity, the yaw rate and the accelerations of the drive itself. It
    is a stated model, not a measured one: no wheel, no tyre, no suspension.

    Parameters
    ----------
    drive : Drive
    terrains : tuple of str
        All of them, in order.
    rng : Generator
        Draws the noise, and by how much this run's bands differ from `vibration_bands`.
    """
    begin_s, end_s = float(drive.stamps_s[0]), float(drive.stamps_s[-1])
    at_s = begin_s + np.arange(int((end_s - begin_s) * RATE_HZ) + 1) / RATE_HZ
    row = np.searchsorted(drive.stamps_s, at_s, side="right") - 1
    beneath = np.array(drive.terrains, dtype=object)[row]
    speed_m_s = np.abs(drive.tread_speeds_m_s[row]).mean(axis=1)
    columns: dict[str, FloatArray] = {}
    for axis in "xyz":
        columns[f"gyro_{axis}"] = SENSOR_RAD_S * rng.standard_normal(len(at_s))
        columns[f"accel_{axis}"] = SENSOR_M_S2 * rng.standard_normal(len(at_s))
    for name, (centre_hz, size) in vibration_bands(terrains).items():
        middle_hz = centre_hz * np.exp(SPREAD_HZ * rng.standard_normal())
        edges_hz = [middle_hz / BAND, min(middle_hz * BAND, 0.49 * RATE_HZ)]
        band = butter(2, edges_hz, "bandpass", fs=RATE_HZ, output="sos")
        grown = size * np.exp(SPREAD_SIZE * rng.standard_normal()) * speed_m_s * (beneath == name)
        for column, share in ((c, ROTATION if c.startswith("gyro") else 1.0) for c in columns):
            noise = sosfilt(band, rng.standard_normal(len(at_s)))
            columns[column] = columns[column] + share * grown * noise / noise.std()
    twists = np.stack([np.interp(at_s, drive.stamps_s, of) for of in drive.twists_body.T], axis=1)
    columns["gyro_z"] = columns["gyro_z"] + twists[:, 2]
    columns["accel_x"] = columns["accel_x"] + np.gradient(twists[:, 0], 1 / RATE_HZ)
    columns["accel_y"] = columns["accel_y"] + twists[:, 0] * twists[:, 2]
    columns["accel_z"] = columns["accel_z"] + GRAVITY_M_S2
    return {"t": at_s, **columns}
