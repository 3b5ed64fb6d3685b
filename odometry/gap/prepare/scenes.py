"""Windows of the runs: how long, to fit effects to, to evaluate them, without poses left out."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.effects.measurement.reference_outliers import JumpingPoses
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.frozen import Isolated
from odometry.gap.prepare.held_out import Apart, apart
from odometry.gap.prepare.jumps import Jumps
from odometry.gap.prepare.measured import with_fewer_poses
from odometry.gap.prepare.outliers import Outliers, closes, outliers_of
from odometry.gap.prepare.rounding import rounded_m
from odometry.positions.heading import Headed
from odometry.recording.run import Run
from odometry.windows.dense.averaged import averaged_windows
from odometry.windows.dense.dense import DenseWindows, covered_s, dense_windows_of

SHORTER = (1.0, 0.75, 0.5)  # of the usual duration of windows, where stretches ask for it
SLOWEST_M_S = 0.05  # of a mean speed: a stationary robot has no horizon


def dealt(
    runs: Sequence[Run], measured: int, calibration: int
) -> tuple[Sequence[Run], Sequence[Run], Sequence[Run]]:
    """Measured, calibration and held-out runs of all, in this order."""
    known = measured + calibration
    return runs[:measured], runs[measured:known], runs[known:]


def scene_of(run: Run, config: GapConfig) -> DenseWindows:
    """Windows of a run, with the step to which its positions were rounded.

    Of poses at a high rate some, evenly: each costs time, and noise of neighbours is alike.
    """
    dense = with_fewer_poses(dense_windows_of(run, config.horizon_s), config.most_poses)
    scene = averaged_windows(dense)
    return replace(scene, rounded_m=rounded_m(run))


def scenes_of(
    measured: Sequence[Run], holdout: Sequence[Run], config: GapConfig
) -> tuple[list[DenseWindows], list[DenseWindows]]:
    """Scenes of measured and of held-out runs, numbered on."""
    scenes = [
        scene_of(run, config).numbered(number) for number, run in enumerate([*measured, *holdout])
    ]
    return scenes[: len(measured)], scenes[len(measured) :]


def alike(*groups: Sequence[DenseWindows]) -> tuple[list[DenseWindows], ...]:
    """The same scenes without the gyroscope where one of them has none."""
    if all(scene.reported_turns is not None for scenes in groups for scene in scenes):
        return tuple(list(scenes) for scenes in groups)
    return tuple([scene.without_gyroscope() for scene in scenes] for scenes in groups)


def without_outliers(
    runs: tuple[Sequence[Run], Sequence[Run]],
    groups: tuple[list[DenseWindows], list[DenseWindows]],
    numbers: Sequence[IntArray] | None,
    calibration: tuple[Sequence[DenseWindows], Calibration],
    config: GapConfig,
) -> tuple[Apart, Apart, Outliers | None]:
    """Scenes to fit and to evaluate with all poses, and without those that are far off.

    Both are the same, and there are no outliers, where that closes no gap on all runs (each is
    off by itself, nothing is fitted, and few are in what is held out), or where nothing is left of
    what is held out.
    """
    known_scenes, known = calibration
    scenes = apart(groups, numbers, config)
    outliers = outliers_of(*groups, known_scenes, known, config)
    if outliers is None:
        return scenes, scenes, None
    _, *cut = alike(known_scenes, *scenes_of(*cleaned_runs(*runs, outliers), config))
    left = apart((cut[0], cut[1]), numbers, config)
    if [len(of) for of in left] != [len(of) for of in scenes]:
        return scenes, scenes, None
    if not closes([*groups[0], *groups[1]], [*cut[0], *cut[1]], known.base, config):
        return scenes, scenes, None
    return scenes, left, outliers


def cleaned_runs(
    measured: Sequence[Run], held_out: Sequence[Run], outliers: Outliers
) -> tuple[list[Run], list[Run]]:
    """The runs without these poses, or cut before each where it is good by itself."""
    jumping = isinstance(outliers.named.effect, JumpingPoses)
    without = cut_before if jumping else left_out
    return (
        [without(run, one) for run, one in zip(measured, outliers.measured, strict=True)],
        [without(run, one) for run, one in zip(held_out, outliers.held_out, strict=True)],
    )


def left_out(run: Run, found: Isolated | Jumps) -> Run:
    """The run without these poses."""
    if run.pose is None:
        return run
    return replace(run, pose=run.pose.rows(np.flatnonzero(~_off(run, found))))


def cut_before(run: Run, found: Isolated | Jumps) -> Run:
    """The run with a new `window` of its poses from each of these on."""
    if run.pose is None:
        return run
    steps = np.cumsum(_off(run, found)).astype(np.float64)
    if "window" in run.pose:
        _, numbers = np.unique(run.pose.columns["window"], return_inverse=True)
        steps = steps + (len(steps) + 1.0) * numbers
    columns = {**run.pose.columns, "window": steps}
    return replace(run, pose=replace(run.pose, columns=columns))


def _off(run: Run, found: Isolated | Jumps) -> BoolArray:
    """Which poses of a run (M,) are among those found."""
    pose_s = run.pose.stamps_s if run.pose is not None else np.empty(0)
    stamps_s = np.round(pose_s - run.odometry.stamps_s[0], 6)
    return np.asarray(np.isin(stamps_s, np.round(found.stamps_s[found.off], 6)))


def for_chains(config: GapConfig, runs: Sequence[Run]) -> GapConfig:
    """Shorter windows where poses are chained in stretches that longer ones do not fit into.

    The longest of these that leaves out hardly more of the poses than the best one does.
    """
    tried_s = [share * config.horizon_s for share in SHORTER]
    covered = np.sum([covered_s(run, tried_s) for run in runs], axis=0)
    enough = covered >= config.least_covered * covered.max()
    return replace(config, horizon_s=tried_s[int(np.argmax(enough))])


def for_positions(config: GapConfig, headings: Headed) -> GapConfig:
    """Longer windows where positions without yaw are too noisy for short ones.

    At most half of a piece, so that pieces still hold windows.
    """
    speeds_m_s = [
        each.run.wheel_travel_m[-1] / np.ptp(each.run.odometry.stamps_s) for each in headings.found
    ]
    if not speeds_m_s:
        return config
    needed_s = headings.least_horizon_m / max(min(speeds_m_s), SLOWEST_M_S)
    return replace(config, horizon_s=max(config.horizon_s, min(needed_s, config.part_s / 2)))
