"""How the commands print results."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.run_odometry import RunResult

HEADER = ("", "m per m", "deg per m", "mean position m", "final position m")


def print_errors(results: Mapping[str, "RunResult"]) -> None:
    """Print the errors of each result's trajectories, one row each."""
    rows = []
    for name, result in results.items():
        for trajectory, score in result.scores.items():
            rows.append((f"{name}: {trajectory}", *error_cells(score.to_table())))
    if not rows:
        click.echo("There is no pose.csv or truth.csv to judge the odometer against.")
        return
    first = next(iter(results.values()))
    click.echo(
        f"Mean errors against {first.reference_name}.csv, "
        f"per metre over {first.config.evaluation.horizon_m:g} m of wheel travel:"
    )
    print_table([HEADER, *rows])


def print_sightings(counts: Mapping[str, int]) -> None:
    """Say how many images got each label, and how many none and why."""
    if counts:
        click.echo("Images: " + ", ".join(f"{count} {word}" for word, count in counts.items()))


def error_cells(errors: Mapping[str, Any]) -> tuple[str, str, str, str]:
    """Numbers of one trajectory of result.json as cells of the table."""
    values = (
        errors["translation_m_per_m"]["mean"],
        errors["rotation_deg_per_m"]["mean"],
        errors["position_m"]["mean"],
        errors["position_m"]["final"],
    )
    cells = tuple("-" if value is None else f"{value:.4f}" for value in values)
    return cells[0], cells[1], cells[2], cells[3]


def print_table(rows: Sequence[Sequence[str]]) -> None:
    """Print rows in columns, the first to the left, numbers to the right."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        click.echo("  " + "  ".join(cells))


def print_written(written: Sequence[Path], out: Path) -> None:
    """Say which files were written."""
    names = sorted(file.relative_to(out).as_posix() for file in written)
    click.echo(f"Wrote to {out}: {', '.join(names)}")
