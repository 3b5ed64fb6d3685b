"""Windows of runs, and stretches with a gyroscope, that identify a traction mode."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray, BoolArray, IntArray
from odometry.errors import IdentificationError, WindowError
from odometry.modes.models.traction import LEFT_TURN, RIGHT_TURN, turns_of
from odometry.modes.models.yaw_rate_noise import YawRateStretch, yaw_rate_stretch_of
from odometry.modes.recorded.bank_inputs import NO_YAW, STANDING_M_S
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_terrains import row_terrains
from odometry.windows.dense.dense import DenseWindows, dense_windows_of, thinned
from odometry.windows.recorded.gaps import odometry_gaps

HORIZONS_S = (4.0, 2.0)  # of windows, the second where poses are chained for less than the first
LEAST_S = 10.0  # of driving in each mode, in windows, and of its turns to each side
MOST_WINDOWS = 300  # of a mode and run
MOST_POSES = 40  # of a window, after its first
TURNING = 0.02  # of the treads' speed: less difference is no turn


def scenes_by_mode(
    runs: Sequence[Run], *, paper: bool = False
) -> tuple[float, dict[str, list[DenseWindows]]]:
    """The longest horizon of which there is enough, and the windows of each mode in order."""
    for horizon_s in HORIZONS_S[:-1]:
        try:
            return horizon_s, _windows(runs, horizon_s, paper=paper)
        except WindowError:
            continue
    return HORIZONS_S[-1], _windows(runs, HORIZONS_S[-1], paper=paper)


def _windows(
    runs: Sequence[Run], horizon_s: float, *, paper: bool
) -> dict[str, list[DenseWindows]]:
    scenes: dict[str, list[DenseWindows]] = {}
    for run in runs:
        if run.pose is not None and not np.isfinite(run.pose["yaw"]).any():
            raise IdentificationError(f"{run.folder}: {NO_YAW}")
        scene = _fewer_poses(dense_windows_of(run, horizon_s))
        for name in map(str, np.unique(row_terrains(run))):
            if name == UNKNOWN:
                raise IdentificationError(
                    f"{run.folder}: names no mode; expected [run] terrain in run.toml or a column "
                    "terrain"
                )
            scenes.setdefault(name, []).append(thinned(_on(scene, name), MOST_WINDOWS))
    found = {name: [one for one in scenes[name] if len(one)] for name in sorted(scenes)}
    for name, of in found.items():
        _check(name, of, paper=paper)
    return found


def _fewer_poses(scene: DenseWindows) -> DenseWindows:
    """At most MOST_POSES after the first of each window, evenly chosen."""
    poses = scene.windows.shape[1]
    if poses <= MOST_POSES + 1:
        return scene
    kept = np.linspace(0, poses - 1, MOST_POSES + 1).astype(np.int64)
    return replace(scene, windows=scene.windows[:, kept])


def yaw_rates_by_mode(runs: Sequence[Run]) -> dict[str, list[YawRateStretch]]:
    """Stretches of each mode with a gyroscope."""
    found: dict[str, list[YawRateStretch]] = {}
    for run in runs:
        for name, rows in stretches_by_label(run, row_terrains(run)):
            stretch = yaw_rate_stretch_of(run, rows)
            found.setdefault(name, []).extend([] if stretch is None else [stretch])
    return found


def _check(name: str, scenes: Sequence[DenseWindows], *, paper: bool) -> None:
    """Whether there is enough to determine all gains."""
    lasts_s, left_s, right_s = np.sum([(0.0, 0.0, 0.0), *map(_driven_s, scenes)], axis=0)
    if lasts_s < LEAST_S:
        raise IdentificationError(
            f"{name}: {lasts_s:.1f} s of driving in windows of poses without a gap, expected "
            f"{LEAST_S:g} s or more"
        )
    if not paper and min(left_s, right_s) < LEAST_S:
        raise IdentificationError(
            f"{name}: {left_s:.1f} s of left turns and {right_s:.1f} s of right ones in windows of "
            f"poses without a gap, expected {LEAST_S:g} s or more of each"
        )


def _driven_s(scene: DenseWindows) -> tuple[float, float, float]:
    """For how long the windows of a scene move, turn to the left, and turn to the right."""
    speeds = scene.inputs.tread_speeds_m_s
    fastest = np.abs(speeds).max(axis=1)
    moving = inside(scene) & (fastest > STANDING_M_S)
    turning = moving & (np.abs(np.diff(speeds)[:, 0]) > TURNING * fastest)
    left_s, right_s = (
        scene.steps_s[turning & (turns_of(speeds) == turn)].sum()
        for turn in (LEFT_TURN, RIGHT_TURN)
    )
    return float(scene.steps_s[moving].sum()), float(left_s), float(right_s)


def inside(scene: DenseWindows) -> BoolArray:
    """Whether each sample (N,) lies in a window."""
    starts_s, ends_s = scene.pose_s[scene.windows[:, [0, -1]]].T
    window = np.searchsorted(starts_s, scene.time_s, side="right") - 1
    return np.asarray((window >= 0) & (scene.time_s < ends_s[window]))


def _on(scene: DenseWindows, name: str) -> DenseWindows:
    """Windows of which every pose is in one mode."""
    labels = row_terrains(scene.run)
    odometry_s = scene.run.odometry.stamps_s - scene.run.odometry.stamps_s[0]
    poses_s = scene.pose_s[scene.windows]
    rows = np.clip(np.searchsorted(odometry_s, poses_s, side="right") - 1, 0, len(labels) - 1)
    return scene.where((labels[rows] == name).all(axis=1))


def stretches_by_label(run: Run, labels: AnyArray) -> Iterator[tuple[str, IntArray]]:
    """Label and rows of odometry.csv of each stretch in order; labels (N,)."""
    stamps_s = run.odometry.stamps_s
    gap = np.isin(stamps_s, odometry_gaps(run).spans_s[:, 1])
    cuts = np.flatnonzero((labels[1:] != labels[:-1]) | gap[1:]) + 1
    for rows in np.split(np.arange(len(stamps_s)), cuts):
        yield str(labels[rows[0]]), rows
