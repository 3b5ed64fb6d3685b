"""The frame loop: a run goes in, a filter is told the terrain, its estimates come out."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from tqdm import tqdm

from odometry.arrays import BoolArray, FloatArray
from odometry.dead_reckoning import dead_reckon
from odometry.errors import RunFolderError
from odometry.estimation.estimate import Estimate
from odometry.models.icr import icr_twist
from odometry.run import Frame, Run
from odometry.trajectory import Trajectory
from odometry.windows.gaps import odometry_gaps


class Estimator(Protocol):
    """A filter: it starts at a frame and steps from frame to frame."""

    def start(self, frame: Frame, terrain: str) -> Estimate:
        """The first estimate."""

    def step(self, estimate: Estimate, frame: Frame, terrain: str) -> Estimate:
        """The next estimate."""


class TerrainSource(Protocol):
    """Whatever knows the terrain that the robot is on."""

    @property
    def initial(self) -> str:
        """The terrain in force at the first frame."""

    def terrain(self, frame: Frame, estimate: Estimate) -> str:
        """The terrain in force from this frame on, given the estimate before it."""


@dataclass(frozen=True)
class ConstantTerrain:
    """One terrain for the whole run."""

    initial: str

    def terrain(self, frame: Frame, estimate: Estimate) -> str:  # noqa: ARG002 - the protocol's
        """The same as ever."""
        return self.initial


@dataclass(frozen=True)
class Replay:
    """Estimates at every frame of a run, as they were when the frame came in.

    Attributes
    ----------
    estimates : tuple of Estimate
    """

    estimates: tuple[Estimate, ...]

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,)."""
        return np.array([estimate.stamp_s for estimate in self.estimates])

    @property
    def means(self) -> FloatArray:
        """States (N, 6)."""
        return np.stack([estimate.mean for estimate in self.estimates])

    @property
    def sigmas(self) -> FloatArray:
        """Standard deviations (N, 6)."""
        variances = [np.diag(estimate.covariance) for estimate in self.estimates]
        return np.sqrt(np.maximum(variances, 0.0))

    @property
    def terrains(self) -> tuple[str, ...]:
        """Terrain in force at each frame."""
        return tuple(estimate.terrain for estimate in self.estimates)

    @property
    def jumps(self) -> BoolArray:
        """Where a jump of the ICRs was detected (N,)."""
        return np.array([estimate.jumped for estimate in self.estimates])

    def trajectory(self) -> Trajectory:
        """The filter's poses, corrected by measurements."""
        return Trajectory(self.stamps_s, self.means[:, :3])

    def odometer(self) -> Trajectory:
        """The model integrated open loop with the ICRs held at each moment, never corrected.

        The effects of the parameter set are part of the model.
        """
        return self._reckon(np.stack([estimate.twist for estimate in self.estimates]))

    def differential_drive(self, track_width: float) -> Trajectory:
        """The same integration with an ideal differential drive."""
        icrs = np.array([track_width / 2, -track_width / 2, 0.0])
        speeds = np.stack([estimate.tread_speeds_m_s for estimate in self.estimates])
        return self._reckon(icr_twist(icrs, np.nan_to_num(speeds)))

    def _reckon(self, twists: FloatArray) -> Trajectory:
        return dead_reckon(self.stamps_s, twists, self.means[0, :3])


def replay(
    run: Run, estimator: Estimator, source: TerrainSource, *, show_progress: bool = False
) -> Replay:
    """Replay a run frame by frame, from its first usable pose to the end of its odometry.

    Parameters
    ----------
    run : Run
    estimator : Estimator
    source : TerrainSource
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    RunFolderError
        If no frame has both tread speeds and, where the run has poses, a pose to start from.
    """
    frames = _from_start(run)
    first = next(frames, None)
    if first is None:
        raise RunFolderError(f"{run.folder}: no pose lies within the time of odometry.csv")
    estimates = [estimator.start(first, source.initial)]
    source.terrain(first, estimates[0])  # its image is looked at; a switch takes effect next
    bar: Iterable[Frame] = tqdm(
        frames, desc=run.name, unit="frame", disable=None if show_progress else True
    )
    for frame in bar:
        terrain = source.terrain(frame, estimates[-1])
        estimates.append(estimator.step(estimates[-1], frame, terrain))
    return Replay(tuple(estimates))


def _from_start(run: Run) -> Iterator[Frame]:
    """The frames from the first that can start a filter to the end of odometry.

    A held speed goes on in a gap, as the best that is known; the frames say that it is one.
    """
    gap_begins_s, gap_ends_s = odometry_gaps(run).spans_s.T
    has_pose = run.pose is not None and bool(
        np.isfinite(run.pose.stack("x", "y", "yaw")).all(axis=1).any()
    )
    started = False
    for frame in run.frames():
        moves = bool(np.all(np.isfinite(frame.tread_speeds_m_s)))
        if not started:
            posed = frame.pose is not None and bool(np.all(np.isfinite(frame.pose)))
            started = moves and (posed or not has_pose)
        in_gap = (gap_begins_s < frame.stamp_s) & (frame.stamp_s <= gap_ends_s)
        if started:
            yield replace(frame, in_gap=bool(in_gap.any()))
            if not moves:
                return
