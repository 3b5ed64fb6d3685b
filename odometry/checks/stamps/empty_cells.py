"""Rows whose values were not measured, in columns that others have."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.tables.table import Table
from odometry.windows.recorded.spans import runs_of

# Of the rows that have a value, at least: a file that holds two sensors has empty cells by rights.
MOSTLY = 0.7
GYROSCOPE = ("gyro_z",)
IMU = ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")


def empty_cells(evidence: Evidence) -> Iterator[Finding]:
    """How many rows of each file have no value, and where: they are left out in silence."""
    run = evidence.run
    for file, table, names in (
        ("odometry.csv", run.odometry, GYROSCOPE),
        ("imu.csv", run.imu, IMU),
        ("pose.csv", run.pose, ("x", "y")),
    ):
        if table is not None:
            yield from _of_table(evidence, file, table, names)


def _of_table(
    evidence: Evidence, file: str, table: Table, names: tuple[str, ...]
) -> Iterator[Finding]:
    empty = {name: np.isnan(table[name]) for name in names if name in table}
    some = {name: cells for name, cells in empty.items() if 0 < cells.mean() < 1 - MOSTLY}
    if not some:
        return
    rows = np.any(list(some.values()), axis=0)
    places, t = runs_of(rows), table.stamps_s
    ends = np.minimum(places[:, 1], len(t) - 1)
    spans = tuple(
        (evidence.run_time_s(t[first]), evidence.run_time_s(t[end]))
        for first, end in zip(places[:, 0], ends, strict=True)
    )
    first_s, end_s = max(spans, key=lambda span: span[1] - span[0])
    yield Finding(
        "empty_cells",
        Level.NOTE,
        f"{file} has no {', '.join(some)} in {rows.sum()} of {len(t)} rows "
        f"({100 * rows.mean():.2g} %), in {counted(len(spans), 'place')}, the longest from "
        f"{first_s:.1f} to {end_s:.1f} s of run time",
        "Cells are empty or nan: a sensor or its driver was silent",
        "Nothing to do where that is known: these rows are left out",
        spans,
    )
