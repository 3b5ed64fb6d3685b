"""Units of stamps, files of different times, clocks that were set, and lost digits."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.recording.run import Run
from odometry.tables.row_values import are_copies
from odometry.tables.table import Table

LONGEST_PERIOD_S = 20.0  # poses or images are hardly slower, where odometry.csv is of another time
LONGEST_ODOMETRY_PERIOD_S = 2.5  # nor are treads that are logged evenly
EVEN = 3.0  # ratio of a long to a short step below which a log is even: no log of changes
LONGEST_HOLD_S = 1000.0  # commands are usually not held for longer
LONGEST_GAP_S = 4 * 3600.0  # no recording goes on after a longer one
SHORTEST_PERIOD_S = 2e-5  # nor is any log faster
EPOCH_S = 1e8  # stamps above count from 1970 (1e8 s is in 1973)
USUAL_PERIODS_S = (0.002, 2.0)
LEAST_STEP_S, STEP_PERIODS = 5.0, 20.0  # of a clock that was set, amid rows and to both sides
MOSTLY_REPEATED = 0.8  # of the rows: no logger writes a stamp five times
LATER = 0.05  # share of the rows after such a step
STAMP_UNITS = (("nanoseconds", 1e9), ("microseconds", 1e6), ("milliseconds", 1e3))


def tables_of(run: Run) -> dict[str, Table]:
    """The tables of a run by the names of their files."""
    tables = {
        "odometry.csv": run.odometry,
        "imu.csv": run.imu,
        "pose.csv": run.pose,
        "velocity.csv": run.velocity,
        "images.csv": run.images,
        "truth.csv": run.truth,
    }
    return {name: table for name, table in tables.items() if table is not None}


def unreadable_stamps(run: Run) -> Iterator[Finding]:
    """Stamps that are no seconds, and files that share no time with odometry.csv."""
    tables = tables_of(run)
    odometry_s = run.odometry.stamps_s
    repeated, rows = len(run.odometry.repeated_lines), len(run.odometry)
    if repeated > MOSTLY_REPEATED * (repeated + rows) and not are_copies(run.odometry):
        yield _refused(
            "stamps_lost_digits",
            f"odometry.csv repeats the stamp of the row before in {repeated} of {repeated + rows} "
            f"rows, so that {counted(rows, 'row')} would be left",
            "Stamps have lost their last digits (a number of 32 bits, or whole seconds)",
            "Write the column t with microseconds, or number the rows by their period",
        )
        return
    if len(odometry_s) < 2:
        yield _refused(
            "one_row", "odometry.csv has one row", "The recording is empty", "Record again"
        )
        return
    for name, table in tables.items():
        unit = _stamp_unit(name, table.stamps_s, odometry_s)
        if unit:
            period = float(np.median(np.diff(table.stamps_s)))
            yield _refused(
                "stamp_unit",
                f"stamps of {name} are {period:.6g} apart in the median, and end "
                f"{table.stamps_s[-1] - table.stamps_s[0]:.6g} after they begin",
                f"Stamps are in {unit}, not seconds",
                "Convert the column t to seconds",
            )
    if any(_stamp_unit(name, table.stamps_s, odometry_s) for name, table in tables.items()):
        return
    yield from _clock_of_robot_was_set(run.odometry)
    for name, table in tables.items():
        if name != "odometry.csv":
            yield from _apart(name, table.stamps_s, odometry_s)


def _clock_of_robot_was_set(odometry: Table) -> Iterator[Finding]:
    """A step of hours amid the rows: a robot starts in 1970 and sets its clock by the network."""
    odometry_s = odometry.stamps_s
    steps_s = np.diff(odometry_s)
    row = int(np.argmax(steps_s))
    if steps_s[row] <= LONGEST_GAP_S:
        return
    before_s, after_s = odometry_s[row : row + 2]
    yield _refused(
        "clock_set",
        f"stamps of odometry.csv go from {before_s:.3f} to {after_s:.3f} s in one step (line "
        f"{odometry.lines[row]} to {odometry.lines[row + 1]})",
        "The robot's clock was set while recording (by the network or by satellites), the "
        "recording was paused, or two recordings were joined",
        f"Use one part: --to {before_s - odometry_s[0]:.3f} for what is before, --from "
        f"{after_s - odometry_s[0]:.3f} for what is after",
    )


def _stamp_unit(name: str, stamps_s: FloatArray, odometry_s: FloatArray) -> str:
    """The unit of stamps that cannot be seconds; "" where they may be.

    Stamps of another file that lie in the time of odometry.csv have its unit, however rare they
    are; and treads that are logged on change may be held for long.
    """
    if name != "odometry.csv" and _share_inside(stamps_s, odometry_s) > 0.5:
        return ""
    if len(stamps_s) < 3:
        epoch = float(np.abs(stamps_s).max())
        return next((name for name, factor in STAMP_UNITS if epoch > 1e10 * factor / 1e3), "")
    period = float(np.median(np.diff(stamps_s)))
    odometry = name in ("odometry.csv", "imu.csv")
    longest_s = LONGEST_ODOMETRY_PERIOD_S if odometry else LONGEST_PERIOD_S
    mean = float(np.mean(np.diff(stamps_s)))  # of rows at once most are microseconds apart
    if SHORTEST_PERIOD_S <= period <= longest_s or period < SHORTEST_PERIOD_S <= mean <= longest_s:
        return ""
    short_s, long_s = np.quantile(np.diff(stamps_s), [0.1, 0.9])
    if name == "odometry.csv" and period < LONGEST_HOLD_S and long_s > EVEN * short_s:
        return ""
    if period < SHORTEST_PERIOD_S:
        return "a unit longer than seconds (hours, days)"
    low, high = USUAL_PERIODS_S
    fitting = [name for name, factor in STAMP_UNITS if low <= period / factor <= high]
    return " or ".join(fitting) or "another unit"


def _share_inside(stamps_s: FloatArray, odometry_s: FloatArray) -> float:
    return float(np.mean((stamps_s >= odometry_s[0]) & (stamps_s <= odometry_s[-1])))


def _step_beyond(stamps_s: FloatArray, odometry_s: FloatArray) -> int | None:
    """The row before a step of the stamps from amid the odometry to after its end; None without."""
    if len(stamps_s) < 3:
        return None
    steps_s = np.diff(stamps_s)
    row = int(np.argmax(steps_s))
    least_s = max(LEAST_STEP_S, STEP_PERIODS * float(np.median(steps_s)))
    before_s, after_s = stamps_s[row : row + 2] - odometry_s[-1]
    amid = odometry_s[0] - odometry_s[-1] <= before_s < -least_s
    return (
        row if amid and after_s > least_s and np.mean(stamps_s > odometry_s[-1]) > LATER else None
    )


def _apart(name: str, stamps_s: FloatArray, odometry_s: FloatArray) -> Iterator[Finding]:
    begin_s, end_s = float(odometry_s[0]), float(odometry_s[-1])
    inside = _share_inside(stamps_s, odometry_s)
    if inside == 0:
        offset_s = float(stamps_s[0] - begin_s)
        hours = offset_s / 3600
        if abs(hours) > 0.2 and abs(hours - round(hours * 4) / 4) < 0.02 and abs(hours) < 15:
            cause = f"A time zone: the clocks differ by {hours:.2f} hours"
        elif (begin_s > EPOCH_S) != (float(stamps_s[0]) > EPOCH_S):
            cause = "One clock counts from 1970 (epoch), the other from the start"
        else:
            cause = f"{name} is of another recording, or its clock was set differently"
        yield _refused(
            "files_apart",
            f"{name} covers {stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s, odometry.csv {begin_s:.3f} "
            f"to {end_s:.3f} s: no row in common time",
            cause,
            f"Shift the stamps of {name} (they start {offset_s:+.3f} s after odometry.csv), or "
            "leave the file out",
        )
    elif (step := _step_beyond(stamps_s, odometry_s)) is not None:
        before_s, after_s = stamps_s[step : step + 2]
        yield Finding(
            "clock_set",
            Level.WARNING,
            f"stamps of {name} go from {before_s:.3f} to {after_s:.3f} s in one step, to after the "
            f"end of odometry.csv, which has rows for {end_s - before_s:.1f} s more",
            f"The clock of {name} was set ahead while recording (a time zone, satellite time), or "
            "odometry.csv was cut",
            f"Subtract the step from the later stamps of {name}, or cut with --to",
        )
    elif inside < 0.5:
        yield Finding(
            "files_apart",
            Level.WARNING,
            f"only {100 * inside:.0f} % of the rows of {name} lie within the time of odometry.csv",
            f"Either odometry.csv was cut; or {name} is of another recording or clock, or its "
            "stamps were made up (rows numbered at another rate than theirs)",
            "Compare the first and the last stamps of the files, and the rate of their rows",
        )


def stamps(evidence: Evidence) -> Iterator[Finding]:
    """A note on epoch stamps."""
    if evidence.stamps_s[0] > EPOCH_S:
        yield Finding(
            "epoch_stamps",
            Level.NOTE,
            f"stamps start at {evidence.stamps_s[0]:.0f} s",
            "Stamps count from 1970 (epoch)",
            "Nothing to do",
        )


def _refused(name: str, seen: str, cause: str, remedy: str) -> Finding:
    return Finding(name, Level.REFUSED, seen, cause, remedy)
