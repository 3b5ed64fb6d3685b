"""Recordings that are there twice, whole or in part: a model would be tested on its own data."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.recording.run import Run
from odometry.tables.table import Table

ROWS = 24  # one after the other that two recordings do not share by chance
CHANGES = 12  # of these rows: where little changes, values repeat
FACTORS = np.random.default_rng(0).integers(1, 2**63, 512, dtype=np.uint64) * 2 + 1


def check_no_run_twice(runs: Sequence[Run]) -> None:
    """Raise RunFolderError if a recording is there twice, whole or in part.

    The same folder, but for parts of it that do not overlap; copies: the same measured values row
    by row, whatever their stamps; runs that overlap: `ROWS` rows one after the other, of which
    `CHANGES` differ, are the same in all that both measured. Tread speeds alone may be commands,
    and those may be given twice.
    """
    alike = _with_alike_odometry(runs)
    for number, run in enumerate(runs):
        for place, other in enumerate(runs[:number]):
            same_folder = run.folder.resolve() == other.folder.resolve()
            if same_folder and _are_equal(run.odometry, other.odometry):
                raise RunFolderError(
                    f"{run.folder.resolve()} is given twice; expected each run once: none can be "
                    "its own test"
                )
            shared = _shared(run, other, may_overlap=(place, number) in alike)
            if shared:
                raise RunFolderError(
                    f"{other.folder} and {run.folder} hold {shared}; expected each run once: none "
                    "can be its own test"
                )


def _with_alike_odometry(runs: Sequence[Run]) -> set[tuple[int, int]]:
    """Pairs of runs that have rows of odometry.csv one after the other in common."""
    columns = [set(_numbers(run.odometry, run.odometry)) for run in runs]
    names = sorted(set.intersection(*columns)) if columns else []
    if not names:
        return set()
    sequences = [np.unique(_sequences(run.odometry.stack(*names))) for run in runs]
    of_run = np.repeat(np.arange(len(runs)), [len(one) for one in sequences])
    values = np.concatenate(sequences)
    order = np.lexsort((of_run, values))
    same = np.flatnonzero(values[order][1:] == values[order][:-1])
    pairs = np.unique(np.stack([of_run[order[same]], of_run[order[same + 1]]], axis=1), axis=0)
    return {(int(one), int(other)) for one, other in pairs}


def _shared(run: Run, other: Run, *, may_overlap: bool) -> str:
    """What two runs of a robot have in common, in words; "" where they are independent."""
    if run.robot != other.robot:
        return ""
    pairs = _measured_by_both(run, other)
    if not pairs:
        return ""
    if all(_are_equal(one, another) for one, another in pairs):
        return "the same recording (all values but the stamps are equal)"
    if may_overlap and all(_overlap(one, another) for one, another in pairs):
        return "parts of one recording that overlap (the same values row after row)"
    return ""


def _measured_by_both(run: Run, other: Run) -> list[tuple[Table, Table]]:
    """Tables of both; none where nothing but tread speeds was recorded."""
    pairs = [(run.odometry, other.odometry)]
    for one, another in ((run.pose, other.pose), (run.imu, other.imu)):
        if one is not None and another is not None:
            pairs.append((one, another))
    measured = [name for name in _numbers(*pairs[0]) if name not in ("v_left", "v_right")]
    return pairs if measured or len(pairs) > 1 else []


def _numbers(one: Table, other: Table) -> list[str]:
    """Columns of numbers that both have, without the stamps."""
    return sorted(
        name
        for name in one.columns.keys() & other.columns.keys()
        if name != "t" and one[name].dtype.kind == other[name].dtype.kind == "f"
    )


def _are_equal(one: Table, other: Table) -> bool:
    if len(one) != len(other) or one.columns.keys() != other.columns.keys():
        return False
    return all(
        np.array_equal(one[name], other[name], equal_nan=one[name].dtype.kind == "f")
        for name in one.columns
        if name != "t"
    )


def _overlap(one: Table, other: Table) -> bool:
    names = _numbers(one, other)
    return bool(names) and bool(
        np.isin(_sequences(one.stack(*names)), _sequences(other.stack(*names))).any()
    )


def _sequences(values: FloatArray) -> NDArray[np.uint64]:
    """One number for every `ROWS` rows of (N, C) one after the other in which enough changes."""
    bits = np.ascontiguousarray(values + 0.0).view(np.uint64)
    rows = np.asarray((bits * FACTORS[: bits.shape[1]]).sum(axis=1, dtype=np.uint64))
    if len(rows) < ROWS:
        return rows[:0]
    changed = np.concatenate([[0], np.cumsum(rows[1:] != rows[:-1])])
    enough = changed[ROWS - 1 :] - changed[: len(rows) - ROWS + 1] >= CHANGES
    windows = np.lib.stride_tricks.sliding_window_view(rows, ROWS)
    sums = np.zeros(len(windows), dtype=np.uint64)
    for row in range(ROWS):
        sums += windows[:, row] * FACTORS[-1 - row]
    return np.asarray(sums[enough])
