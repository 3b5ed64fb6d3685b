"""Rows of a steady sensor that came late by chance, or all at once after a stall."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.stamps.bursts import TWO_OF_EACH
from odometry.checks.stamps.timing import LEAST_LAG_S, lags_of
from odometry.recording.run import Run, with_table
from odometry.tables.late_rows import NEARLY_ALL, LateRows, late_rows
from odometry.windows.recorded.spans import runs_of

WARNED_S = 0.03  # standard deviation: that of rows in bursts 0.1 s apart, from which is warned
WARNED_STEP_S = 0.05  # of coarse stamps: what all rows are off by is no more
BOTH = 2  # rows of a stamp, that may be those of the two treads
HELD_UP = 0.5  # of the period, by which a row is late
FEW = 0.2  # share of the rows: where fewer are late, they were held up now and then
LAGS = frozenset(
    {"pose_late", "yaw_late", "positions_late", "gyroscope_late", "treads_late", "clocks_apart"}
)
ARRIVAL = "stamps are those of arrival, not of the measurement: "
HANDED_ON = "a serial line, USB, a network or a busy computer hands some rows on later than others"
STALLED = (
    "the logger, or what sends to it, stalled now and then, and the rows of that time came at once"
)
REMEDY = (
    "Use the stamps of the sensor (header time); verbs that fit or follow a run take even ones "
    "(`causal` and live ones cannot)"
)


def spread_late(run: Run, *, shared: bool) -> tuple[list[Finding], Run, Mapping[str, float]]:
    """A finding for each file with late rows, and the run with even stamps in place of theirs.

    `shared` looks at files whose rows share stamps, else at the others. Also how late nearly all
    rows of these files are at most: all of them may be.
    """
    found, most_s, began_s = [], {}, float(run.odometry.stamps_s[0])
    for name in ("odometry", "imu"):
        table = getattr(run, name)
        if table is None or shared == (table.repeated is None):
            continue
        late = late_rows(table)
        if late is not None:
            finding = _coarse if late.are_coarse else _finding
            found.append(finding(f"{name}.csv", late, began_s))
            most_s[f"{name}.csv"] = float(np.quantile(late.late_s, NEARLY_ALL))
            run = with_table(run, name, late.at(late.even_s))
    return found, run, most_s


def without_explained_lags(
    found: Sequence[Finding], evidence: Evidence, most_s: Mapping[str, float]
) -> list[Finding]:
    """The findings but lags that rows which are all late explain (`most_s` by file)."""
    treads_s = most_s.get("odometry.csv", 0.0)
    gyroscope_s = most_s.get(evidence.gyroscope_file, 0.0)
    late_s = {"pose": 0.0, "treads": treads_s, "gyroscope": gyroscope_s}
    explained = bool(most_s) and all(
        abs(lag.seconds) < LEAST_LAG_S or -late_s[early] <= lag.seconds <= late_s[late]
        for (late, early), lag in lags_of(evidence).items()
    )
    return [finding for finding in found if not (explained and finding.name in LAGS)]


def _finding(file: str, late: LateRows, began_s: float) -> Finding:
    held_up = late.late_s > HELD_UP * late.period_s
    many = held_up.mean() > FEW
    stretches = runs_of(held_up)
    where = "by chance" if many else f"in {counted(len(stretches), 'place')}"
    even_s = late.even_s - began_s
    return Finding(
        "uneven_stamps",
        Level.WARNING if late.uneven_s > WARNED_S else Level.NOTE,
        f"{file} has as many rows as {1 / late.period_s:.3g} Hz ask for, but {where} they come "
        f"late, {100 * late.close.mean():.2g} % of all together with the row before: by "
        f"{late.late_s.mean():.2g} s in the mean and {late.late_s.max():.2g} s at most beside even "
        "stamps",
        _either(ARRIVAL + (HANDED_ON if many else STALLED), file, late),
        REMEDY,
        () if many else tuple((even_s[a].item(), even_s[b - 1].item()) for a, b in stretches),
    )


def _either(cause: str, file: str, late: LateRows) -> str:
    """The cause, and another one where nearly all stamps have two rows."""
    if file == "odometry.csv" and np.mean(late.at_once == BOTH) > NEARLY_ALL:
        return f"Either {cause}{TWO_OF_EACH}"
    return cause[:1].upper() + cause[1:]


def _coarse(file: str, late: LateRows, _: float) -> Finding:
    return Finding(
        "coarse_stamps",
        Level.WARNING if late.step_s > WARNED_STEP_S else Level.NOTE,
        f"stamps of {file} are multiples of {late.step_s:g} s, and up to {late.at_once.max()} rows "
        f"share one; the rows are as many as {1 / late.period_s:.3g} Hz ask for",
        _either("the logger writes time in too few digits", file, late),
        "Write stamps with milliseconds; verbs that fit or follow a run take even stamps (`causal` "
        f"and live ones cannot). All of them may be early or late by up to {late.step_s:g} s",
    )
