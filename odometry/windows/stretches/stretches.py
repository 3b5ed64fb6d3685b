"""Stretches of measured positions: the shape of a path, which needs no measured yaw."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.errors import WindowError
from odometry.recording.run import Run, run_names
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.gyroscope_yaw import yaw_rates_of
from odometry.windows.recorded.record import (
    FEW_POSES,
    LEAST_POSITIONS,
    Record,
    position_record_of,
    straddling,
    summed,
    words,
)
from odometry.windows.recorded.stuck import without_stuck
from odometry.windows.travel.horizons import spatial_horizons
from odometry.windows.travel.windows import Windows, laid_together

MOST_POSITIONS = 25  # of a stretch; the covariance of more takes time and adds little
FEW = 0.1  # share of the stretches that may be lost for having fewer positions than the others


@dataclass(frozen=True)
class Stretches:
    """K stretches of n + 1 measured positions each; where they start and point is not known.

    Attributes
    ----------
    ends : Windows
        K n windows: from the first position of a stretch to each of its others, in order. Their
        `measured` is the way from one to the other in the frame of the positions, without yaw.
    steps : int
        n.
    arm_m : (2,)
        Place of the antenna in the robot frame; its origin where `[sensors]` does not state it.
    arm_stated : bool
    turns_late_s : float
        Half of the gyroscope's period: whether a rate is the mean before its stamp, after it or of
        that moment is not recorded. 0 without one.
    """

    ends: Windows
    steps: int
    arm_m: FloatArray
    arm_stated: bool
    turns_late_s: float = 0.0

    def __len__(self) -> int:
        return len(self.ends) // self.steps

    @property
    def measured(self) -> FloatArray:
        """Ways (K, n, 2) from the first position of each stretch to its others."""
        return self.ends.measured[:, :2].reshape(-1, self.steps, 2)

    @cached_property
    def turns_rad(self) -> FloatArray | None:
        """Turns (K, n) by the gyroscope from each first position; None where treads carry yaw."""
        rates = self.ends.inputs.yaw_rate_rad_s
        return None if rates is None else self.ends.integrated(rates).reshape(-1, self.steps)

    @property
    def lasts_s(self) -> FloatArray:
        """Time (K, n) from each first position to the others."""
        return self.ends.integrated(np.ones_like(self.ends.steps_s)).reshape(-1, self.steps)

    @property
    def steps_m(self) -> FloatArray:
        """Wheel travel (K, n) from each position to the next."""
        return np.diff(self.ends.travel_m.reshape(-1, self.steps), axis=1, prepend=0.0)

    @property
    def travel_m(self) -> FloatArray:
        """Wheel travel (K,) of each stretch."""
        return self.ends.travel_m[self.steps - 1 :: self.steps]

    @property
    def run(self) -> AnyArray:
        """Name (K,) of the run of each stretch."""
        return self.ends.run[:: self.steps]

    @property
    def terrain(self) -> AnyArray:
        """Terrain (K,) of each stretch."""
        return self.ends.terrain[:: self.steps]

    @property
    def first(self) -> IntArray:
        """Sample (K,) at which each stretch starts."""
        return self.ends.first[:: self.steps]

    @property
    def last(self) -> IntArray:
        """Sample (K,) at which each ends."""
        return self.ends.last[self.steps - 1 :: self.steps]

    @property
    def left_out(self) -> Counter[str]:
        """How many stretches of the runs there are not, by reason."""
        return self.ends.left_out

    def where(self, chosen: BoolArray) -> "Stretches":
        """The chosen (K,) stretches."""
        return replace(self, ends=self.ends.where(np.repeat(chosen, self.steps)))


def stretches_of(runs: Sequence[Run], length_m: float, config: WindowConfig) -> Stretches:
    """Cut runs into stretches of a wheel travel, end to end.

    None straddles a gap, a change of terrain or of `window`. All have the same number of
    positions, evenly chosen where there are more.

    Parameters
    ----------
    runs : sequence of Run
    length_m : float
        Wheel travel of a stretch.
    config : WindowConfig
        Defines a gap, and how short a stretch may be.

    Raises
    ------
    WindowError
        If a run has no positions, its antenna sits elsewhere than that of another, or there is no
        stretch in any of them.
    """
    records = [position_record_with_yaw_rates(run, config) for run in runs]
    found = [_spans(record, length_m, config) for record in records]
    sizes = np.concatenate([last - first for first, last, _ in found])
    if not len(sizes):
        left_out = words(summed(left_out for *_, left_out in found))
        raise WindowError(
            f"no stretch of {length_m:.3g} m with {LEAST_POSITIONS} measured positions without a "
            f"gap in {', '.join(run.name for run in runs)}{'; ' if left_out else ''}{left_out}"
        )
    steps = int(min(max(np.quantile(sizes, FEW), LEAST_POSITIONS - 1), MOST_POSITIONS - 1))
    parts = [
        _ends(record, name, steps, of)
        for record, name, of in zip(records, run_names(runs), found, strict=True)
    ]
    late_s = max(_half_period_s(run) for run in runs)
    return Stretches(laid_together(parts), steps, *_shared_arm(runs), late_s)


def _half_period_s(run: Run) -> float:
    rates = run.yaw_rate
    if rates is None or len(rates.stamps_s) < 2:
        return 0.0
    return float(np.median(np.diff(rates.stamps_s)) / 2)


def _shared_arm(runs: Sequence[Run]) -> tuple[FloatArray, bool]:
    """Place (2,) of the antenna that `[sensors]` of all runs states, else zero; and whether."""
    arms = {run.sensors.pose_m: run for run in runs}
    if len(arms) > 1:
        (here, first), (there, second), *_ = arms.items()
        raise WindowError(
            f"{second.folder}: [sensors] pose = {there or 'not stated'}, but {first.folder} has "
            f"{here or 'none'}; expected runs of one antenna"
        )
    (stated,) = arms
    return np.array(stated or (0.0, 0.0))[:2], stated is not None


def position_record_with_yaw_rates(run: Run, config: WindowConfig) -> Record:
    """`position_record_of`, its inputs with the gyroscope's yaw rates where there are any."""
    record = without_stuck(position_record_of(run, config))
    rates = yaw_rates_of(record)
    return replace(record, inputs=replace(record.inputs, yaw_rate_rad_s=rates))


