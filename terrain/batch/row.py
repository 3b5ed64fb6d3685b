"""One run in the table over all runs, and what all runs of a batch learned, by terrain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from odometry.checks.findings.finding import Level
from odometry.io.csv_table import write_csv_table
from odometry.io.structured import read_json
from odometry.parameters import ParameterSet, read_parameters, write_parameters
from odometry.replays.learned_parameters import MergedTerrain, learned_by_runs, merged_terrain
from terrain.batch.job import FAILED, Outcome
from terrain.errors import ResultError
from terrain.result.evaluation_notes import HARMLESS

JUDGED = ("odometer", "estimate", "gyroscope", "differential_drive")
ERRORS = {
    f"{name}_{unit}": (name, quantity)
    for name in JUDGED
    for unit, quantity in (
        ("m_per_m", "translation_m_per_m"),
        ("deg_per_m", "rotation_deg_per_m"),
    )
}
COUNTS = ("switches", "missed_changes")


@dataclass(frozen=True)
class Row:
    """What the table says of one run.

    Attributes
    ----------
    name : str
        Of the result's folder.
    folder : str
        The run, as given.
    error : str
        Why there is no result; empty where there is one.
    reference : str
        The reference: `truth`, `pose`, or empty. With `pose` the estimate has held-out poses.
    numbers : Mapping
        `duration_s`, `wheel_travel_m`, mean errors by `ERRORS`; None without a reference.
    counts : Mapping
        `switches` of the terrain in force, `missed_changes`.
    robot : tuple of (str, float)
        Name and track width [m].
    flags : tuple of str
        Names of what misleads: warnings of the check, events of the filter.
    notes : tuple of str
        The same in sentences, notes of the run, and remarks on the errors.
    sha256 : str
        Of the run; copies have the same.
    """

    name: str
    folder: str
    error: str = ""
    reference: str = ""
    numbers: Mapping[str, float | None] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)
    robot: tuple[str, float] = ("", 0.0)
    flags: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    sha256: str = ""


def row_of(outcome: Outcome) -> Row:
    """Read what a job left in its folder.

    Raises
    ------
    ResultError
        If that is no result of `run`.
    """
    job = outcome.job
    folder = str(dict(job.asked.inputs)["RUN"])
    if outcome.state == FAILED:
        return Row(job.name, folder, outcome.said)
    file = job.out / "result.json"
    try:
        row = _row(job.name, folder, read_json(file, ResultError))
    except (KeyError, TypeError) as error:
        raise ResultError(f"{file}: it is not a result of `run`") from error
    sums = {role: sha256 for role, _, sha256 in outcome.sums}
    return replace(row, sha256=sums.get("RUN", ""))


def _row(name: str, folder: str, result: Mapping[str, Any]) -> Row:
    means = {
        column: result["errors"].get(trajectory, {}).get(quantity, {}).get("mean")
        for column, (trajectory, quantity) in ERRORS.items()
    }
    findings = [
        finding
        for check in result["check"]
        for finding in check["findings"]
        if finding["level"] != Level.NOTE
    ]
    events = [event for event in result["filter"]["events"] if event["kind"] not in HARMLESS]
    flags = [one["name"] for one in findings] + [event["kind"] for event in events]
    notes = [one["seen"] for one in findings] + [event["text"] for event in events]
    return Row(
        name,
        folder,
        reference=result["reference"] or "",
        numbers={key: result[key] for key in ("duration_s", "wheel_travel_m")} | means,
        counts={key: len(result[key]) for key in COUNTS},
        robot=(result["robot"]["name"], result["robot"]["track_width"]),
        flags=tuple(dict.fromkeys(flags)),
        notes=(*notes, *(f"{note}." for note in result["notes"]), *result["remarks"]),
    )


def write_rows(rows: Sequence[Row], file: Path) -> None:
    """Write the table, a row for each run in the order in which they were given."""
    columns: dict[str, list[Any]] = {
        "run": [row.name for row in rows],
        "folder": [row.folder for row in rows],
        "error": [row.error for row in rows],
        "reference": [row.reference for row in rows],
    }
    for name in ("duration_s", "wheel_travel_m", *ERRORS):
        values = [row.numbers.get(name) for row in rows]
        columns[name] = [np.nan if value is None else float(value) for value in values]
    for name in COUNTS:
        columns[name] = [str(row.counts.get(name, "")) for row in rows]
    columns["flags"] = [" ".join(row.flags) for row in rows]
    columns["notes"] = [" ".join(" ".join(row.notes).split()) for row in rows]
    write_csv_table(file, {name: np.array(column) for name, column in columns.items()})


LEARNED = "learned.toml"


@dataclass(frozen=True)
class Learned:
    """The merged parameter set.

    Attributes
    ----------
    before : ParameterSet
        With which every run began.
    terrains : Mapping of terrain to MergedTerrain
    left_out : tuple of str
        Sentences on what was not merged, and why.
    """

    before: ParameterSet
    terrains: Mapping[str, MergedTerrain]
    left_out: tuple[str, ...]

    @property
    def parameters(self) -> ParameterSet:
        """For a next run: terrains that no run learned stay as they were."""
        merged = {name: of.parameters for name, of in self.terrains.items()}
        return replace(self.before, terrains={**self.before.terrains, **merged})

    @property
    def sentences(self) -> list[str]:
        """What was merged, the spread between runs, and which runs disagree."""
        said = [sentence for name, of in self.terrains.items() for sentence in _said(name, of)]
        return [*said, *self.left_out]


def merge(out: Path, rows: Sequence[Row], before: ParameterSet) -> Learned:
    """Merge what the runs left in their folders; those that something misled are left out.

    Raises
    ------
    ParameterError
        If a file of a run is not as the format says.
    """
    done = [row for row in rows if not row.error]
    robots = dict.fromkeys(row.robot for row in done)
    if len(robots) > 1:
        named = ", ".join(f"{name or 'a robot'} {width:g} m wide" for name, width in robots)
        said = f"Nothing is merged, the runs are of several robots: {named}"
        return Learned(before, {}, (said, _absent("none was merged")))
    copies = _copies(done)
    after = {
        row.name: read_parameters(out / row.name / LEARNED)
        for row in done
        if not row.flags and row.name not in copies and (out / row.name / LEARNED).is_file()
    }
    terrains = {
        name: merged_terrain(tables, began_alike=name in before.terrains)
        for name, tables in sorted(learned_by_runs(before, after).items())
    }
    misled = [f"{row.name} ({' '.join(row.flags)})" for row in done if row.flags]
    said = f"Not merged, because something misled the filter: {', '.join(misled)}"
    left_out = [said] if misled else []
    if copies:
        same = ", ".join(f"{name} (of {first})" for name, first in copies.items())
        left_out.append(f"Not merged, because it is a copy of another run: {same}")
    if not terrains:
        others = "of the others changed" if misled and len(misled) < len(done) else "changed"
        why = f"no run {others} the parameters of a terrain" if done else "no run was finished"
        left_out.append(_absent("none was merged" if len(misled) == len(done) > 0 else why))
    return Learned(before, terrains, tuple(left_out))


def _copies(rows: Sequence[Row]) -> dict[str, str]:
    """Names of runs that are copies of an earlier one, byte by byte, and the names of those."""
    first: dict[str, str] = {}
    for row in rows:
        if row.sha256:
            first.setdefault(row.sha256, row.name)
    return {
        row.name: first[row.sha256] for row in rows if row.sha256 and first[row.sha256] != row.name
    }


def _absent(why: str) -> str:
    return f"No learned.toml is written: {why}"


def write_learned(learned: Learned, file: Path, comment: str) -> bool:
    """Write the merged set, or remove an earlier one where no run learned; whether it is there."""
    if not learned.terrains:
        file.unlink(missing_ok=True)
        return False
    said = "".join(f"# {sentence}\n" for sentence in learned.sentences)
    write_parameters(file, learned.parameters, comment + said)
    return True


def _said(name: str, of: MergedTerrain) -> list[str]:
    if not of.spread:
        runs = "1 run" if len(of.runs) == 1 else f"{len(of.runs)} runs"
        first = f"{name}: {runs}: no spread between runs: 3 or more runs are needed"
    else:
        sigmas = ", ".join(f"{key} {sigma:.3f}" for key, sigma in of.spread.items())
        first = f"{name}: {len(of.runs)} runs; standard deviation between runs: {sigmas}"
    return [first, *(f"{name}: {sentence}" for sentence in of.disagree)]
