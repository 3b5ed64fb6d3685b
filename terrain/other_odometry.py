"""Odometry of other programs beside a finished run: its evaluation and its source."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.lag import Signal, lag_between
from odometry.config import block_from_table
from odometry.errors import OdometryError
from odometry.evaluation.other_odometry import LONGEST_GAP_S, Judge, OtherScore, score_other
from odometry.evaluation.relative import EvaluationConfig
from odometry.io.csv_table import read_csv_table
from odometry.io.run_folder import doubt_of_axes
from odometry.io.structured import read_json
from odometry.io.trajectory_files import read_trajectory
from odometry.trajectory import Trajectory
from terrain.errors import ResultError

MOST_SHIFT_S = 3.5
LEAST_SHIFT_S = 0.15
LEAST_WIDTH_S = 0.5  # over which turn rates are taken
CERTAIN, TOGETHER, CORRELATED = 4.0, 0.7, 0.8


def late_by_s(other: Trajectory, odometer: Trajectory) -> float | None:
    """By how much a trajectory's stamps are late; None unless that is plain.

    Pieces of the time that both cover must have the same shift, far from zero by their own
    scatter: a drive that hardly turns determines none.
    """
    begin_s = max(each.stamps_s[0] for each in (other, odometer))
    end_s = min(each.stamps_s[-1] for each in (other, odometer))
    period_s = max(float(np.median(np.diff(each.stamps_s))) for each in (other, odometer))
    width_s = max(LEAST_WIDTH_S, 2 * period_s)
    span_s = (begin_s + MOST_SHIFT_S, end_s - MOST_SHIFT_S)
    if span_s[1] - span_s[0] < 3 * width_s:
        return None
    lag = lag_between(_heading(other), _heading(odometer), span_s, width_s, MOST_SHIFT_S)
    if lag is None or lag.correlation < CORRELATED or lag.together < TOGETHER:
        return None
    least_s = max(LEAST_SHIFT_S, period_s, CERTAIN * lag.sigma_s)
    return lag.seconds if abs(lag.seconds) > least_s else None


def _heading(trajectory: Trajectory) -> Signal:
    """Heading [rad] at stamps, whole turns counted; NaN outside."""
    yaw = np.unwrap(trajectory.poses[:, 2])

    def at(stamps_s: FloatArray) -> FloatArray:
        return np.interp(stamps_s, trajectory.stamps_s, yaw, left=np.nan, right=np.nan)

    return at


FOLDER = "other_odometry"  # of a run folder: odometry that a bag had, as NAME.csv
PREFIX = "other/"  # of its name among the trajectories of a run
LEAST_SCALE, LEAST_TURN_DEG = 0.05, 10.0  # off the reference by more is reported


def other_errors(
    folder: Path,
    given: Mapping[str, Path],
    *,
    run_path: str | None,
    axes: str = "",
    times: Path | None = None,
) -> dict[str, dict[str, Any]]:
    """Errors of other odometry on the run of a result, by `other/NAME`.

    Parameters
    ----------
    folder : Path
        That `run` wrote.
    given : Mapping of name to Path
        Trajectory files: TUM, or what else `read_trajectory` reads, or a table of
        `other_odometry` (CSV: t, x, y, yaw).
    run_path : str or None
        The run folder, whose `other_odometry` is evaluated as well where it is there.
    axes : str
        Of the files, as of `read_trajectory`.
    times : Path, optional
        Stamps of KITTI files.

    Returns
    -------
    dict
        Errors as of result.json, with `share` of the reference's stamps, `scale`, `turned_deg`,
        `notes`, and `odometer`: the errors of ours at the same stamps. `error` alone where
        something cannot be evaluated.
    """
    kept = sorted((Path(run_path) / FOLDER).glob("*.csv")) if run_path else []
    files = {file.stem: file for file in kept} | dict(given)
    if not files or not (given or (folder / "reference.csv").exists()):
        return {}
    found: dict[str, dict[str, Any]] = {}
    for name, file in files.items():
        try:
            judge = read_judge(folder)
            is_table = name not in given or _is_table(file)
            trajectory, doubt = (_of_run(file), "") if is_table else _read(file, axes, times)
            late_s = late_by_s(trajectory, judge.odometer)
            doubts = [doubt, "" if late_s is None else _late(late_s)]
            found[PREFIX + name] = _table(score_other(trajectory, judge), doubts)
        except OdometryError as error:
            found[PREFIX + name] = {"error": str(error)}
    return found


def read_judge(folder: Path) -> Judge:
    """What the trajectories of a finished run are evaluated with.

    Raises
    ------
    ResultError
        If the folder holds no reference, or was written before there was reference.csv.
    """
    file = folder / "reference.csv"
    content = read_json(folder / "result.json", ResultError)
    if not file.exists():
        why = (
            "version 0.7 or older wrote it; `run` again"
            if content.get("reference")
            else ("the run has no pose.csv and no truth.csv")
        )
        raise ResultError(f"{folder} has no reference.csv: {why}")
    table = read_csv_table(file, ("t", "x", "y", "yaw", "wheel_travel"), ("t", "x", "y"))
    try:
        config = block_from_table(
            EvaluationConfig, content["config"]["evaluation"], f"{folder}/result.json: evaluation"
        )
        place_m = np.array(content["reference_place_m"], dtype=np.float64).reshape(2)
    except (KeyError, TypeError, ValueError) as error:
        raise ResultError(f"{folder}/result.json: it is not a result of `run`") from error
    return Judge(
        Trajectory(table.stamps_s, table.stack("x", "y", "yaw")),
        table["wheel_travel"],
        _trajectory(folder / "estimate.csv"),
        _trajectory(folder / "odometer.csv"),
        place_m,
        config,
    )


def _trajectory(file: Path) -> Trajectory:
    table = read_csv_table(file, ("t", "x", "y", "yaw"), ("t", "x", "y", "yaw"))
    return Trajectory(table.stamps_s, table.stack("x", "y", "yaw"))


def _of_run(file: Path) -> Trajectory:
    """An odometry that the run folder keeps; rows without a pose are gaps."""
    table = read_csv_table(file, ("t", "x", "y", "yaw"), ("t",))
    poses = table.stack("x", "y", "yaw")
    finite = np.isfinite(poses).all(axis=1)
    return Trajectory(table.stamps_s[finite], poses[finite])


def _is_table(file: Path) -> bool:
    """Whether a file is a table of run folders: its first line names the columns."""
    with suppress(OSError), file.open(encoding="utf-8", errors="replace") as stream:
        return {"t", "x", "y", "yaw"} <= {name.strip() for name in stream.readline().split(",")}
    return False


def _read(file: Path, axes: str, times: Path | None) -> tuple[Trajectory, str]:
    spatial = read_trajectory(file, times=times, axes=axes)
    return spatial.plane, doubt_of_axes(spatial)


def _late(late_s: float) -> str:
    way, sign = ("late", "-") if late_s > 0 else ("early", "+")
    return (
        f"its stamps seem {way} by {abs(late_s):.2f} s: shifted by {sign}{abs(late_s):.2f} s its "
        "turns follow the odometer's best, in all parts of the run. Nothing is shifted: the errors "
        "hold the shift as well"
    )


def _table(found: OtherScore, doubts: Sequence[str]) -> dict[str, Any]:
    notes = [*filter(None, doubts), *_notes(found)]
    return found.score.to_table() | {
        "share": found.share,
        "scale": _finite(found.scale),
        "turned_deg": _finite(degrees(found.turned_rad)),
        "notes": notes,
        "odometer": found.ours.to_table(),
    }


def _notes(found: OtherScore) -> list[str]:
    """What the errors hide: stamps that are missing, a scale, axes that point elsewhere."""
    notes = []
    if found.share < 1:
        notes.append(
            f"evaluated at {100 * found.share:.1f} % of the reference's stamps: the others lie "
            f"outside of it or in a gap above {LONGEST_GAP_S:g} s; the row of our odometer below "
            "it is of the same stamps"
        )
    if abs(found.scale - 1) > LEAST_SCALE:
        notes.append(
            f"its path fits the reference best when it grows by the factor {found.scale:.3g} (the "
            "scale of a single camera is not known, and wheels slip). Nothing is scaled: the "
            "errors are of the path as given"
        )
    if abs(degrees(found.turned_rad)) > LEAST_TURN_DEG:
        notes.append(
            f"its path fits best when it turns by {degrees(found.turned_rad):.0f} degrees: drift, "
            "or axes that are not the robot's (x forward); nothing is turned"
        )
    return notes


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