class _Spans(NamedTuple):
    """First and last position (K,) of the stretches of a run, and how many were left out."""

    first: IntArray
    last: IntArray
    left_out: Counter[str]


def _spans(record: Record, length_m: float, config: WindowConfig) -> _Spans:
    travel_m = record.travel_m[record.pose_samples]
    found = [np.empty((0, 2), dtype=np.int64)]
    begins = np.flatnonzero(np.diff(record.stretch, prepend=-1))
    for begin, end in zip(begins, [*begins[1:], len(travel_m)], strict=True):
        found.append(begin + _of_unbroken(travel_m[begin:end], length_m, config.shortest))
    first, last = np.concatenate(found).T
    left_out = straddling(record.breaks, *spatial_horizons(travel_m, length_m, length_m).T)
    enough = last - first >= LEAST_POSITIONS - 1
    left_out[FEW_POSES] += int(np.count_nonzero(~enough))
    return _Spans(first[enough], last[enough], +left_out)


def _of_unbroken(travel_m: FloatArray, length_m: float, shortest: float) -> IntArray:
    """First and last position (K, 2): as many equal stretches as come nearest to the length."""
    whole_m = travel_m[-1] - travel_m[0]
    if whole_m < shortest * length_m:
        return np.empty((0, 2), dtype=np.int64)
    count = max(1, round(whole_m / length_m))
    return spatial_horizons(travel_m, whole_m / count * (1 - 1e-9), whole_m / count)


def _ends(record: Record, name: str, steps: int, spans: _Spans) -> Windows:
    first, last, left_out = spans
    kept = last - first >= steps
    left_out[FEW_POSES] += int(np.count_nonzero(~kept))
    chosen = np.rint(np.linspace(first[kept], last[kept], steps + 1, axis=1)).astype(np.int64)
    starts, others = np.repeat(chosen[:, 0], steps), chosen[:, 1:].ravel()
    travel_m = record.travel_m[record.pose_samples]
    return Windows(
        record.inputs,
        np.append(np.diff(record.stamps_s), 0.0),
        record.pose_samples[starts],
        record.pose_samples[others],
        starts,
        others,
        record.poses[others] - record.poses[starts],
        travel_m[others] - travel_m[starts],
        record.pose_s[starts],
        np.full(len(starts), name, dtype=object),
        record.terrains[starts],
        +left_out,
    )
