"""Windows of a run and their features, of vibration and of motion."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.errors import RunFolderError
from odometry.feel.recorded.motion_features import current_features, speed_covariates, yaw_features
from odometry.feel.recorded.signals import AXES, FeelSignals, feel_signals
from odometry.feel.recorded.spectra import cross_densities
from odometry.recording.run import UNKNOWN, Run

SHORTEST_S, LONGEST_S = 1.0, 5.0
STANDING_M_S = 0.03  # mean speed of the treads in a window; below it the robot is stationary
TURNING_RAD_S = 0.05  # mean yaw rate of a window: a robot whose treads stand does not turn so
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
        Whether nothing is missing in it, and the gyroscope does not turn while the treads stand,
        which is then not measured; the others hold no features.
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
    complete_s : (W,), optional
        The stamp of the sample that completed each; by default its end.
    repeats : Mapping of str to float
        See `FeelSignals`.
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
    complete_s: FloatArray | None = None
    repeats: Mapping[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.begins_s)

    def most_repeats(self, axes: Iterable[str]) -> float:
        """`repeats` of that of the axes which has most; 0 where it is not known."""
        return max((self.repeats.get(name, 0.0) for name in axes), default=0.0)

    @property
    def ends_s(self) -> FloatArray:
        """The stamp (W,) at which each window ends."""
        return self.begins_s + self.window_s

    @property
    def known_s(self) -> FloatArray:
        """The stamp (W,) from which each window is known."""
        return self.ends_s if self.complete_s is None else self.complete_s

    @property
    def felt(self) -> BoolArray:
        """Windows (W,) with evidence: whole, and the robot moves."""
        return self.whole & ~self.standing

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of features that the run has."""
        kinds = [kind for kind in ("gyro", "accel") if any(a.startswith(kind) for a in self.axes)]
        return (*kinds, *self.motion)


BY_WINDOW = ("begins_s", "labels", "whole", "standing", "speeds_m_s", "covariates", "densities")


def windows_since(windows: FeelWindows, first: int) -> FeelWindows:
    """Those from a row on."""
    rows: dict[str, Any] = {name: getattr(windows, name)[first:] for name in BY_WINDOW}
    motion = {name: table[first:] for name, table in windows.motion.items()}
    return replace(windows, **rows, motion=motion, complete_s=windows.known_s[first:])


def joined_windows(parts: Sequence[FeelWindows]) -> FeelWindows:
    """Windows of one run, one part after another."""
    rows: dict[str, Any] = {
        name: np.concatenate([getattr(one, name) for one in parts]) for name in BY_WINDOW
    }
    motion = {name: np.concatenate([one.motion[name] for one in parts]) for name in parts[0].motion}
    known_s = np.concatenate([one.known_s for one in parts])
    return replace(parts[0], **rows, motion=motion, complete_s=known_s)


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
    windows = windows_of(signals, window_s, run.name, run.robot.track_width)
    if not len(windows):
        raise RunFolderError(
            f"{run.folder}: {len(signals) / signals.rate_hz:.2g} s of IMU and odometry, expected "
            f"a window of {window_s:g} s or more"
        )
    return windows


def steps_of(window_s: float, rate_hz: float) -> tuple[int, int]:
    """How many samples a window has, and after how many the next begins."""
    count = round(window_s * rate_hz)
    return count, max(1, round(count / STEPS))


def windows_of(
    signals: FeelSignals, window_s: float, run_name: str, track_width_m: float
) -> FeelWindows:
    """Cut signals into windows and measure each; none where they are shorter than one."""
    count, step = steps_of(window_s, signals.rate_hz)
    starts = np.arange(0, len(signals) - count + 1, step)
    rows = starts[:, None] + np.arange(count)
    treads = signals.treads_m_s[rows]
    whole = np.isfinite(treads).all(axis=(1, 2))
    axes = tuple(name for name in AXES if name in signals.axes)
    for name in axes:
        whole &= np.isfinite(signals.axes[name][rows]).all(axis=1)
    speeds = np.abs(np.nan_to_num(treads)).mean(axis=(1, 2))
    if "gyro_z" in axes:
        turning = np.abs(signals.axes["gyro_z"][rows].mean(axis=1)) > TURNING_RAD_S
        whole &= ~((speeds < STANDING_M_S) & turning)
    speeds = np.where(whole, speeds, 0.0)
    felt = whole & (speeds >= STANDING_M_S)
    labels = signals.labels[rows[:, 0]].copy()
    labels[(signals.labels[rows] != labels[:, None]).any(axis=1)] = UNKNOWN
    return FeelWindows(
        run_name,
        signals.begin_s + starts / signals.rate_hz,
        count / signals.rate_hz,
        labels,
        whole,
        whole & ~felt,
        speeds,
        _filled(felt, speed_covariates(treads[felt])),
        _filled(felt, _densities(signals, axes, rows[felt])),
        _motion(signals, rows, felt, track_width_m),
        axes,
        signals.rate_hz / count,
        signals.rate_hz / 2,
        repeats=signals.repeats,
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
