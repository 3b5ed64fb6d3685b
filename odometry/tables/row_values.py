"""What values say of rows that come together: copies, of several sensors, or readings."""

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.tables.table import Table

# Of the share of other rows that have a new value: rows that follow close and have one more rarely
# are copies.
SAME = 0.1
DIGITS = 0.01  # of the usual step of a column: copies that were written with other digits
SURELY = 10.0  # rows in which two columns would be new by chance
MOSTLY = 0.8  # share of the rows that are new in one of two columns
MOTION = ("v_left", "v_right", "gyro_z", "x", "y", "vx", "vy", "wz")
# Root mean square of the step to the row before, over that to one of those before it: 1.05 at most
# in 75 real recordings, 2 and more where two sources take turns.
BACK, REACH = 1.25, 4
LIMIT = 0.3  # of the median change of a log of changes, that its smallest ones have at least


def are_of_one_sensor(table: Table, close: BoolArray) -> bool:
    """Whether rows, of which some (N,) follow close, may be the readings of a steady sensor."""
    of_others = _are_merged(table) or take_turns(table) or are_changes(table)
    return not (of_others or repeat_values(table, close))


def are_changes(table: Table) -> bool:
    """Whether rows were recorded only where a tread speed had changed by more than a limit."""
    if not {"v_left", "v_right"} <= table.columns.keys():
        return False
    changes = np.abs(np.diff(table.stack("v_left", "v_right"), axis=0)).max(axis=1)
    return bool(np.quantile(changes, 0.02) > LIMIT * np.median(changes))


def repeat_values(table: Table, close: BoolArray) -> bool:
    """Whether rows (N,) that follow close repeat the values before them, and others do not."""
    change = False
    for name, column in table.columns.items():
        if name == "t":
            continue
        known, new = _changes(column)
        together, others = new[known & close[1:]], new[known & ~close[1:]]
        if np.sum(together) * len(others) > SAME * np.sum(others) * len(together):
            return False
        change |= bool(others.any())
    return change


def _changes(column: AnyArray) -> tuple[BoolArray, BoolArray]:
    """Where values of a column (N,) and those before are known, and where new, both (N - 1,)."""
    if column.dtype.kind != "f":
        return np.ones(len(column) - 1, dtype=bool), column[1:] != column[:-1]
    steps = np.abs(np.diff(column))
    known = np.isfinite(steps)
    usual = np.sqrt(np.mean(steps[known] ** 2)) if known.any() else 0.0
    return known, steps > DIGITS * usual


def are_copies(table: Table) -> bool:
    """Whether the rows of a table that were dropped, as they repeat a stamp, repeat its values."""
    rows = table.with_repeated()
    return repeat_values(rows, np.isin(rows.lines, table.repeated_lines))


def take_turns(table: Table) -> bool:
    """Whether rows are nearer to one of those before than to the last: of several sources."""
    for name in MOTION:
        values = table.columns.get(name)
        if values is None or np.isfinite(values).sum() <= REACH:
            continue
        steps = [np.nanmean((values[k:] - values[:-k]) ** 2) for k in range(1, REACH + 1)]
        if steps[0] > BACK**2 * min(steps[1:]):
            return True
    return False


def _are_merged(table: Table) -> bool:
    """Whether most rows are new in one of two columns, and none in both: the latest of each."""
    steps = np.diff(np.array(_numbers(table)), axis=1)
    new = (np.isfinite(steps) & (steps != 0)).astype(np.float64)
    rows, counts, both = new.shape[1], new.sum(axis=1), new @ new.T
    by_chance = np.outer(counts, counts) / rows
    in_turn = (by_chance > SURELY) & (both < SAME * by_chance)
    return bool((in_turn & (np.add.outer(counts, counts) - both > MOSTLY * rows)).any())


def _numbers(table: Table) -> list[FloatArray]:
    return [v for name, v in table.columns.items() if name != "t" and v.dtype.kind == "f"]
