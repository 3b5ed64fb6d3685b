"""What the program says of a recording: its trajectories and result.json, read from its files."""

import json
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path as Folder

import numpy as np

from odometry.tables.table import Table
from terrain.main_job import run_odometry
from terrain.results import write_results
from tests.studies.main_job.estimation_reckoning import Path


@dataclass(frozen=True)
class Outputs:
    """Trajectories by name (`odometer`, `estimate`), their tables, and result.json."""

    paths: dict
    tables: dict
    result: dict

    @property
    def events(self):
        """What the filter flagged: rows with kind, begin_s, end_s, text."""
        return self.result["filter"].get("events", [])

    @property
    def kinds(self):
        return sorted({event["kind"] for event in self.events})


def outputs_of(run, **options):
    """Run the program without vision, write its files, and read them again."""
    with tempfile.TemporaryDirectory() as folder:
        write_results(run_odometry(run, vision=False, **options), folder)
        tables = {name: _columns(Folder(folder) / f"{name}.csv") for name in NAMES}
        result = json.loads((Folder(folder) / "result.json").read_text("utf-8"))
    paths = {
        name: Path(table["t"], np.stack([table[c] for c in ("x", "y", "yaw")], axis=-1))
        for name, table in tables.items()
    }
    return Outputs(paths, tables, result)


NAMES = ("odometer", "estimate")


def _columns(file):
    lines = file.read_text("utf-8").splitlines()
    values = [[float(cell) if cell else np.nan for cell in line.split(",")] for line in lines[1:]]
    return dict(zip(lines[0].split(","), np.array(values).T, strict=True))


def with_columns(table, **columns):
    """The table with columns replaced or added."""
    return replace(table, columns={**table.columns, **columns})


def with_rows(table, chosen):
    """The rows that a mask chooses."""
    columns = {name: column[chosen] for name, column in table.columns.items()}
    return Table(table.file, columns, table.lines[chosen])


def without_gyroscope(run):
    """The run with the column gyro_z taken away."""
    columns = {name: c for name, c in run.odometry.columns.items() if name != "gyro_z"}
    return replace(run, odometry=replace(run.odometry, columns=columns), imu=None)


def with_poses_withheld(run):
    """Every second second of pose.csv taken away: the run without, and the mask of what is gone."""
    odd = np.floor(run.pose.stamps_s - run.pose.stamps_s[0]).astype(int) % 2 == 1
    return replace(run, pose=with_rows(run.pose, ~odd)), odd
