"""How far the open-loop odometer of a replay may be off, as measured on its own run."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.blocks import running_sums
from odometry.evaluation.learning_covariances import learning_covariances, parameter_covariances
from odometry.evaluation.odometer_noise import (
    NOISE_WITHOUT_POSES,
    USUAL_NOISE,
    OdometerNoise,
    measured_noise,
)
from odometry.evaluation.open_loop_consistency import (
    DISTANCES_M,
    OpenLoopConsistency,
    consistency_by_halves,
    open_loop_consistency,
)
from odometry.evaluation.open_loop_errors import OpenLoopPath
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class OdometerUncertainty:
    """Covariance of an odometer, where it comes from, and whether it was found right.

    Attributes
    ----------
    covariance_blocks : callable
        Gives `covariances` (k, 3, 3) block after block: of a long run they do not fit in memory.
    sigmas : dict of float to (3,)
        Standard deviations after so many metres of wheel travel.
    noise : OdometerNoise
    poses : int
        How many the filter took in.
    source : str
        Where the covariance comes from, in words.
    checks : tuple of OpenLoopConsistency
        NEES by distance against the truth, or of each half of the run by the noise of the other;
        empty where there is no reference.
    own_checks : tuple of OpenLoopConsistency
        Without a truth, NEES against the poses between which the noise was measured: it says
        whether the sources can describe the run, not whether they foretell another one.
    """

    covariance_blocks: Callable[[], Iterable[FloatArray]]
    sigmas: dict[float, FloatArray]
    noise: OdometerNoise
    poses: int
    source: str
    checks: tuple[OpenLoopConsistency, ...] = ()
    own_checks: tuple[OpenLoopConsistency, ...] = ()

    @property
    def covariances(self) -> FloatArray:
        """Covariances (N, 3, 3) of x, y [m], yaw [rad] in the frame of the odometer, at each pose.

        The first is that of the pose at which the odometer starts.
        """
        return np.concatenate(list(self.covariance_blocks()))


def odometer_uncertainty(
    run: Run, replay: Replay, truth: Trajectory | None = None
) -> OdometerUncertainty:
    """The covariance of the odometer along a replay, and its check.

    The noise of the odometer is measured between the poses that the filter accepted. It is
    checked against the truth where there is one, else each half of the run against its poses by
    the noise of the other half. Without poses it is what other recordings had without theirs, and
    what the filter does not know of its parameters: the settings of the filter alone are too sure.

    Parameters
    ----------
    run : Run
        That was replayed.
    replay : Replay
    truth : Trajectory, optional
        Of truth.csv; it checks, and nothing is measured by it.
    """
    path = path_of(replay)
    rows, poses = accepted_poses(run, replay)
    noise, unknown, source = _noise_of(path, rows, poses)
    blocks = partial(_along, replay, noise, unknown)
    own: list[OpenLoopConsistency] = []
    if truth is not None:
        checks = open_loop_consistency(path, *_true_poses(replay, truth), noise.without_reference())
    else:
        checks = consistency_by_halves(path, rows, poses)
        own = open_loop_consistency(path, rows, poses, noise) if noise.stretches else []
    return OdometerUncertainty(
        blocks, _after(path, blocks()), noise, len(rows), source, tuple(checks), tuple(own)
    )


ByParameters = Callable[[Replay, OpenLoopPath], Iterator[FloatArray]]


def _noise_of(
    path: OpenLoopPath, rows: IntArray, poses: FloatArray
) -> tuple[OdometerNoise, ByParameters, str]:
    """The noise, what errors of parameters add to it, and where both come from."""
    if not len(rows):
        return (
            NOISE_WITHOUT_POSES,
            parameter_covariances,
            "usual values of other recordings without their poses, and what the filter, which "
            "took in no pose, does not know of the parameters",
        )
    noise = measured_noise(path, rows, poses)
    if noise is None:
        return (
            USUAL_NOISE,
            learning_covariances,
            "usual values of other recordings: the run is too short to measure its own",
        )
    return (
        noise,
        learning_covariances,
        f"measured on {noise.stretches} stretches of up to {noise.longest_m:g} m between the "
        "poses of the run",
    )


def _along(
    replay: Replay, noise: OdometerNoise, by_parameters: ByParameters
) -> Iterator[FloatArray]:
    path = path_of(replay)
    start = replay.estimates[0].covariance[:3, :3]
    return map(np.add, path.carried(start, noise.variances), by_parameters(replay, path))


def path_of(replay: Replay) -> OpenLoopPath:
    """The odometer of a replay with the travel of its treads."""
    stamps_s = replay.stamps_s

    def steps(rows: slice) -> FloatArray:
        speeds = np.nan_to_num(replay.numbers("tread_speeds_m_s", rows))
        of = np.stack([np.abs(speeds).mean(axis=1), speeds.mean(axis=1)], axis=-1)
        return np.asarray(of * np.diff(stamps_s[rows.start : rows.stop + 1])[:, None])

    travel, signed = np.empty((2, len(stamps_s)))
    for rows, sums in running_sums(steps, len(stamps_s)):
        travel[rows], signed[rows] = sums.T
    return OpenLoopPath(replay.odometer().poses, travel, signed)


def accepted_poses(run: Run, replay: Replay) -> tuple[IntArray, FloatArray]:
    """Frames (M,) of a replay whose pose the filter accepted, and these poses (M, 3).

    A yaw that was not measured is the filter's; the place is the robot's, not the antenna's.
    """
    accepted = replay.accepted
    if run.pose is None or not accepted.any():
        return np.empty(0, dtype=np.int64), np.empty((0, 3))
    rows = np.flatnonzero(accepted)
    rows = rows[np.isin(replay.stamps_s[rows], run.pose.stamps_s)]
    at = np.searchsorted(run.pose.stamps_s, replay.stamps_s[rows])
    poses = run.pose.stack("x", "y", "yaw")[at]
    filtered = replay.numbers("mean", columns=slice(2, 3))
    poses[:, 2] = np.where(np.isfinite(poses[:, 2]), poses[:, 2], filtered[rows, 0])
    if run.sensors.pose_m is not None:
        lever_m = np.array(run.sensors.pose_m[:2])
        poses[:, :2] += poses[:, :2] - se2.transform(poses, lever_m)
    placed = np.isfinite(poses).all(axis=1)
    return rows[placed], poses[placed]


def _true_poses(replay: Replay, truth: Trajectory) -> tuple[IntArray, FloatArray]:
    rows = np.flatnonzero(truth.covers(replay.stamps_s))
    poses = truth.at(replay.stamps_s[rows]).poses
    known = np.isfinite(poses).all(axis=1)
    return rows[known], poses[known]


def _after(path: OpenLoopPath, covariances: Iterable[FloatArray]) -> dict[float, FloatArray]:
    """Standard deviations (3,) of x, y, yaw after each distance that the path holds."""
    rows = [(distance_m, np.searchsorted(path.travel_m, distance_m)) for distance_m in DISTANCES_M]
    rows = [(distance_m, row) for distance_m, row in rows if row < len(path.travel_m)]
    found: dict[float, FloatArray] = {}
    begin = 0
    for block in covariances:
        for distance_m, row in rows[len(found) :]:
            if row < begin + len(block):
                found[distance_m] = np.sqrt(np.diag(block[row - begin]))
        begin += len(block)
        if len(found) == len(rows):
            break
    return found
