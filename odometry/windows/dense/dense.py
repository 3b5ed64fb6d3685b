"""A run cut into short windows in which every measured pose counts."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.errors import WindowError
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains
from odometry.windows.config import WindowConfig
from odometry.windows.dense.dense_spans import EDGE_S, LEAST_POSES, windows_of_poses
from odometry.windows.recorded.between import between
from odometry.windows.recorded.record import record_of, words


@dataclass(frozen=True)
class DenseWindows:
    """One run, its samples, and K windows of n + 1 measured poses each.

    Beside `odometry.windows.travel.windows.Windows`, which knows the two ends of each window alone.

    Attributes
    ----------
    run : Run
    inputs : Inputs
        Of stack (N,): the stamps of odometry and poses, merged, or some of them with the means up
        to the next (`odometry.windows.dense.averaged`).
    steps_s : (N,)
        How long each sample was in force.
    travel_m : (N,)
        Wheel travel up to each sample.
    pose_s : (M,)
        Run time of each measured pose.
    poses : (M, 3)
        Measured x, y, yaw; whole turns are counted, so that yaw is not wrapped.
    windows : (K, n + 1)
        Poses of each window; neighbours share one.
    left_out : Counter of str
        How many windows of the run there are not, by reason (`odometry.windows.travel.windows`).
    rounded_m : float
        Step to which measured positions were rounded, where that is known: noise of the reference.
    """

    run: Run
    inputs: Inputs
    steps_s: FloatArray
    travel_m: FloatArray
    pose_s: FloatArray
    poses: FloatArray
    windows: IntArray
    left_out: Counter[str] = field(default_factory=Counter)
    rounded_m: float = 0.0

    def __len__(self) -> int:
        return len(self.windows)

    @property
    def time_s(self) -> FloatArray:
        """Run time (N,) of the samples.

        Raises
        ------
        WindowError
            If they have no stamps.
        """
        time_s = self.inputs.time_s
        if time_s is None:
            raise WindowError(f"{self.run.folder}: no stamps")
        return time_s

    @property
    def start_s(self) -> FloatArray:
        """Run time (K,) at which each window starts."""
        return np.asarray(self.pose_s[self.windows[:, 0]])

    @property
    def rows_per_window(self) -> int:
        """Residuals of a window: along, across and turn of each pose but its first.

        And the turn by the gyroscope to each from that before it, where one was recorded.
        """
        of_pose = 3 if self.inputs.yaw_rate_rad_s is None else 4
        return of_pose * (int(self.windows.shape[1]) - 1)

    @cached_property
    def measured(self) -> FloatArray:
        """Measured motion (K, n, 3) in the frame of each window's first pose, with whole turns."""
        return motion_from_first(self.poses, self.windows)

    @cached_property
    def reported_turns(self) -> FloatArray | None:
        """Turn (K, n) that the gyroscope reports between poses of each window, bias included."""
        rates = self.inputs.yaw_rate_rad_s
        return None if rates is None else self.turns_of(rates, 0.0)

    def turns_of(self, rates_rad_s: FloatArray, late_s: float) -> FloatArray:
        """Turn (K, n) between poses of each window of yaw rates (N,) that act late."""
        turned = np.concatenate([[0.0], np.cumsum(rates_rad_s * self.steps_s)[:-1]])
        at_poses = np.interp(self.pose_s - late_s, self.time_s, turned)
        return np.asarray(np.diff(at_poses[self.windows], axis=1))

    def less_bias(self, turns: FloatArray) -> FloatArray:
        """Turns (..., K, n) between poses of each window less their mean rate over all windows."""
        lasts_s = np.diff(self.pose_s[self.windows], axis=1)
        rates_rad_s = turns.sum(axis=(-2, -1), keepdims=True) / lasts_s.sum()
        return np.asarray(turns - rates_rad_s * lasts_s)

    def without_gyroscope(self) -> "DenseWindows":
        """The same as if no yaw rate had been recorded."""
        return replace(self, inputs=replace(self.inputs, yaw_rate_rad_s=None))

    def numbered(self, number: int) -> "DenseWindows":
        """The same as the run of this number among several."""
        numbers = np.full(len(self.steps_s), number)
        return replace(self, inputs=replace(self.inputs, run_number=numbers))

    def where(self, chosen: BoolArray) -> "DenseWindows":
        """The chosen (K,) windows."""
        return replace(self, windows=self.windows[chosen])


