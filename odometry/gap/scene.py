"""A run cut into short windows in which every measured pose counts."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.gap.config import GapConfig
from odometry.gap.errors import GapError
from odometry.geometry import se2
from odometry.grounds import terrains_of
from odometry.models.inputs import Inputs
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.record import record_of

LEAST_POSES = 3  # of a window
EDGE_S = 0.5  # of a run: a late or early pose must still lie within its odometry
UNEVEN = 0.25  # a window may be longer or shorter by this share
FEW = 0.1  # share of the windows that may be lost for having fewer poses than the others


@dataclass(frozen=True)
class Scene:
    """One run, its samples, and K windows of n + 1 measured poses each.

    Attributes
    ----------
    run : Run
    inputs : Inputs
        Of stack (N,): the stamps of odometry and poses, merged.
    steps_s : (N,)
        How long each sample was in force.
    travel_m : (N,)
        Wheel travel up to each sample.
    pose_s : (M,)
        Run time of each measured pose.
    poses : (M, 3)
        Measured x, y, yaw.
    windows : (K, n + 1)
        Poses of each window; neighbours share one.
    """

    run: Run
    inputs: Inputs
    steps_s: FloatArray
    travel_m: FloatArray
    pose_s: FloatArray
    poses: FloatArray
    windows: IntArray

    def __len__(self) -> int:
        return len(self.windows)

    @property
    def time_s(self) -> FloatArray:
        """Run time (N,) of the samples."""
        time_s = self.inputs.time_s
        if time_s is None:
            raise GapError(f"{self.run.folder}: no stamps")
        return time_s

    @property
    def start_s(self) -> FloatArray:
        """Run time (K,) at which each window starts."""
        return np.asarray(self.pose_s[self.windows[:, 0]])

    @property
    def rows_per_window(self) -> int:
        """Residuals of a window: along, across and turn of each pose but its first."""
        return 3 * (int(self.windows.shape[1]) - 1)

    @cached_property
    def measured(self) -> FloatArray:
        """Measured motion (K, n, 3) in the frame of each window's first pose."""
        poses = self.poses[self.windows]
        return se2.between(poses[:, :1], poses[:, 1:])

    def where(self, chosen: BoolArray) -> "Scene":
        """The chosen (K,) windows."""
        return replace(self, windows=self.windows[chosen])


def scene_of(run: Run, config: GapConfig) -> Scene:
    """Cut a run into windows; none straddles a gap or a change of `window`.

    Raises
    ------
    GapError
        If no window of the horizon is in the run.
    WindowError
        If it has no measured poses.
    """
    columns = {name: c for name, c in run.odometry.columns.items() if name != "terrain"}
    unlabelled = replace(run, odometry=replace(run.odometry, columns=columns))
    record = record_of(unlabelled, WindowConfig(horizon_s=config.horizon_s))
    start_s = run.odometry.stamps_s[0]
    rows = np.searchsorted(run.odometry.stamps_s, record.stamps_s, side="right") - 1
    time_s = record.stamps_s - start_s
    inputs = replace(record.inputs, time_s=time_s, terrain=terrains_of(run)[rows])
    pose_s = time_s[record.pose_samples]
    windows = _windows(pose_s, record.stretch, time_s[-1], config)
    if not len(windows):
        raise GapError(
            f"{run.folder}: no window of {config.horizon_s:g} s with {LEAST_POSES} measured poses "
            "without a gap; choose a longer horizon"
        )
    return Scene(
        run,
        inputs,
        np.append(np.diff(time_s), 0.0),
        record.travel_m,
        pose_s,
        record.poses,
        windows,
    )


def _windows(pose_s: FloatArray, stretch: IntArray, end_s: float, config: GapConfig) -> IntArray:
    """Poses (K, n + 1): n as about nine windows in ten have, evenly chosen where there are more."""
    spans = []
    for number in np.unique(stretch):
        inside = (stretch == number) & (pose_s >= EDGE_S) & (pose_s <= end_s - EDGE_S)
        spans += _spans(pose_s, np.flatnonzero(inside), config.horizon_s)
    firsts, lasts = np.array(spans, dtype=np.int64).reshape(-1, 2).T
    if not len(firsts):
        return np.empty((0, LEAST_POSES), dtype=np.int64)
    steps = max(LEAST_POSES - 1, int(np.quantile(lasts - firsts, FEW)))
    kept = lasts - firsts >= steps
    return np.rint(np.linspace(firsts[kept], lasts[kept], steps + 1, axis=1)).astype(np.int64)


def _spans(pose_s: FloatArray, poses: IntArray, horizon_s: float) -> list[tuple[int, int]]:
    """First and last pose of windows end to end, each as near the horizon as stamps allow."""
    found, at = [], 0
    while at < len(poses) - 1:
        lasts_s = pose_s[poses[at + 1 :]] - pose_s[poses[at]]
        end = int(np.argmin(np.abs(lasts_s - horizon_s)))
        if abs(lasts_s[end] - horizon_s) <= UNEVEN * horizon_s:
            found.append((int(poses[at]), int(poses[at + 1 + end])))
        at += end + 1
    return found


def pieces(scene: Scene, part_s: float) -> IntArray:
    """Number (K,) of the piece of the run in which each window starts."""
    return np.asarray(np.floor(scene.start_s / part_s).astype(np.int64))


def numbered_pieces(scenes: Sequence[Scene], part_s: float) -> IntArray:
    """The same (K of all,) for several scenes: no two share a number."""
    numbers, begin = [], 0
    for scene in scenes:
        here = pieces(scene, part_s)
        numbers.append(begin + here)
        begin += int(here.max(initial=-1)) + 1
    return np.concatenate(numbers)


def thinned(scene: Scene, most: int) -> Scene:
    """At most so many windows, at even distances."""
    if len(scene) <= most:
        return scene
    chosen = np.zeros(len(scene), dtype=np.bool_)
    chosen[np.linspace(0, len(scene) - 1, most).astype(np.int64)] = True
    return scene.where(chosen)
