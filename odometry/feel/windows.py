"""Windows of a run and their features, of vibration and of motion."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.errors import RunFolderError
from odometry.feel.signals import AXES, FeelSignals, feel_signals
from odometry.feel.spectra import cross_densities
from odometry.run import UNKNOWN, Run

LEAST_SPEED_M_S = 0.02  # added below logarithms
TURN_SIGMA_RAD_S = 0.05  # turns of the treads below this determine no gain
USUAL_GAIN = 0.7  # of a skid-steer robot, where a window has no turn
LEAST_YAW_RATE_RAD_S = 0.003
LEAST_CURRENT_A = 0.3
SPEED_NAMES = ("log_speed", "log_speed_squared", "turning", "log_speed_change")
YAW_NAMES = ("yaw_gain", "log_yaw_residual", "log_yaw_ratio")
CURRENT_NAMES = ("log_current", "log_current_change")


def speed_covariates(treads_m_s: FloatArray) -> FloatArray:
    """How a window was driven (W, 4), SPEED_NAMES, from treads (W, N, 2).

    Vibration, currents and yaw rate all grow with speed: what depends on these is taken out.
    """
    speeds = np.abs(treads_m_s).mean(axis=2)
    log_speed = np.log(speeds.mean(axis=1) + LEAST_SPEED_M_S)
    turning = np.abs(np.diff(treads_m_s)[..., 0]).mean(axis=1)
    change = np.log(speeds.std(axis=1) + LEAST_SPEED_M_S)
    return np.column_stack([log_speed, log_speed**2, turning, change])


def yaw_features(
    yaw_rate_rad_s: FloatArray, treads_m_s: FloatArray, track_width_m: float, average: int
) -> FloatArray:
    """Yaw gain, its residual, and the ratio of the mean rates (W, 3), YAW_NAMES.

    Parameters
    ----------
    yaw_rate_rad_s : (W, N)
    treads_m_s : (W, N, 2)
    track_width_m : float
    average : int
        Samples over which rates are averaged, so that vibration is left out.
    """
    turning = _averaged(np.diff(treads_m_s)[..., 0] / track_width_m, average)
    measured = _averaged(yaw_rate_rad_s, average)
    weight = turning.shape[1] * TURN_SIGMA_RAD_S**2
    product, power = (measured * turning).sum(axis=1), (turning**2).sum(axis=1)
    gain = (product + USUAL_GAIN * weight) / (power + weight)
    left = (measured - gain[:, None] * turning).std(axis=1)
    ratio = np.log(np.abs(measured.mean(axis=1)) + LEAST_SPEED_M_S) - np.log(
        np.abs(turning.mean(axis=1)) + LEAST_SPEED_M_S
    )
    return np.column_stack([gain, np.log(left + LEAST_YAW_RATE_RAD_S), ratio])


def current_features(currents_a: FloatArray) -> FloatArray:
    """Mean and spread (W, 2), CURRENT_NAMES, of currents (W, N, 2) without their dropouts.

    In logarithms, so that a current over speed is their difference to a covariate. NaN where a
    window has no current.
    """
    there = np.isfinite(currents_a)
    count = there.sum(axis=1)
    known = np.where(there, currents_a, 0.0)
    means = np.divide(known.sum(axis=1), count, out=np.full(count.shape, np.nan), where=count > 0)
    squares = np.where(there, (currents_a - means[:, None]) ** 2, 0.0).sum(axis=1)
    spread = np.sqrt(squares / np.maximum(count, 1))
    sides = count > 0
    either = np.maximum(sides.sum(axis=1), 1)
    both = [np.where(sides, of, 0.0).sum(axis=1) / either for of in (means, spread)]
    features = np.log(np.column_stack(both) + LEAST_CURRENT_A)
    features[~sides.any(axis=1)] = np.nan
    return features


def _averaged(values: FloatArray, average: int) -> FloatArray:
    """Means (W, N // average) over so many samples."""
    parts = values.shape[1] // average
    return np.asarray(
        values[:, : parts * average].reshape(len(values), parts, average).mean(axis=2)
    )


SHORTEST_S, LONGEST_S = 1.0, 5.0
STANDING_M_S = 0.03  # mean speed of the treads in a window; below it the robot is stationary
STEPS = 2  # windows begin after 1 / STEPS of their length
AVERAGE_S = 0.15  # of the yaw rate
CHUNK = 256  # windows of which spectra are made at once


@dataclass(frozen=True)
class FeelWindows:
    """W windows of a run.

    Attributes
    ----------
    run_name : str
    begins_s, window_s : (W,) and float
        The stamp at which each begins, and how long it lasts.
    labels : (W,) of str
        The terrain that the run names all through a window, else "unknown".
    whole : (W,)
        Whether nothing is missing in it; the others hold no features.
    standing : (W,)
        Whether the robot is stationary.
    speeds_m_s : (W,)
        Mean size of the tread speeds.
    covariates : (W, 4)
        How it was driven, see `speed_covariates`.
    densities : (W, A (A + 1) / 2, F)
        Cross spectral densities of `axes`, see `spectra`; steps of `step_hz`.
    motion : dict of str to (W, f)
        "yaw" and "currents", where the run has them.
    axes : tuple of str
    step_hz, top_hz : float
        Of the frequencies; the highest that the sampling rate carries.
    """

    run_name: str
    begins_s: FloatArray
    window_s: float
    labels: AnyArray
    whole: BoolArray
    standing: BoolArray
    speeds_m_s: FloatArray
    covariates: FloatArray
    densities: FloatArray
    motion: dict[str, FloatArray]
    axes: tuple[str, ...]
    step_hz: float
    top_hz: float

    def __len__(self) -> int:
        return len(self.begins_s)

    @property
    def ends_s(self) -> FloatArray:
        """The stamp (W,) from which each window is known."""
        return self.begins_s + self.window_s

    @property
    def felt(self) -> BoolArray:
        """Windows (W,) with evidence: whole, and the robot moves."""
        return self.whole & ~self.standing

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of features that the run has."""
        kinds = [kind for kind in ("gyro", "accel") if any(a.startswith(kind) for a in self.axes)]
        return (*kinds, *self.motion)


def feel_windows(run: Run, window_s: float = 2.0) -> FeelWindows:
    """Cut a run into windows and measure each.

    Parameters
    ----------
    run : Run
    window_s : float
        1 to 5 s; windows overlap by half.

    Raises
    ------
    RunFolderError
        As `feel_signals`, or if the run is shorter than a window.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> windows = odometry.feel_windows(run)
    >>> len(windows), windows.axes, windows.top_hz
    (53, ('gyro_z',), 10.0)
    """
    signals = feel_signals(run)
    count = round(window_s * signals.rate_hz)
    starts = np.arange(0, len(signals) - count + 1, max(1, round(count / STEPS)))
    if not len(starts):
        raise RunFolderError(
            f"{run.folder}: {len(signals) / signals.rate_hz:.2g} s of IMU and odometry, expected "
            f"a window of {window_s:g} s or more"
        )
    rows = starts[:, None] + np.arange(count)
    treads = signals.treads_m_s[rows]
    whole = np.isfinite(treads).all(axis=(1, 2))
    axes = tuple(name for name in AXES if name in signals.axes)
    for name in axes:
        whole &= np.isfinite(signals.axes[name][rows]).all(axis=1)
    speeds = np.where(whole, np.abs(np.nan_to_num(treads)).mean(axis=(1, 2)), 0.0)
    felt = whole & (speeds >= STANDING_M_S)
    labels = signals.labels[rows[:, 0]].copy()
    labels[(signals.labels[rows] != labels[:, None]).any(axis=1)] = UNKNOWN
    return FeelWindows(
        run.name,
        signals.begin_s + starts / signals.rate_hz,
        count / signals.rate_hz,
        labels,
        whole,
        whole & ~felt,
        speeds,
        _filled(felt, speed_covariates(treads[felt])),
        _filled(felt, _densities(signals, axes, rows[felt])),
        _motion(signals, rows, felt, run.robot.track_width),
        axes,
        signals.rate_hz / count,
        signals.rate_hz / 2,
    )


def _densities(signals: FeelSignals, axes: tuple[str, ...], rows: IntArray) -> FloatArray:
    table = np.stack([signals.axes[name] for name in axes])
    parts = [
        cross_densities(np.swapaxes(table[:, rows[at : at + CHUNK]], 0, 1), signals.rate_hz)
        for at in range(0, max(len(rows), 1), CHUNK)
    ]
    return np.concatenate(parts)


def _motion(
    signals: FeelSignals, rows: IntArray, felt: BoolArray, track_width_m: float
) -> dict[str, FloatArray]:
    found: dict[str, FloatArray] = {}
    if "gyro_z" in signals.axes:
        average = max(1, round(AVERAGE_S * signals.rate_hz))
        yaw_rate, treads = signals.axes["gyro_z"][rows[felt]], signals.treads_m_s[rows[felt]]
        found["yaw"] = _filled(felt, yaw_features(yaw_rate, treads, track_width_m, average))
    if signals.currents_a is not None:
        found["currents"] = _filled(felt, current_features(signals.currents_a[rows[felt]]))
    return found


def _filled(felt: BoolArray, values: FloatArray) -> FloatArray:
    """Values of the windows with evidence, zeros in the others."""
    table = np.zeros((len(felt), *values.shape[1:]))
    table[felt] = values
    return table
