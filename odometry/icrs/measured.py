"""ICRs that recordings show, window by window, and their medians by terrain and side."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.geometry import se2
from odometry.icrs.points import NO_SLIP, icr_covariances, icrs_of_twist, turn_is_known
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances, window_covariances
from odometry.windows.travel.windows import Windows, windows_of

SHORT_WINDOWS = WindowConfig(horizon_s=1.0)  # in which speeds hardly change
SPEED_SHARE = 0.02  # by which a mean tread speed may be off
SURE = 0.9999  # probability of the side to which a window turned
HALF_TURN_RAD = np.pi  # beyond it the ends of a window determine its mean twist poorly

LEAST_WINDOWS = 10  # fewer give no interval
BLOCK, LEAST_BLOCKS = 5, 5  # neighbouring windows that are drawn together; of a run, at least
DRAWS = 500
COVERED = (2.5, 97.5)  # percentiles of the 95 % interval


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
        Of the side of a turn: see `turn_is_known`.
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
    known = turn_is_known(twists[:, 2], np.sqrt(of_twist[:, 2, 2]), probability)
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
    ).where(known)


def _mean_speeds(windows: Windows) -> tuple[FloatArray, FloatArray]:
    """Duration (K,) and mean tread speeds (K, 2) of windows."""
    steps_s = windows.steps_s[:, None]
    steps = np.hstack([steps_s, windows.inputs.tread_speeds_m_s * steps_s])
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    duration_s, *travel_m = (sums[windows.last] - sums[windows.first]).T
    return duration_s, np.column_stack(travel_m) / duration_s[:, None]


@dataclass(frozen=True)
class IcrMedian:
    """What most windows of one terrain and one side say.

    Attributes
    ----------
    terrain : str
    side : str
        "left" or "right".
    windows : int
    icrs : (3,)
        Medians of y_left, y_right, x_icr [m].
    low, high : (3,)
        Their 95 % intervals; NaN of fewer than `LEAST_WINDOWS`.
    """

    terrain: str
    side: str
    windows: int
    icrs: FloatArray
    low: FloatArray
    high: FloatArray


def icr_medians(measured: MeasuredIcrs, *, seed: int = 0) -> tuple[IcrMedian, ...]:
    """Medians of ICRs, terrain by terrain, of left turns and of right turns.

    A point counts by the inverse of its standard deviation. Intervals are bootstrapped: runs are
    drawn with replacement, and of each blocks of five neighbouring windows. Of one run they do
    not hold what differs from run to run.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> left, right = odometry.icr_medians(odometry.measured_icrs([run]))
    >>> left.side, left.icrs.shape
    ('left', (3,))
    """
    found = []
    for terrain in sorted(set(measured.terrain)):
        for side in ("left", "right"):
            here = measured.where((measured.terrain == terrain) & (measured.side == side))
            if len(here):
                found.append(_median(here, terrain, side, np.random.default_rng(seed)))
    return tuple(found)


def _median(measured: MeasuredIcrs, terrain: str, side: str, rng: np.random.Generator) -> IcrMedian:
    weights = 1 / measured.sigmas_m
    once = np.ones((1, len(measured)), dtype=np.int64)
    icrs = _weighted_medians(measured.icrs, weights, once)[0]
    low = high = np.full(3, np.nan)
    if len(measured) >= LEAST_WINDOWS:
        counts = _drawn(measured.run, rng)
        low, high = np.percentile(
            _weighted_medians(measured.icrs, weights, counts), COVERED, axis=0
        )
    return IcrMedian(terrain, side, len(measured), icrs, low, high)


def _weighted_medians(values: FloatArray, weights: FloatArray, counts: IntArray) -> FloatArray:
    """Medians (D, 3) of values (K, 3), each of which is there so many times (D, K)."""
    medians = np.empty((len(counts), values.shape[1]))
    for column, (of_column, weight) in enumerate(zip(values.T, weights.T, strict=True)):
        order = np.argsort(of_column)
        summed = np.cumsum((counts * weight)[:, order], axis=1)
        halves = np.argmax(summed >= summed[:, -1:] / 2, axis=1)
        medians[:, column] = of_column[order][halves]
    return medians


def _drawn(runs: AnyArray, rng: np.random.Generator) -> IntArray:
    """How often each window (K,) is in each of `DRAWS` draws of runs and blocks."""
    of_runs = [np.flatnonzero(runs == run) for run in dict.fromkeys(runs)]
    counts = np.zeros((DRAWS, len(runs)), dtype=np.int64)
    for row in counts:
        for number in rng.integers(len(of_runs), size=len(of_runs)):
            rows = of_runs[number]
            block = max(1, min(BLOCK, len(rows) // LEAST_BLOCKS))
            starts = rng.integers(len(rows), size=-(-len(rows) // block))
            drawn = (starts[:, None] + np.arange(block)) % len(rows)
            np.add.at(row, rows[drawn.ravel()], 1)
    return counts
