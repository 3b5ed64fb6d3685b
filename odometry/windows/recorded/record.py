"""A run as windows are cut from it, and why windows are left out."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.errors import WindowError
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.measured_poses import (
    measured_poses,
    measured_positions,
    positions_at,
)
from odometry.windows.recorded.run_inputs import inputs_with_poses
from odometry.windows.recorded.spans import touched
from odometry.windows.recorded.turns import counted_turns

LEAST_POSITIONS = 4  # of a shape: three determine one bend and no change of it
POSE_PERIODS = 5.0  # poses farther apart than this many usual periods are a gap

CHANGE_OF_TERRAIN = "change of terrain"
CHANGE_OF_WINDOW = "change of `window`"
FEW_POSES = "fewer poses than most windows"
ODOMETRY_GAP = "gap of odometry.csv"
POSE_GAP = "gap of pose.csv"
STATIONARY = "treads stationary"
STUCK = "robot stuck, or poses held"
UNKNOWN_TURNS = "unknown count of whole turns"


@dataclass(frozen=True)
class Record:
    """Samples of one run: the stamps of odometry and of its poses, merged.

    Attributes
    ----------
    run : Run
    stamps_s : (N,)
    inputs : Inputs
        Of stack (N,), each in force until the next stamp.
    travel_m : (N,)
        Wheel travel up to each stamp.
    poses : (M, 3)
        Measured x, y, yaw; whole turns are counted, so that yaw is not wrapped.
    pose_samples : (M,)
        The sample at which each pose was measured.
    breaks : (M - 1,) of str
        Why no window goes from a pose to the next; empty where one may.
    terrains : (M,) of str
        Terrain at each pose.
    """

    run: Run
    stamps_s: FloatArray
    inputs: Inputs
    travel_m: FloatArray
    poses: FloatArray
    pose_samples: IntArray
    breaks: AnyArray
    terrains: AnyArray

    @property
    def pose_s(self) -> FloatArray:
        """Stamps (M,) of the poses."""
        return np.asarray(self.stamps_s[self.pose_samples])

    @property
    def stretch(self) -> IntArray:
        """Number (M,) of the stretch without break in which each pose lies."""
        return np.concatenate([[0], np.cumsum(self.breaks != "")])


def record_of(run: Run, config: WindowConfig) -> Record:
    """Merge odometry and poses of a run.

    Raises
    ------
    WindowError
        If the run has no two measured poses within the time of its odometry.
    """
    stamps_s, poses, chains = _within_odometry(run, *measured_poses(run))
    if len(stamps_s) < 2:
        raise WindowError(
            f"{run.folder}: {len(stamps_s)} measured poses within the time of odometry.csv, "
            "expected two or more: a window needs pose.csv with x and y"
        )
    turns = counted_turns(run, stamps_s, poses[:, 2])
    poses = np.column_stack([poses[:, :2], turns.yaw_rad])
    return _record(run, config, _Poses(stamps_s, poses, chains, turns.known))


def position_record_of(run: Run, config: WindowConfig) -> Record:
    """Merge odometry and measured positions of a run; yaw of its poses is NaN.

    Raises
    ------
    WindowError
        If the run has fewer than LEAST_POSITIONS positions within the time of its odometry.
    """
    stamps_s, positions, chains = _within_odometry(run, *measured_positions(run))
    if len(stamps_s) < LEAST_POSITIONS:
        raise WindowError(
            f"{run.folder}: {len(stamps_s)} measured positions within the time of odometry.csv, "
            f"expected {LEAST_POSITIONS} or more: the shape of a path needs x and y in pose.csv"
        )
    poses = np.column_stack([positions, np.full(len(positions), np.nan)])
    known = np.ones(len(poses) - 1, dtype=np.bool_)
    return _record(run, config, _Poses(stamps_s, poses, chains, known))


def _within_odometry(
    run: Run, stamps_s: FloatArray, places: FloatArray, chains: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    odometry_s = run.odometry.stamps_s
    inside = (stamps_s >= odometry_s[0]) & (stamps_s <= odometry_s[-1])
    return stamps_s[inside], places[inside], chains[inside]


class _Poses(NamedTuple):
    """Stamps (M,), poses (M, 3) and source windows (M,), and between which turns are known."""

    stamps_s: FloatArray
    poses: FloatArray
    chains: FloatArray
    known: BoolArray  # (M - 1,)


def _record(run: Run, config: WindowConfig, measured: _Poses) -> Record:
    pose_s, poses, chains, known = measured
    odometry_s = run.odometry.stamps_s
    stamps_s = np.unique(np.concatenate([odometry_s, pose_s]))
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    yaw_rad = poses[:, 2]
    heading_rad = None if np.isnan(yaw_rad).any() else np.interp(odometry_s, pose_s, yaw_rad)
    position_m = positions_at(odometry_s, pose_s, poses)
    inputs = inputs_with_poses(run, heading_rad, position_m).rows(rows)
    inputs = replace(inputs, time_s=stamps_s - odometry_s[0])
    speed = np.abs(inputs.tread_speeds_m_s).mean(axis=1)
    travel_m = np.concatenate([[0.0], np.cumsum(speed[:-1] * np.diff(stamps_s))])
    samples = np.searchsorted(stamps_s, pose_s)
    terrains = row_terrains(run)[rows]
    changes = np.concatenate([[0], np.cumsum(terrains[1:] != terrains[:-1])])[samples]
    longest_s = max(config.pose_gap_s, POSE_PERIODS * np.median(np.diff(pose_s)))
    breaks = np.select(
        [
            touched(odometry_gaps(run).spans_s, pose_s[:-1], pose_s[1:]),
            np.diff(pose_s) > longest_s,
            chains[1:] != chains[:-1],
            changes[1:] != changes[:-1],
            ~known,
        ],
        [ODOMETRY_GAP, POSE_GAP, CHANGE_OF_WINDOW, CHANGE_OF_TERRAIN, UNKNOWN_TURNS],
        "",
    ).astype(object)
    return Record(run, stamps_s, inputs, travel_m, poses, samples, breaks, terrains[samples])


def straddling(breaks: AnyArray, first: IntArray, last: IntArray) -> Counter[str]:
    """Of windows laid without regard to breaks, how many straddle one, by the first that they do.

    Parameters
    ----------
    breaks : (M - 1,) of str
        What parts a pose from the next; empty where nothing does.
    first, last : (K,)
        Poses at the ends of each window.
    """
    places = np.flatnonzero(breaks != "")
    if not len(places):
        return Counter()
    next_break = np.searchsorted(places, first)
    inside = next_break < np.searchsorted(places, last)
    return Counter(map(str, breaks[places[next_break[inside]]]))


def summed(parts: Iterable[Counter[str]]) -> Counter[str]:
    """The counts of several runs together."""
    return sum(parts, Counter())


def words(left_out: Counter[str]) -> str:
    """One line, the most frequent reason first; empty where nothing was left out."""
    total = left_out.total()
    if not total:
        return ""
    of = ", ".join(f"{reason} ({count})" for reason, count in left_out.most_common())
    return f"{total} {'window' if total == 1 else 'windows'} left out: {of}"
