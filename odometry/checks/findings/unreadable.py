"""Why a run folder cannot be read: the likeliest cause of each kind of error."""

import re
from itertools import islice
from pathlib import Path

from odometry.checks.findings.finding import Finding, Level
from odometry.errors import RunFolderError
from odometry.io.run_folder import import_command, is_named_bag

# The first pattern that fits the message: (pattern, cause, remedy).
CAUSES = (
    (
        r"stamps may not go back",
        "Rows are not in the order of time: a file was written twice or joined of two, rows were "
        "sorted by another column, or the clock was set back while recording",
        "Sort the rows by t, or cut the file where the clock jumps",
    ),
    (
        r"column 't': '[^']*\d[-:/T ][^']*' is not a number",
        "Stamps are dates or times of day (text), not seconds",
        "Convert the column t to seconds",
    ),
    (
        r"'[^']*;[^']*'|'[^']*\\t[^']*'|the header has 1 columns|header has [^,]*[;\t]",
        "Cells are separated by semicolons or tabs, not commas",
        "Write the file with commas, and a point in numbers",
    ),
    (
        r"the header has $",
        "The file is empty: not even a header was written",
        "Remove the file where it is optional, or record again",
    ),
    (
        r"the header has #",
        "The first line is a comment, where the names of the columns are expected",
        "Remove the lines above the header",
    ),
    (
        r"the column '-?[\d.]+' is there twice|the header has -?\d+\.\d+|header has -?[\d.]+,",
        "The header line is missing: the first line holds numbers, not names of columns",
        "Write the names of the columns in the first line",
    ),
    (
        r"pose\.csv: the column '\w+' is missing; the header has .*(?i:\blat(itude)?\b)",
        "Positions are latitude and longitude, not metres",
        "Move the file out of the run folder, and: terrain-odometry import RUN --pose FILE",
    ),
    (
        r"pose\.csv: the column 'yaw' is missing",
        "The heading was not measured, or has another name",
        "Write an empty column yaw where it was not measured: positions alone are used then",
    ),
    (
        r"the column '.*' is missing",
        "The columns have other names than the format gives them, or the header is missing",
        "Rename the columns: t, v_left, v_right in odometry.csv; t, x, y, yaw in pose.csv",
    ),
    (
        r"'-?inf(inity)?', expected a finite number|e\+?\d{3}', expected a finite",
        "A value is infinite: a division by zero or an overflow in what wrote the file",
        "Remove the row, or find what wrote it",
    ),
    (
        r"'(nan)?', expected a finite number",
        "Cells are empty (not measured, or lost) where every row needs a number",
        "Remove these rows: a tread speed holds until the next row",
    ),
    (
        r"\\x00|NUL|\x00|row \d+: 1 cells, but the header has",
        "The file ends in zeros or was cut: the recorder was switched off or the disk was full",
        "Remove the last rows",
    ),
    (
        r"row 2: \d+ cells, but the header has",
        "The first row does not fit the header: numbers with decimal commas (1,5 for 1.5), a comma "
        "after the last cell of each row, or a column without a name",
        "Write numbers with a point, and one name in the header for each cell of a row",
    ),
    (
        r"row \d+: \d+ cells, but the header has",
        "The last row was cut while it was written (the recording was stopped), or a row has a "
        "cell too many",
        "Remove the row",
    ),
    (
        r"there are no rows below the header",
        "The file is empty: nothing was recorded",
        "Remove the file where it is optional, or record again",
    ),
    (
        r"\[robot\] \w+ = ([^-\d]|[\d.]+e?[\d+-]*[^\d.e,])",
        "The value is no number: text, a list, or true or false",
        "Write a number in metres or kilograms, without quotation marks",
    ),
    (
        r"\[robot\] track_width = -|\[robot\] track_width = 0|expected a positive number",
        "track_width or another size of the robot is negative or zero: a sign, or a placeholder "
        "never filled in",
        "Measure it, in metres",
    ),
    (
        r"\[sensors\] \w+ = (?!\[[-+\d.e]+, [-+\d.e]+, [-+\d.e]+\])",
        "The value is no list of three numbers",
        "Write three numbers in brackets, without quotation marks",
    ),
    (
        r"\[sensors\] pose",
        "The place of the sensor is in mm or cm, not metres",
        "Write [sensors] pose in metres, in the robot frame",
    ),
    (
        r"\[sensors\] imu",
        "The attitude of the sensor is in degrees, not radians",
        "Write [sensors] imu as roll, pitch and yaw in radians",
    ),
    (
        r"is not a file in|is absolute|outside",
        "Image files are missing, were moved, or are named by a path of another computer",
        "Name images by paths inside the run folder",
    ),
    (
        r"utf-8|decode",
        "The file is not text, or text of another encoding (UTF-16 of a spreadsheet?)",
        "Save it as UTF-8",
    ),
    (
        r"missing; a run folder needs",
        "A file that every run folder has is missing",
        "Write it, see the format of a run folder",
    ),
    (r"as TOML", "run.toml is not TOML", "Correct run.toml at the place that is named"),
)
MOST_ENTRIES = 1000  # of a folder that are listed
NEEDED = "a run folder holds run.toml and odometry.csv"


def unreadable(error: RunFolderError) -> Finding:
    """The finding for a folder that cannot be read."""
    cause, remedy = likely_cause(error) or (
        "A file of the run folder is not as the format says",
        "Correct the file at the place that is named",
    )
    return Finding("unreadable", Level.REFUSED, str(error), cause, remedy)


def likely_cause(error: RunFolderError) -> tuple[str, str] | None:
    """Why a folder cannot be read, and what to do; None where only the error itself says so."""
    message = str(error)
    causes = (words for pattern, *words in CAUSES if re.search(pattern, message))
    return next(((cause, remedy) for cause, remedy in causes), None)


def no_run_folder(folder: Path) -> Finding | None:
    """What a path is instead of a run folder; None where it may be one."""
    if not folder.exists():
        return _finding(f"{folder}: there is no such folder", "The path is misspelt or was moved")
    if not folder.is_dir():
        nothing = _finding(
            f"{folder}: this is a file; expected a run folder", f"This is no run folder: {NEEDED}"
        )
        return _bag(folder) if is_named_bag(folder) else nothing
    if (folder / "run.toml").exists() or (folder / "odometry.csv").exists():
        return None  # what is missing is said by the error of reading
    return _without_run(folder, sorted(islice(folder.iterdir(), MOST_ENTRIES)))


def _without_run(folder: Path, entries: list[Path]) -> Finding:
    if any(map(is_named_bag, entries)):
        return _bag(folder)
    runs = [entry.name for entry in entries if (entry / "run.toml").is_file()]
    if runs:
        shown = ", ".join(runs[:3]) + (" ..." if len(runs) > 3 else "")
        return _finding(
            f"{folder}: this folder has no run.toml, and {len(runs)} in it have one ({shown})",
            "It holds run folders, and is none",
            f"Name these: {folder}/*/",
        )
    return _finding(f"{folder}: no run.toml, no odometry.csv", f"This is no run folder: {NEEDED}")


def _bag(path: Path) -> Finding:
    return _finding(
        f"{path}: this is a bag (a log of ROS)",
        f"A bag is no run folder: {NEEDED}",
        f"Import it: {import_command(path)}",
    )


def _finding(seen: str, cause: str, remedy: str = "Name a run folder") -> Finding:
    return Finding("no_run_folder", Level.REFUSED, seen, cause, remedy)
