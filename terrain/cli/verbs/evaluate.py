"""`terrain-odometry evaluate`: errors of finished runs, side by side."""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from terrain.cli.options import trajectory_options
from terrain.cli.results import HEADER, error_cells, print_table


@click.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option(
    "--with",
    "others",
    multiple=True,
    metavar="NAME=FILE",
    help="Poses of another program on the same run (TUM, KITTI, EuRoC, or a table of "
    "other_odometry), evaluated by the same rules; repeat.",
)
@trajectory_options
@click.option("--json", "as_json", is_flag=True, help="Print the numbers as JSON.")
def evaluate(
    folders: tuple[Path, ...],
    *,
    others: tuple[str, ...],
    as_json: bool,
    times: Path | None,
    axes: str,
) -> None:
    """Show the errors of finished runs side by side.

    DIR is a folder that `run` wrote. One that cannot be read becomes a row that says why, and
    the exit code is then 1. Odometry of other programs is listed beside ours: files of --with, and
    what a run folder keeps in other_odometry. It starts where ours does; nothing else is fitted.

    \b
    Example:
      terrain-odometry evaluate with_vision without_vision
      terrain-odometry evaluate results --with slam=slam.tum
    """
    given = _named_files(others)
    results = {str(folder): _read(folder, given, axes, times) for folder in folders}
    if as_json:
        click.echo(json.dumps(results, indent=2))
    else:
        runs = _run_names(results)
        rows = [row for name, of in results.items() for row in _rows(name, runs[name], of)]
        print_table([("folder", "run", "trajectory", "against", *HEADER[1:]), *rows])
        click.echo("Per metre of wheel travel, over the horizon that each result.json names.")
        for name, of in results.items():
            for one in of.get("edited", []):
                click.echo(f"Warning: {one}; the errors above are those of result.json", err=True)
            for remark in of.get("remarks", []):
                click.echo(f"Note: {name}: {remark}", err=True)
            if lost := _not_found(of):
                click.echo(f"Note: {name}: {lost}", err=True)
            for other, errors in _others(of).items():
                for note in errors.get("notes", []):
                    click.echo(f"Note: {name}: {other}: {note}", err=True)
    if any("error" in each for of in results.values() for each in (of, *_others(of).values())):
        sys.exit(1)


def _named_files(texts: Sequence[str]) -> dict[str, Path]:
    """Files by name, from texts like slam=slam.tum."""
    files = {}
    for text in texts:
        name, equals, file = text.partition("=")
        if not (name and equals and file) or name in files:
            raise click.BadParameter(
                f"{text!r}, expected NAME=FILE, each name once", param_hint="--with"
            )
        files[name] = Path(file)
    return files


def _read(folder: Path, given: Mapping[str, Path], axes: str, times: Path | None) -> dict[str, Any]:
    """Errors of one folder; what went wrong where they cannot be read."""
    from odometry.errors import OdometryError
    from odometry.outputs.written_tables import changes_of
    from terrain.other_odometry.other_odometry import other_errors
    from terrain.results import read_errors

    try:
        found = read_errors(folder)
        changes = changes_of(folder)
        if changes.lost:
            return {"error": f"{'; '.join(changes.lost)}. `run` again"}
        run_path = found["run_path"]
        others = other_errors(folder, given, run_path=run_path, axes=axes, times=times)
    except OdometryError as error:
        return {"error": str(error)}
    edited = {"edited": list(changes.edited)} if changes.edited else {}
    return found | ({"others": others} if others else {}) | edited


def _not_found(result: Mapping[str, Any]) -> str:
    """What to say of odometry that the run folder kept, where that folder is elsewhere now."""
    kept, path = result.get("other_odometry", []), result.get("run_path")
    if not kept or not path or Path(path).is_dir():
        return ""
    return (
        f"{', '.join(kept)} of its run is not evaluated: there is no folder {path} here. Name the "
        f"file: --with {kept[0]}=RUN/other_odometry/{kept[0]}.csv"
    )


def _others(result: Mapping[str, Any]) -> Mapping[str, Any]:
    found: Mapping[str, Any] = result.get("others", {})
    return found


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
    against = str(result.get("reference") or "-")
    rows = [
        (name, run, trajectory, errors.get("against", against), *error_cells(errors))
        for trajectory, errors in result["errors"].items()
    ] or [(name, run, "nothing to compare with", *empty)]
    for other, errors in _others(result).items():
        if "error" in errors:
            rows.append((name, run, f"{other} failed: {errors['error']}", *empty))
            continue
        rows.append((name, run, other, against, *error_cells(errors)))
        if errors["share"] < 1 or errors["own_stamps"]:
            same = f"odometer, stamps of {other}"
            rows.append((name, run, same, against, *error_cells(errors["odometer"])))
    return rows
