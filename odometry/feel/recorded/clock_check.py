"""Whether gyro_z follows the treads: stamps of one clock, and turns of the same sense."""

import numpy as np

from odometry.arrays import FloatArray

BIN_S = 0.1
MOST_LAG_S, USUAL_LAG_S = 10.0, 1.0  # robots, filters and logs delay by less than the latter
LEAST_CORRELATION = 0.8  # at the lag that fits
MOST_SHARE = 0.7  # of that without such a lag
LEAST_S = 20.0  # of driving in common at every lag
LEAST_TURN_RAD_S = 0.05  # of the treads, standard deviation


def clock_fault(
    yaw_rate_rad_s: FloatArray, treads_m_s: FloatArray, rate_hz: float, track_width_m: float
) -> str:
    """What contradicts one clock, or one sense of turns; "" where nothing does or can.

    Parameters
    ----------
    yaw_rate_rad_s : (N,)
        Even samples; NaN where nothing was measured.
    treads_m_s : (N, 2)
    rate_hz, track_width_m : float
    """
    step = max(1, round(BIN_S * rate_hz))
    turning = np.diff(treads_m_s)[:, 0] / track_width_m
    measured, expected = (_binned(of, step) for of in (yaw_rate_rad_s, turning))
    most, usual = (round(of * rate_hz / step) for of in (MOST_LAG_S, USUAL_LAG_S))
    if len(measured) < most + LEAST_S * rate_hz / step or expected.std() < LEAST_TURN_RAD_S:
        return ""
    lags = np.arange(-most, most + 1)
    found = np.array([_correlation(measured, expected, int(lag)) for lag in lags])
    usually = found[np.abs(lags) <= usual]
    if -usually.min() >= max(LEAST_CORRELATION, found.max()):
        return (
            f"gyro_z turns against the treads (correlation {usually.min():.2f}); expected the same "
            "sense: left is positive; is a sign, or left and right, the other way round?"
        )
    best, without = int(found.argmax()), usually.max()
    if found[best] < LEAST_CORRELATION or without > MOST_SHARE * found[best]:
        return ""
    lag_s = lags[best] * step / rate_hz
    return (
        f"gyro_z is {abs(lag_s):.1f} s {'later' if lag_s > 0 else 'earlier'} than the turns of the "
        f"treads (correlation {found[best]:.2f} there, {without:.2f} within {USUAL_LAG_S:g} s); "
        "expected the stamps of one clock"
    )


def _binned(values: FloatArray, step: int) -> FloatArray:
    """Means of so many samples; 0 for what is no number."""
    count = len(values) // step
    return np.asarray(np.nan_to_num(values[: count * step]).reshape(count, step).mean(axis=1))


def _correlation(measured: FloatArray, expected: FloatArray, lag: int) -> float:
    """Of what is measured so many samples later with what is expected; 0 where one is constant."""
    count = len(measured) - abs(lag)
    one, other = measured[max(lag, 0) :][:count], expected[max(-lag, 0) :][:count]
    spread = one.std() * other.std()
    return float(np.mean((one - one.mean()) * (other - other.mean())) / spread) if spread else 0.0
