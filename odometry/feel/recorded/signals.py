"""Signals for terrain by feel on one even grid of time: IMU in checked units, treads, currents."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.errors import RunFolderError
from odometry.feel.recorded.clock_check import clock_fault
from odometry.feel.recorded.imu_check import ImuSums
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains
from odometry.tables.table import Table
from odometry.windows.recorded.gaps import odometry_gaps

GYRO = ("gyro_x", "gyro_y", "gyro_z")
ACCEL = ("accel_x", "accel_y", "accel_z")
AXES = (*GYRO, *ACCEL)
CURRENTS = ("current_left", "current_right")
LEAST_RATE_HZ = 4.0  # below it a window of 1 s has too few samples
GAP_PERIODS = 5.0  # a step of more usual periods is a gap
LEAST_SHARE = 0.5  # of the rows: a column with fewer numbers counts as absent
LEAST_CHANGE = 1e-9  # a column that changes less is constant: no sensor is so quiet


@dataclass(frozen=True)
class FeelSignals:
    """Columns at N even stamps; NaN where nothing was measured.

    Attributes
    ----------
    begin_s, rate_hz : float
        The first stamp, and the samples a second.
    axes : Mapping of str to (N,)
        Those of AXES that the run has, in the robot frame [rad/s, m/s2].
    treads_m_s : (N, 2)
        Left and right, as held from stamp to stamp.
    currents_a : (N, 2) or None
        Left and right, as held; a zero is a dropout, and NaN.
    labels : (N,) of str
        The terrain that the run names; "unknown" where it names none.
    repeats : Mapping of str to float
        By axis, the share of the recorded samples, while the treads move, that are the same as the
        one before. They come from rounding, clipping, or samples that are held.
    """

    begin_s: float
    rate_hz: float
    axes: Mapping[str, FloatArray]
    treads_m_s: FloatArray
    currents_a: FloatArray | None
    labels: AnyArray
    repeats: Mapping[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.treads_m_s)


def feel_signals(run: Run) -> FeelSignals:
    """Bring a run onto the even grid of its IMU, or of odometry.csv where that holds the axes.

    Axes are interpolated between stamps, and turned into the robot frame where run.toml states the
    attitude of the IMU; a column without numbers, or of one number, counts as absent.

    Raises
    ------
    RunFolderError
        If there is no axis, they are recorded too slowly, their sizes are not in rad/s and m/s2
        with gravity along z, gyro_z turns against the treads (see `imu_check`), or not when they do
        (see `clock_check`).
    """
    table, axes = axes_of(run)
    stamps_s = table.stamps_s
    rate_hz = usual_rate_hz(stamps_s)
    if rate_hz < LEAST_RATE_HZ:
        raise RunFolderError(
            f"{table.file}: {rate_hz:.3g} rows a second; terrain by feel needs {LEAST_RATE_HZ:g} "
            "or more"
        )
    odometry_s = run.odometry.stamps_s
    period_s = float(np.median(np.diff(odometry_s))) if len(odometry_s) > 1 else 0.0
    begin_s = max(float(stamps_s[0]), float(odometry_s[0]))
    end_s = min(float(stamps_s[-1]), float(odometry_s[-1]) + period_s)
    if end_s <= begin_s:
        raise RunFolderError(
            f"{table.file}: stamps {stamps_s[0]:g} to {stamps_s[-1]:g}, those of odometry.csv "
            f"{odometry_s[0]:g} to {odometry_s[-1]:g}; expected some time in common"
        )
    grid_s = begin_s + np.arange(int((end_s - begin_s) * rate_hz + 1e-6) + 1) / rate_hz
    even = {name: interpolated(grid_s, stamps_s, of, rate_hz) for name, of in axes.items()}
    held = held_rows(odometry_s, grid_s)
    treads = run.odometry.stack("v_left", "v_right")[held]
    treads[within_gaps(grid_s, odometry_gaps(run).spans_s)] = np.nan
    signals = FeelSignals(
        begin_s,
        rate_hz,
        even,
        treads,
        _currents(run.odometry, held),
        row_terrains(run)[held],
        _repeats(run, stamps_s, axes),
    )
    width_m, fault = run.robot.track_width, ""
    if "gyro_z" in axes:
        fault = clock_fault(signals.axes["gyro_z"], treads, rate_hz, width_m)
    fault = fault or ImuSums().plus(signals.axes, treads, rate_hz, width_m).fault()
    if fault:
        raise RunFolderError(f"{table.file}: {fault}")
    return signals


def usual_rate_hz(stamps_s: FloatArray) -> float:
    """Samples a second, gaps aside: the mean over steps, which bursts of a bus leave as it is."""
    steps_s = np.diff(stamps_s)
    if not len(steps_s):
        return 0.0
    usual = steps_s[steps_s <= GAP_PERIODS * max(np.median(steps_s), steps_s.mean())]
    return float(1 / usual.mean())


def axes_of(run: Run) -> tuple[Table, dict[str, FloatArray]]:
    """The table that holds axes of the IMU, and the axes in the robot frame."""
    for table in (run.imu, run.odometry):
        if table is None:
            continue
        found = {name: table[name] for name in AXES if name in table and has_numbers(table[name])}
        if table is run.imu and run.sensors.imu_rad is not None:
            found = in_robot_frame(found, np.array(run.sensors.imu_rad))
        if found:
            return table, found
    raise RunFolderError(
        f"{run.folder}: no column of imu.csv or odometry.csv among {', '.join(AXES)} holds "
        "numbers that change; terrain by feel needs one"
    )


def has_numbers(column: AnyArray) -> bool:
    """Whether a column holds numbers that change."""
    if column.dtype.kind != "f":
        return False
    finite = column[np.isfinite(column)]
    return bool(len(finite) >= LEAST_SHARE * len(column) and np.ptp(finite) > LEAST_CHANGE)


def in_robot_frame(
    axes: dict[str, FloatArray], roll_pitch_yaw: FloatArray
) -> dict[str, FloatArray]:
    """Axes of the sensor in the robot frame; a triple that is not whole cannot be turned."""
    rotation = rotation_from_roll_pitch_yaw(roll_pitch_yaw)
    turned: dict[str, FloatArray] = {}
    for triple in (GYRO, ACCEL):
        if all(name in axes for name in triple):
            columns = np.stack([axes[name] for name in triple], axis=-1) @ rotation.T
            turned |= dict(zip(triple, columns.T, strict=True))
    return turned


def interpolated(
    grid_s: FloatArray, stamps_s: FloatArray, values: FloatArray, rate_hz: float
) -> FloatArray:
    """Values (N,) of a column at even stamps (N,), linear between numbers; NaN within gaps."""
    there = np.isfinite(values)
    stamps_s, values = stamps_s[there], values[there]
    even = np.interp(grid_s, stamps_s, values)
    gaps = np.flatnonzero(np.diff(stamps_s) > GAP_PERIODS / rate_hz)
    even[within_gaps(grid_s, np.column_stack([stamps_s[gaps], stamps_s[gaps + 1]]))] = np.nan
    even[(grid_s < stamps_s[0] - 1e-9) | (grid_s > stamps_s[-1] + 1e-9)] = np.nan
    return even


def within_gaps(grid_s: FloatArray, spans_s: FloatArray) -> AnyArray:
    """Whether each stamp (N,) lies within one of the spans (G, 2), which are in order."""
    if not len(spans_s):
        return np.zeros(len(grid_s), dtype=bool)
    span = np.clip(np.searchsorted(spans_s[:, 0], grid_s, side="left") - 1, 0, None)
    return np.asarray((grid_s > spans_s[span, 0]) & (grid_s < spans_s[span, 1]))


def _repeats(run: Run, stamps_s: FloatArray, axes: Mapping[str, FloatArray]) -> Mapping[str, float]:
    speeds_m_s = np.abs(run.odometry.stack("v_left", "v_right")).max(axis=1)
    moving = speeds_m_s[held_rows(run.odometry.stamps_s, stamps_s[1:])] > 0
    samples = max(int(moving.sum()), 1)
    return {name: int(np.sum(np.diff(of)[moving] == 0)) / samples for name, of in axes.items()}


def _currents(odometry: Table, held: AnyArray) -> FloatArray | None:
    if not all(name in odometry and has_numbers(odometry[name]) for name in CURRENTS):
        return None
    return current_sizes(odometry.stack(*CURRENTS)[held])


def current_sizes(currents_a: FloatArray) -> FloatArray:
    """Sizes (N, 2) of currents; a zero is a dropout, and NaN."""
    sizes = np.abs(currents_a)
    return np.where(sizes > 0, sizes, np.nan)


def held_rows(stamps_s: FloatArray, grid_s: FloatArray) -> IntArray:
    """The row of `stamps_s` in force at each of the even stamps (N,)."""
    return np.clip(np.searchsorted(stamps_s, grid_s + 1e-9, side="right") - 1, 0, None)
