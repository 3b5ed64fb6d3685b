"""A recording with a cause undone: what it would be if that cause were the right one."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.recording.run import Run
from odometry.tables.table import Table

Mend = Callable[[Run], Run]
Course = Callable[[FloatArray], FloatArray]
TREADS = ("v_left", "v_right")


def changed(table: str, name: str, change: Callable[[FloatArray], FloatArray]) -> Mend:
    """One column of one table through a function."""

    def mend(run: Run) -> Run:
        of = getattr(run, table)
        return replace(run, **{table: replace(of, columns={**of.columns, name: change(of[name])})})

    return mend


def in_turn(*mends: Mend) -> Mend:
    """One after the other."""

    def mend(run: Run) -> Run:
        for one in mends:
            run = one(run)
        return run

    return mend


def times(table: str, factor: float, *names: str) -> Mend:
    """Columns times a factor."""
    return in_turn(*(changed(table, name, lambda values: factor * values) for name in names))


def treads_times(left: float, right: float) -> Mend:
    """Both tread speeds, each times a factor of its own."""
    return in_turn(times("odometry", left, "v_left"), times("odometry", right, "v_right"))


def exchanged(run: Run) -> Run:
    """Left and right tread exchanged."""
    left, right = (run.odometry[name] for name in TREADS)
    columns = {**run.odometry.columns, "v_left": right, "v_right": left}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def yaw_plus(offset_rad: float) -> Mend:
    """Measured yaw plus a constant."""
    return changed("pose", "yaw", lambda yaw: yaw + offset_rad)


def gyroscope_times(run: Run, factor: float) -> Mend:
    """The yaw rate that is read, times a factor, in its own file."""
    found = run.yaw_rate
    if run.imu is None or found is None or found.file != "imu.csv":
        return times("odometry", factor, "gyro_z")
    axes = [name for name in ("gyro_x", "gyro_y", "gyro_z") if name in run.imu]
    return times("imu", factor, *axes)


def sooner(names: tuple[str, ...], seconds: float | Course) -> Mend:
    """Columns of odometry.csv as they were so much later, at the stamps as they are.

    `seconds` may be a function of stamps (N,) to (N,).
    """

    def mend(run: Run) -> Run:
        t = run.odometry.stamps_s
        by_s = seconds(t) if callable(seconds) else seconds

        def at_once(values: FloatArray) -> FloatArray:
            return np.asarray(np.interp(t + by_s, t, values))

        return in_turn(*(changed("odometry", name, at_once) for name in names))(run)

    return mend


def yaw_sooner(seconds: float) -> Mend:
    """Measured yaw as it was so much later, at the stamps as they are; NaN beyond its rows."""

    def mend(run: Run) -> Run:
        if run.pose is None:
            return run
        t = run.pose.stamps_s

        def at_once(yaw: FloatArray) -> FloatArray:
            known = np.isfinite(yaw)
            turned = np.unwrap(yaw[known])
            later = np.interp(t + seconds, t[known], turned, left=np.nan, right=np.nan)
            return np.where(known, later, np.nan)

        return changed("pose", "yaw", at_once)(run)

    return mend


def positions_sooner(seconds: float) -> Mend:
    """Measured positions at stamps that are so much earlier, with the yaw of these stamps."""
    stamps = changed("pose", "t", lambda stamps_s: stamps_s - seconds)
    return in_turn(stamps, yaw_sooner(-seconds))


def between(run: Run, begin_s: float, end_s: float) -> Run:
    """The rows of all tables of motion between two stamps."""

    def part(table: Table) -> Table:
        first, last = np.searchsorted(table.stamps_s, [begin_s, end_s])
        return table.rows(slice(int(first), int(last)))

    pose, imu = (part(table) if table is not None else None for table in (run.pose, run.imu))
    return replace(run, odometry=part(run.odometry), pose=pose, imu=imu)


def stamps_moved(table: str, after_s: float, by_s: float) -> Mend:
    """Stamps of one table after one of them plus a constant, without rows that then overlap."""

    def mend(run: Run) -> Run:
        of = getattr(run, table)
        stamps_s, later = of.stamps_s, of.stamps_s > after_s
        new_s = stamps_s + np.where(later, by_s, 0.0)
        kept = ~later | (new_s > after_s)
        columns = {name: values[kept] for name, values in of.columns.items()}
        rows = of.rows(np.flatnonzero(kept))
        return replace(run, **{table: replace(rows, columns={**columns, "t": new_s[kept]})})

    return mend


def restamped(table: str, late_s: Course) -> Mend:
    """Stamps of one table less a function of them, without rows that are no later than others."""

    def mend(run: Run) -> Run:
        of = getattr(run, table)
        new_s = of.stamps_s - late_s(of.stamps_s)
        latest_s = np.maximum.accumulate(np.append(-np.inf, new_s[:-1]))
        rows = np.flatnonzero(new_s > latest_s)
        kept = of.rows(rows)
        return replace(run, **{table: replace(kept, columns={**kept.columns, "t": new_s[rows]})})

    return mend


def moved(forward_m: float, left_m: float, offset_rad: float) -> Mend:
    """Positions of a point so far behind and to the right of the measured one.

    The robot's axis is that of the measured yaw plus an offset.
    """

    def mend(run: Run) -> Run:
        assert run.pose is not None  # noqa: S101 - the cause is one of poses
        heading = run.pose["yaw"] + offset_rad
        x = run.pose["x"] - forward_m * np.cos(heading) + left_m * np.sin(heading)
        y = run.pose["y"] - forward_m * np.sin(heading) - left_m * np.cos(heading)
        return replace(run, pose=replace(run.pose, columns={**run.pose.columns, "x": x, "y": y}))

    return mend
