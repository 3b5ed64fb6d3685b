"""The frame loop: a run, a filter and a source of terrain give estimates."""

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from tqdm import tqdm

from odometry.errors import RunFolderError
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.filter_start import INITIAL_YAW
from odometry.estimation.kept_estimates import KeptEstimates
from odometry.recording.frames import Frame
from odometry.recording.run import Run
from odometry.recording.run_terrains import Footing
from odometry.replays.estimates import Replay
from odometry.replays.run_end import run_end_events
from odometry.windows.recorded.gaps import GapsSoFar, odometry_gaps

LEAST_YAW_SIGMA_RAD = 0.1  # of a yaw found before the replay


class Estimator(Protocol):
    """A filter: it starts at a frame and steps from frame to frame."""

    def start(self, frame: Frame, terrain: str, *, yaw_sigma_rad: float | None = None) -> Estimate:
        """The first estimate; `yaw_sigma_rad` is given where the yaw is no measured one."""

    def step(self, estimate: Estimate, frame: Frame, terrain: str | Footing) -> Estimate:
        """The next estimate."""


class TerrainSource(Protocol):
    """Whatever knows the terrain that the robot is on."""

    @property
    def initial(self) -> str:
        """The terrain in force at the first frame."""

    def terrain(self, frame: Frame, estimate: Estimate) -> str | Footing:
        """The terrain in force from this frame on, given the estimate before it.

        `unknown` where for long there was no support for it; shares of several on an edge.
        """


@dataclass(frozen=True)
class ConstantTerrain:
    """One terrain for the whole run.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> gravel = odometry.ConstantTerrain("gravel")
    >>> filtered = odometry.replay(run, odometry.IcrEkf(track_width=0.4), gravel)
    >>> set(filtered.terrains)
    {'gravel'}
    """

    initial: str

    def terrain(self, frame: Frame, estimate: Estimate) -> str:  # noqa: ARG002 - the protocol's
        """The same as ever."""
        return self.initial


def replay(
    run: Run,
    estimator: Estimator,
    source: TerrainSource,
    *,
    noticed: tuple[FilterEvent, ...] = (),
    causal: bool = False,
    show_progress: bool = False,
) -> Replay:
    """Replay a run frame by frame, from its first usable position to the end of its odometry.

    Where that position has no yaw, the first metres are replayed once before to find it, so that
    all estimates are in the frame of the positions.

    Parameters
    ----------
    run : Run
    estimator : Estimator
    source : TerrainSource
    noticed : tuple of FilterEvent
        Found in the run before the filter started, such as a delay of its poses.
    causal : bool
        See `IcrEkfConfig`.
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    RunFolderError
        If no frame has both tread speeds and, where the run has poses, a position to start from.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> gravel = odometry.ConstantTerrain("gravel")
    >>> filtered = odometry.replay(run, odometry.IcrEkf(track_width=0.4), gravel)
    >>> len(filtered.estimates)
    1085
    """
    frames = _frames_so_far(run) if causal else _from_start(run)
    first = next(frames, None)
    if first is None:
        raise RunFolderError(
            f"{run.folder}: no position of pose.csv lies within the time of odometry.csv"
        )
    if causal:
        latest = started(estimator, source, first)
    else:
        latest = _first_estimate(run, first, estimator, source.initial)
        source.terrain(first, latest)
    estimates = KeptEstimates([replace(latest, events=(*noticed, *latest.events))])
    bar: Iterable[Frame] = tqdm(
        frames, desc=run.name, unit="frame", disable=None if show_progress else True
    )
    for frame in bar:
        latest = stepped(estimator, source, latest, frame)
        estimates.append(latest)
    latest = estimates[-1]
    ended = run_end_events(run, Replay(estimates))
    estimates.end_with(replace(latest, events=(*latest.events, *ended)))
    return Replay(estimates)


def started(estimator: Estimator, source: TerrainSource, frame: Frame) -> Estimate:
    """The first estimate; the image of its frame is classified, and a switch takes effect next."""
    estimate = estimator.start(frame, source.initial)
    source.terrain(frame, estimate)
    return estimate


def stepped(
    estimator: Estimator, source: TerrainSource, estimate: Estimate, frame: Frame
) -> Estimate:
    """The next estimate, on the terrain that the source gives."""
    return estimator.step(estimate, frame, source.terrain(frame, estimate))


def can_start(frame: Frame, *, at_pose: bool) -> bool:
    """Whether a filter can start at a frame: its speeds are known and, if wanted, a position."""
    if not np.isfinite(frame.tread_speeds_m_s).all():
        return False
    return not at_pose or (frame.pose is not None and bool(np.all(np.isfinite(frame.pose[:2]))))


def _first_estimate(run: Run, first: Frame, estimator: Estimator, terrain: str) -> Estimate:
    """The start; where its yaw is not measured, with that found from the course of positions."""
    estimate = start = estimator.start(first, terrain)
    frames = _from_start(run)
    next(frames)
    while estimate.course is not None:
        frame = next(frames, None)
        if frame is None:
            return start
        estimate = estimator.step(estimate, frame, terrain)
    if first.pose is None or estimate is start:
        return start
    found_there = [event for event in estimate.events if event.kind == INITIAL_YAW]
    if not found_there:
        return start  # found too late to give the yaw at the beginning
    event = found_there[0]
    yaw_rad, sigma_rad = event.values
    pose = np.array([*first.pose[:2], yaw_rad])
    # the positions that gave the yaw come again: they must not count twice
    sigma_rad = max(LEAST_YAW_SIGMA_RAD, 2 * sigma_rad)
    found = estimator.start(replace(first, pose=pose), terrain, yaw_sigma_rad=sigma_rad)
    return replace(found, events=(event,))


def _from_start(run: Run) -> Iterator[Frame]:
    """The frames from the first that can start a filter to the end of odometry.

    A held speed goes on in a gap, as the best that is known; the frames mark the gap.
    """
    begins_s, ends_s = odometry_gaps(run).spans_s.T.tolist()
    for frame in _usable(run):
        gap = bisect_left(ends_s, frame.stamp_s)  # the first that ends no earlier
        in_gap = gap < len(ends_s) and begins_s[gap] < frame.stamp_s
        yield replace(frame, in_gap=True) if in_gap else frame


def _frames_so_far(run: Run) -> Iterator[Frame]:
    """The same, with gaps as far as they are known at each frame."""
    return map(GapsSoFar().marked, _usable(run))


def _usable(run: Run) -> Iterator[Frame]:
    has_pose = run.pose is not None and bool(
        np.isfinite(run.pose.stack("x", "y")).all(axis=1).any()
    )
    is_on = False
    for frame in run.frames():
        is_on = is_on or can_start(frame, at_pose=has_pose)
        if is_on:
            yield frame
            if not math.isfinite(sum(frame.tread_speeds_m_s.tolist())):
                return
