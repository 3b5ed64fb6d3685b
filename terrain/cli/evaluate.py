"""`terrain-odometry evaluate`: errors of finished runs, side by side."""

import json
import sys
from pathlib import Path
from typing import Any

import click

from terrain.cli.results import HEADER, error_cells, print_table


@click.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option("--json", "as_json", is_flag=True, help="Print the numbers as JSON.")
def evaluate(folders: tuple[Path, ...], as_json: bool) -> None:
    """Show the errors of finished runs side by side.

    DIR is a folder that `run` wrote. One that cannot be read becomes a row that says why, and
    the exit code is then 1.

    \b
    Example:
      terrain-odometry evaluate with_vision without_vision
    """
    results = {str(folder): _read(folder) for folder in folders}
    if as_json:
        click.echo(json.dumps(results, indent=2))
    else:
        rows = [row for name, result in results.items() for row in _rows(name, result)]
        print_table([("folder", "trajectory", "against", *HEADER[1:]), *rows])
        click.echo("Per metre of wheel travel, over the horizon that each result.json names.")
    if any("error" in result for result in results.values()):
        sys.exit(1)


def _read(folder: Path) -> dict[str, Any]:
    """Errors of one folder; what went wrong where they cannot be read."""
    from odometry.errors import OdometryError
    from terrain.results import read_errors

    try:
        return read_errors(folder)
    except OdometryError as error:
        return {"error": str(error)}


def _rows(name: str, result: dict[str, Any]) -> list[tuple[str, ...]]:
    empty = [""] * len(HEADER)
    if "error" in result:
        return [(name, f"failed: {result['error']}", *empty)]
    if not result["errors"]:
        return [(name, "nothing to compare with", *empty)]
    against = str(result.get("reference") or "-")
    return [
        (name, trajectory, errors.get("against", against), *error_cells(errors))
        for trajectory, errors in result["errors"].items()
    ]
