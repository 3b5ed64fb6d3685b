"""One page over all runs of a batch, the worst first."""

import math
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

import numpy as np

from odometry.replays.learned_parameters import UNITS, MergedTerrain
from odometry.report.drawing.html import Grid, Listing, Paragraph, Section, write_page
from terrain.batch.row import Learned, Row
from terrain.report.tables import NOTHING, number

HEADER = (
    *("run", "flags", "odometer [m per m]", "its heading [degrees per m]", "estimate [m per m]"),
    *("gyroscope [m per m]", "against", "driven [m]", "time [s]", "switches"),
)
HOW = (
    "Mean errors per metre of wheel travel, worst odometer first. The estimate is evaluated with "
    "the truth, or by poses that were withheld from it. A run with a flag may mislead, as the "
    "notes say: what it learned is not merged."
)


def write_batch_page(rows: Sequence[Row], learned: Learned, file: Path) -> Path:
    """Write the page; each run that was replayed is a link to its own."""
    done = sorted((row for row in rows if not row.error), key=_badness, reverse=True)
    failed = [row for row in rows if row.error]
    noted = [row for row in done if _of_run(row)]
    merged = [_terrain_grid(name, of) for name, of in learned.terrains.items()]
    sections = [
        Section("Failed", [_failures(failed)] if failed else []),
        Section("Runs", [Paragraph(HOW), _runs(done)] if done else []),
        Section("Learned", [*([Listing(learned.sentences)] if learned.sentences else []), *merged]),
        Section("Notes", [_notes(noted)] if noted else []),
    ]
    return write_page(file, f"{len(rows)} runs: terrain-aware odometry", lead(rows), sections)


def lead(rows: Sequence[Row]) -> str:
    """How many are done, what failed, and how large the errors are."""
    failed = [row.name for row in rows if row.error]
    errors = {r.name: e for r in rows if (e := r.numbers.get("odometer_m_per_m")) is not None}
    said = [f"{len(rows) - len(failed)} of {len(rows)} runs are done."]
    if errors:
        worst = max(errors, key=errors.__getitem__)
        median = float(np.median(list(errors.values())))
        said.append(
            f"The error of the odometer is {median:.4f} m per m in the median run, and "
            f"{errors[worst]:.4f} in the worst, {worst}."
        )
    return " ".join(said)


def _badness(row: Row) -> float:
    error = row.numbers.get("odometer_m_per_m")
    return -math.inf if error is None else error


def _links(rows: Sequence[Row]) -> dict[str, str]:
    return {row.name: f"{quote(row.name)}/report.html" for row in rows}


def _runs(rows: Sequence[Row]) -> Grid:
    cells = [
        (
            row.name,
            str(len(row.flags)) if row.flags else NOTHING,
            number(row.numbers["odometer_m_per_m"], 4),
            number(row.numbers["odometer_deg_per_m"], 4),
            number(row.numbers["estimate_m_per_m"], 4),
            number(row.numbers["gyroscope_m_per_m"], 4),
            row.reference or NOTHING,
            number(row.numbers["wheel_travel_m"], 1),
            number(row.numbers["duration_s"], 1),
            str(row.counts["switches"]),
        )
        for row in rows
    ]
    return Grid(HEADER, cells, links=_links(rows))


def _failures(rows: Sequence[Row]) -> Grid:
    return Grid(("run", "why"), [(row.name, row.error) for row in rows])


def _notes(rows: Sequence[Row]) -> Grid:
    return Grid(("run", "note"), [(row.name, note) for row in rows for note in _of_run(row)])


def _of_run(row: Row) -> list[str]:
    flags = ", ".join(flag.replace("_", " ") for flag in row.flags)
    return [*([f"Flags: {flags}."] if flags else []), *row.notes]


def _terrain_grid(name: str, of: MergedTerrain) -> Grid:
    table = of.parameters
    sigmas = dict(zip(table.covariance_order, np.sqrt(np.diag(table.covariance)), strict=True))
    rows = [
        (
            f"{key} [m]" if key in UNITS else key,
            f"{value:.3f}",
            number(sigmas.get(key), 3),
            number(of.spread.get(key), 3),
        )
        for key, value in table.values.items()
    ]
    header = ("parameter", "mean", "sigma of a next run", "sigma between runs")
    return Grid(header, rows, f"{name}: learned by {', '.join(of.runs)}.")