def motion_from_first(poses: FloatArray, windows: IntArray) -> FloatArray:
    """Motion (K, n, 3) of poses (M, 3) relative to the first of each window (K, n + 1).

    Yaw is not wrapped.
    """
    x, y, yaw = (np.ascontiguousarray(column).take(windows) for column in poses.T)
    cosine, sine = np.cos(yaw[:, :1]), np.sin(yaw[:, :1])
    x, y = x[:, 1:] - x[:, :1], y[:, 1:] - y[:, :1]
    motion = np.empty((*x.shape, 3))
    motion[..., 0] = cosine * x + sine * y
    motion[..., 1] = cosine * y - sine * x
    motion[..., 2] = yaw[:, 1:] - yaw[:, :1]
    return motion


def dense_windows_of(run: Run, horizon_s: float) -> DenseWindows:
    """Cut a run into windows of a duration; a change of terrain cuts nothing.

    None straddles a gap or a change of `window`, or poses between which the number of whole turns
    is not known.

    Raises
    ------
    WindowError
        If the run has no measured poses, or no window of the horizon is in it.
    """
    columns = {name: c for name, c in run.odometry.columns.items() if name != "terrain"}
    unlabelled = replace(run, odometry=replace(run.odometry, columns=columns))
    record = record_of(unlabelled, WindowConfig(horizon_s=horizon_s))
    start_s = run.odometry.stamps_s[0]
    rows = np.searchsorted(run.odometry.stamps_s, record.stamps_s, side="right") - 1
    time_s = record.stamps_s - start_s
    pose_s = time_s[record.pose_samples]
    windows, left_out = windows_of_poses(pose_s, record, time_s[-1], horizon_s)
    if not len(windows):
        reasons = words(left_out)
        raise WindowError(
            f"{run.folder}: no window of {horizon_s:g} s with {LEAST_POSES} measured poses "
            f"without a gap; {reasons + '; ' if reasons else ''}{_advice(pose_s, horizon_s)}"
        )
    inputs = replace(record.inputs, time_s=time_s, terrain=row_terrains(run)[rows])
    return DenseWindows(
        run,
        inputs,
        np.append(np.diff(time_s), 0.0),
        record.travel_m,
        pose_s,
        record.poses,
        windows,
        left_out,
    )


def _advice(pose_s: FloatArray, horizon_s: float) -> str:
    """What to do where poses (M,) have no window: rare ones need longer windows, short runs not."""
    lasts_s = float(np.ptp(pose_s)) if len(pose_s) else 0.0
    if lasts_s < horizon_s + 2 * EDGE_S:
        return f"its poses last {lasts_s:.3g} s: record for longer"
    return "choose a longer horizon"


def covered_s(run: Run, horizons_s: Sequence[float]) -> FloatArray:
    """Run time (H,) between measured poses that lies in windows of each duration."""
    record = record_of(run, WindowConfig())
    pose_s = record.stamps_s[record.pose_samples] - run.odometry.stamps_s[0]
    end_s = float(record.stamps_s[-1] - run.odometry.stamps_s[0])
    found = []
    for horizon_s in horizons_s:
        windows, _ = windows_of_poses(pose_s, record, end_s, horizon_s)
        found.append(float(np.diff(pose_s[windows[:, [0, -1]]], axis=1).sum()))
    return np.array(found)


def thinned(windows: DenseWindows, most: int) -> DenseWindows:
    """At most so many windows, at even distances."""
    if len(windows) <= most:
        return windows
    chosen = np.zeros(len(windows), dtype=np.bool_)
    chosen[np.linspace(0, len(windows) - 1, most).astype(np.int64)] = True
    return windows.where(chosen)


def poses_at(path: FloatArray, windows: DenseWindows, seen_s: FloatArray) -> FloatArray:
    """Poses (M, 3) of a path (N, 3) over a run's samples at run times (M,)."""
    return between(windows.time_s, seen_s).of(path.T).T


def off_measured(poses: FloatArray, windows: DenseWindows) -> FloatArray:
    """Measured motion less that of poses (M, 3), (K, n, 3), in the frame of each first pose.

    Yaw of the poses must not be wrapped: turns are compared with all whole turns in them.
    """
    return np.asarray(windows.measured - motion_from_first(poses, windows.windows))
