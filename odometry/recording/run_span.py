"""A part of a run by time."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from odometry.errors import RunFolderError
from odometry.io.run_folder import FILES
from odometry.recording.run import Run
from odometry.tables.table import Table


@dataclass(frozen=True)
class Span:
    """From when to when, in seconds since the first stamp of the odometry.

    Raises
    ------
    RunFolderError
        If the numbers are not finite (the end may be infinite), or the end is not after the start.

    Examples
    --------
    >>> import odometry
    >>> odometry.Span(from_s=10.0).is_whole
    False
    """

    from_s: float = 0.0
    to_s: float = math.inf

    def __post_init__(self) -> None:
        if not (0 <= self.from_s < self.to_s and math.isfinite(self.from_s)):
            raise RunFolderError(
                f"from {self.from_s:g} s to {self.to_s:g} s: expected a start of 0 or more, and "
                "an end after it"
            )

    @property
    def is_whole(self) -> bool:
        """Whether nothing is cut off."""
        return self.from_s == 0 and self.to_s == math.inf


def cut_run(run: Run, span: Span) -> Run:
    """The part of a run that lies in a span of time; its stamps stay as they are.

    Treads that are held at a cut keep their value. A table without a row in the span is left out.

    Raises
    ------
    RunFolderError
        If the span holds less than two rows of odometry.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> part = odometry.cut_run(run, odometry.Span(10.0, 20.0))
    >>> part.odometry.stamps_s[[0, -1]].tolist()
    [10.0, 20.0]
    """
    if span.is_whole:
        return run
    first_s, last_s = run.odometry.stamps_s[[0, -1]].tolist()
    ends_s = first_s + span.from_s, first_s + span.to_s
    odometry = _cut_held(run.odometry, *ends_s)
    if len(odometry) < 2:
        end = f" to {span.to_s:g} s" if math.isfinite(span.to_s) else " on"
        raise RunFolderError(
            f"{run.folder}: nothing lies from {span.from_s:g} s{end} in run time: the run lasts "
            f"{last_s - first_s:.3f} s"
        )
    others = {name: getattr(run, name) for name in FILES if name != "odometry"}
    parts: dict[str, Any] = {name: table and _cut(table, *ends_s) for name, table in others.items()}
    cut_s = float(odometry.stamps_s[0]) - run.began_s
    return replace(run, odometry=odometry, cut_s=cut_s, **parts)


def _cut_held(table: Table, from_s: float, to_s: float) -> Table:
    """Rows between two stamps; a row holds until the next, so the cuts get rows of their own.

    Not the last of a stamp that rows share: another one of them may be in force.

    Parameters
    ----------
    table : Table
    from_s, to_s : float
        Stamps, as they stand in the table; an end beyond the last row adds none.
    """
    stamps_s = table.stamps_s
    rows = np.flatnonzero((stamps_s >= from_s) & (stamps_s <= to_s))
    first, last = np.searchsorted(stamps_s, [from_s, to_s], side="right") - 1
    before = [first] if first >= 0 and stamps_s[first] < from_s else []
    held_on = last >= 0 and stamps_s[last] < to_s < stamps_s[-1] and not _is_shared(table, last)
    after = [last] if held_on else []
    held = table.rows(np.array([*before, *rows, *after], dtype=np.int64))
    held_s = np.clip(held.stamps_s, from_s, to_s)
    if after:
        held_s[-1] = to_s
    return replace(
        held,
        columns={**held.columns, "t": held_s},
        repeated=table.rows(rows).repeated,
    )


def _is_shared(table: Table, row: int) -> bool:
    repeated = table.repeated
    return repeated is not None and bool(np.isin(table.stamps_s[row], repeated.stamps_s))


def _cut(table: Table, from_s: float, to_s: float) -> Table | None:
    """Rows between two stamps, both included; None where there is none."""
    first, end = np.searchsorted(table.stamps_s, [from_s, np.nextafter(to_s, math.inf)])
    return table.rows(slice(int(first), int(end))) if first < end else None
