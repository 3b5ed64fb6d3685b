"""`terrain-odometry evaluate`: errors of finished runs, side by side."""

import json
import sys
from collections.abc import Mapping
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
        runs = _run_names(results)
        rows = [row for name, of in results.items() for row in _rows(name, runs[name], of)]
        print_table([("folder", "run", "trajectory", "against", *HEADER[1:]), *rows])
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


def _run_names(results: Mapping[str, dict[str, Any]]) -> dict[str, str]:
    """Name of each result's run; its path where runs of other places have the same name."""
    names = {folder: result.get("run") or "-" for folder, result in results.items()}
    places: dict[str, set[str | None]] = {}
    for folder, result in results.items():
        places.setdefault(names[folder], set()).add(result.get("run_path"))
    return {
        folder: results[folder].get("run_path") or name if len(places[name]) > 1 else name
        for folder, name in names.items()
    }


def _rows(name: str, run: str, result: dict[str, Any]) -> list[tuple[str, ...]]:
    empty = [""] * len(HEADER)
    if "error" in result:
        return [(name, run, f"failed: {result['error']}", *empty)]
    if not result["errors"]:
        return [(name, run, "nothing to compare with", *empty)]
    against = str(result.get("reference") or "-")
    return [
        (name, run, trajectory, errors.get("against", against), *error_cells(errors))
        for trajectory, errors in result["errors"].items()
    ]
