"""Odometry of other programs beside a finished run: its evaluation and its source."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.config import block_from_table
from odometry.errors import OdometryError
from odometry.evaluation.other_odometry import LONGEST_GAP_S, SPARSE, Judge, OtherScore, score_other
from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import Score
from odometry.io.csv_table import read_csv_table
from odometry.io.structured import read_json
from odometry.io.trajectory_files import OPTICAL, format_of, read_trajectory
from odometry.io.trajectory_poses import doubt_of_axes, travel_axis
from odometry.trajectory import Trajectory
from terrain.errors import ResultError
from terrain.other_odometry.other_headings import PoseFault, other_readings, pose_fault
from terrain.other_odometry.other_stamps import late_by_s, late_note

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
        Errors as of result.json, with `share` of the reference's stamps, `own_stamps`, `scale`,
        `turned_deg`, `notes`, and `odometer`: the errors of ours at the same stamps. No numbers
        where its poses have a fault that the notes name, `error` alone where something cannot be
        evaluated.
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
            read = Read(_of_run(file)) if is_table else _read(file, axes, times)
            found[PREFIX + name] = _judged(read, judge)
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


@dataclass(frozen=True)
class Read:
    """A trajectory as its file was read, why its axes are doubted, and what else yaw may be.

    Where `turned` its body moves most along z, as no robot in the plane does.
    """

    trajectory: Trajectory
    doubt: str = ""
    turned: bool = False
    readings: Mapping[str, FloatArray] = field(default_factory=dict)


def _read(file: Path, axes: str, times: Path | None) -> Read:
    spatial = read_trajectory(file, times=times, axes=axes)
    readings = other_readings(spatial, format_of(file)) if axes != OPTICAL else {}
    return Read(spatial.plane, doubt_of_axes(spatial), travel_axis(spatial) == 2, readings)


def _judged(read: Read, judge: Judge) -> dict[str, Any]:
    """Errors of a trajectory with notes; no numbers where its poses are not what they seem."""
    found = score_other(read.trajectory, judge)
    fault = pose_fault(read.trajectory, judge, read.readings)
    if fault is None and read.turned:
        fault = PoseFault(f"{read.doubt}. Its errors are not counted: they would be those of axes")
    if fault is not None and not (fault.counts and fault.fits):
        score = found.score if fault.counts else Score(0)
        return _table(replace(found, score=score, scale=np.nan, turned_rad=np.nan), [fault.note])
    late_s = late_by_s(read.trajectory, judge.odometer)
    doubts = [
        read.doubt,
        "" if late_s is None else late_note(late_s, judge.odometer),
        fault.note if fault else "",
    ]
    return _table(found, doubts)


def _table(found: OtherScore, doubts: Sequence[str]) -> dict[str, Any]:
    notes = [*filter(None, doubts), *_notes(found)]
    return found.score.to_table() | {
        "share": found.share,
        "own_stamps": found.own_stamps,
        "scale": _finite(found.scale),
        "turned_deg": _finite(degrees(found.turned_rad)),
        "notes": notes,
        "odometer": found.ours.to_table(),
    }


def _notes(found: OtherScore) -> list[str]:
    """What the errors hide: stamps that are missing, a scale, axes that point elsewhere."""
    notes = []
    if found.own_stamps:
        notes.append(
            f"evaluated at its own {found.own_stamps} stamps, since the reference is more than "
            f"{SPARSE:g} times as frequent; they span {100 * found.share:.1f} % of that. The "
            "row of our odometer below it is of the same stamps"
        )
    elif found.share < 1:
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
