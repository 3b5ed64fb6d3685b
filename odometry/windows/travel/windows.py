"""Windows of recorded motion: inputs on the way, and the measured motion from end to end."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.errors import WindowError
from odometry.geometry import se2
from odometry.models.inputs import Inputs, joined
from odometry.recording.run import Run, run_names
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import (
    STATIONARY,
    STUCK,
    Record,
    record_of,
    straddling,
    summed,
    words,
)
from odometry.windows.recorded.stuck import without_stuck
from odometry.windows.travel.horizons import spatial_horizons

STANDING_M = 1e-3  # less wheel travel than this is no evidence on a model


@dataclass(frozen=True)
class Windows:
    """K windows over N samples of one or many runs.

    Attributes
    ----------
    inputs : Inputs
        Of stack (N,).
    steps_s : (N,)
        How long each sample was in force; 0 at the end of a run.
    first, last : (K,)
        Samples at which a window starts and ends.
    first_pose, last_pose : (K,)
        Numbers of the measured poses there: windows may share one, and its noise.
    measured : (K, 3)
        Pose at the end in the level frame of the pose at the start; yaw is not wrapped.
    travel_m : (K,)
        Wheel travel.
    start_s : (K,)
    run, terrain : (K,) of str
        Name of the run (its path where names are equal), and of the terrain.
    left_out : Counter of str
        How many windows of the runs there are not, by reason (`odometry.windows.recorded.record`).
    """

    inputs: Inputs
    steps_s: FloatArray
    first: IntArray
    last: IntArray
    first_pose: IntArray
    last_pose: IntArray
    measured: FloatArray
    travel_m: FloatArray
    start_s: FloatArray
    run: AnyArray
    terrain: AnyArray
    left_out: Counter[str] = field(default_factory=Counter)

    def __len__(self) -> int:
        return len(self.first)

    @cached_property
    def tread_travel_m(self) -> FloatArray:
        """What the treads travel while each sample is in force (2, N), left and right."""
        return np.ascontiguousarray(self.inputs.tread_speeds_m_s.T) * self.steps_s

    def integrated(self, rates: FloatArray) -> FloatArray:
        """Integral (K,) of rates (N,) over the samples of each window."""
        sums = np.concatenate([[0.0], np.cumsum(rates * self.steps_s)])
        return np.asarray(sums[self.last] - sums[self.first])

    def where(self, chosen: BoolArray) -> "Windows":
        """The chosen (K,) windows, with the samples that they need."""
        first, last = self.first[chosen], self.last[chosen]
        depth = np.zeros(len(self.steps_s) + 1, dtype=np.int64)
        np.add.at(depth, first, 1)
        np.add.at(depth, last + 1, -1)
        kept = np.flatnonzero(np.cumsum(depth[:-1]) > 0)
        return Windows(
            self.inputs.rows(kept),
            self.steps_s[kept],
            np.searchsorted(kept, first),
            np.searchsorted(kept, last),
            self.first_pose[chosen],
            self.last_pose[chosen],
            self.measured[chosen],
            self.travel_m[chosen],
            self.start_s[chosen],
            self.run[chosen],
            self.terrain[chosen],
            self.left_out,
        )


def windows_of(runs: Sequence[Run], config: WindowConfig) -> Windows:
    """Cut runs into windows of one horizon; none straddles a gap or a change of `window`.

    Windows in which the wheels stand still or the robot is stuck are left out, and those in which
    the number of whole turns is not known.

    Raises
    ------
    WindowError
        If a run has no measured poses, or there is no window in any of them.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> len(odometry.windows_of([run], odometry.WindowConfig(horizon_m=5.0)))
    7
    """
    if not runs:
        raise WindowError("no run was given; expected one or more")
    records = [without_stuck(record_of(run, config)) for run in runs]
    parts = [
        _windows_of_record(record, name, config)
        for record, name in zip(records, run_names(runs), strict=True)
    ]
    if not sum(map(len, parts)):
        raise WindowError(_no_window(records, config, summed(part.left_out for part in parts)))
    return laid_together(parts)


def laid_together(parts: Sequence[Windows]) -> Windows:
    """Windows of several runs, samples and poses numbered on."""
    samples = np.cumsum([0, *(len(part.steps_s) for part in parts[:-1])])
    poses = np.cumsum([0, *(1 + part.last_pose.max(initial=-1) for part in parts[:-1])])
    return Windows(
        joined([part.inputs for part in parts]),
        np.concatenate([part.steps_s for part in parts]),
        np.concatenate([part.first + n for part, n in zip(parts, samples, strict=True)]),
        np.concatenate([part.last + n for part, n in zip(parts, samples, strict=True)]),
        np.concatenate([part.first_pose + n for part, n in zip(parts, poses, strict=True)]),
        np.concatenate([part.last_pose + n for part, n in zip(parts, poses, strict=True)]),
        np.concatenate([part.measured for part in parts]),
        np.concatenate([part.travel_m for part in parts]),
        np.concatenate([part.start_s for part in parts]),
        np.concatenate([part.run for part in parts]),
        np.concatenate([part.terrain for part in parts]),
        summed(part.left_out for part in parts),
    )


def _windows_of_record(record: Record, name: str, config: WindowConfig) -> Windows:
    pose_s = record.pose_s
    travel_m = record.travel_m[record.pose_samples]
    measure, horizon = (
        (pose_s, config.horizon_s) if config.horizon_s else (travel_m, config.travel_m)
    )
    found = [np.empty((0, 2), dtype=np.int64)]
    begins = np.flatnonzero(np.diff(record.stretch, prepend=-1))
    for begin, end in zip(begins, [*begins[1:], len(pose_s)], strict=True):
        found.append(begin + _windows_of_stretch(measure[begin:end], horizon, config))
    first, last = np.concatenate(found).T
    moved = travel_m[last] - travel_m[first] > STANDING_M
    unbroken = _windows_of_stretch(measure, horizon, config)
    left_out = straddling(record.breaks, *unbroken.T)
    left_out[STATIONARY] += int(np.count_nonzero(~moved))
    first, last = first[moved], last[moved]
    return Windows(
        record.inputs,
        np.append(np.diff(record.stamps_s), 0.0),
        record.pose_samples[first],
        record.pose_samples[last],
        first,
        last,
        _motion(record.poses, first, last),
        travel_m[last] - travel_m[first],
        pose_s[first],
        np.full(len(first), name, dtype=object),
        record.terrains[first],
        +left_out,
    )


def _motion(poses: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """Poses (K, 3) of the ends relative to the starts, with whole turns."""
    motion = se2.between(poses[first], poses[last])
    motion[:, 2] = poses[last, 2] - poses[first, 2]
    return np.asarray(motion)


def _windows_of_stretch(measure: FloatArray, horizon: float, config: WindowConfig) -> IntArray:
    """First and last pose (K, 2) of the windows of one stretch; a short stretch is one window."""
    length = measure[-1] - measure[0]
    if config.shortest * horizon <= length < horizon:
        return np.array([[0, len(measure) - 1]])
    return spatial_horizons(measure, horizon, config.stride * horizon)


def _no_window(records: Sequence[Record], config: WindowConfig, left_out: Counter[str]) -> str:
    wanted = f"{config.horizon_s:g} s" if config.horizon_s else f"{config.travel_m:g} m"
    driven_m = max(float(np.ptp(record.travel_m)) for record in records)
    measured_m = max(float(np.ptp(record.travel_m[record.pose_samples])) for record in records)
    between = f", {measured_m:.2f} m between poses" if driven_m - measured_m > STANDING_M else ""
    drive = "record a drive" if driven_m <= STANDING_M else "choose a shorter horizon"
    return "; ".join(
        part
        for part in (
            f"no window of {wanted} in {', '.join(record.run.name for record in records)}: the "
            f"longest run has {driven_m:.2f} m of wheel travel{between}",
            words(left_out),
            "" if STUCK in left_out else drive,
        )
        if part
    )
