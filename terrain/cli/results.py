"""How the commands print results."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.result.run_result import RunResult

MOST_CHANGES = 6  # of the terrain in force, that are printed
HEADER = (
    *("", "m per m: mean", "median", "degrees per m: mean", "median"),
    *("position m: mean", "median", "final"),
)


def print_errors(results: Mapping[str, "RunResult"]) -> None:
    """Print the errors of each result's trajectories, one row each."""
    rows = []
    for name, result in results.items():
        for trajectory, score in result.scores.items():
            rows.append((f"{name}: {trajectory}", *error_cells(score.to_table())))
    if not rows:
        click.echo(
            "There is nothing to compare the odometer with: no pose.csv or truth.csv, or fewer "
            "than two poses within odometry.csv."
        )
        return
    first = next(iter(results.values()))
    click.echo(
        f"Errors against {first.reference_name}.csv, "
        f"per metre over {first.config.evaluation.horizon_m:g} m of wheel travel:"
    )
    print_table([HEADER, *rows])
    for name, result in results.items():
        for line in _beside_errors(result):
            click.echo(line if len(results) == 1 else f"{name}: {line}")


def _beside_errors(result: "RunResult") -> list[str]:
    """What the table does not hold: how the estimate is evaluated, and what else to note."""
    from terrain.result.evaluation_notes import advice, evaluated_with, without_gyroscope_row

    second = result.second
    how = [] if second is None else [f"The estimate is evaluated with {evaluated_with(second)}"]
    return [
        *how,
        *without_gyroscope_row(result.replay),
        *result.remarks,
        advice(result.uncertainty, result.reference_name),
    ]


def print_image_labels(counts: Mapping[str, int]) -> None:
    """Say how many images got each label, and how many none and why."""
    if counts:
        click.echo("Images: " + ", ".join(f"{count} {word}" for word, count in counts.items()))


def print_changes(result: "RunResult") -> None:
    """Say when which terrain came into force, where there is a source of terrain."""
    if result.source == "none":
        return
    began_s = result.run.began_s
    changes = result.changes_and_unknown
    shown = [f"from {of.stamp_s - began_s:.1f} s {of.terrain}" for of in changes[:MOST_CHANGES]]
    more = len(changes) - len(shown)
    rest = [f"{more} more changes, see terrain.csv"] if more else []
    click.echo(f"Terrain in force: {', '.join([result.initial_terrain, *shown, *rest])}")
    if shown and began_s:
        click.echo(f"  (seconds of run time, which begins at the stamp {began_s:.3f})")


def error_cells(errors: Mapping[str, Any]) -> list[str]:
    """Numbers of one trajectory of result.json as cells of the table; "-" where there is none."""
    translation, rotation, position = (
        errors[name] for name in ("translation_m_per_m", "rotation_deg_per_m", "position_m")
    )
    values = (
        *(translation["mean"], _median(translation)),
        *(rotation["mean"], _median(rotation)),
        *(position["mean"], position.get("median"), position["final"]),
    )
    return [f"{value:.4f}" if isinstance(value, float | int) else "-" for value in values]


def _median(errors: Mapping[str, Any]) -> float | None:
    """The median, which version 0.4 wrote as the second of the quartiles alone."""
    match errors.get("quartiles"):
        case [_, float() as median, _]:
            return median
    return None


def print_table(rows: Sequence[Sequence[str]]) -> None:
    """Print a header and rows in columns, words to the left, numbers to the right.

    A text with nothing but empty cells after it, as a reason has, makes no column wider.
    """
    columns = list(zip(*rows, strict=True))
    widths = [
        max((len(row[i]) for row in rows if any(row[i + 1 :])), default=max(map(len, column)))
        for i, column in enumerate(columns)
    ]
    words = [any(cell.strip("-")[:1].isalpha() for cell in column[1:]) for column in columns]
    words[0] = True
    for row in rows:
        cells = [
            cell.ljust(width) if is_words else cell.rjust(width)
            for cell, width, is_words in zip(row, widths, words, strict=True)
        ]
        click.echo(f"  {'  '.join(cells)}".rstrip())


def print_written(out: Path) -> None:
    """Say which files an output folder got."""
    from odometry.outputs.manifest import NAME, read_manifest

    manifest = read_manifest(out)
    names = sorted([*(manifest.files if manifest else ()), NAME])
    click.echo(f"Wrote to {out}: {', '.join(names)}")


def learned_advice(
    result: "RunResult", run_folder: Path, out: Path, *, has_warnings: bool, preset: str | None
) -> str | None:
    """One line on learned.toml; None where there is none, or a preset refuses it.

    Parameters
    ----------
    result : RunResult
    run_folder, out : Path
        Of the run, and of its results.
    has_warnings : bool
        Whether the check of the recording found what would mislead.
    preset : str, optional
        A published system knows no parameter sets.
    """
    from terrain.result.evaluation_notes import misleading

    if preset is not None or not result.learned.terrains:
        return None
    if not result.has_learned:
        return f"learned.toml holds the tables of --parameters: {_why_nothing(result)}"
    if has_warnings:
        return (
            "learned.toml is not recommended: the recording has warnings (terrain-odometry check "
            f"{run_folder})"
        )
    events = misleading(result.replay)
    if events:
        kinds = ", ".join(dict.fromkeys(event.kind.replace("_", " ") for event in events))
        return (
            f"learned.toml is not recommended: the filter noticed {kinds} (see {out}/report.html)"
        )
    before = result.parameters.terrains
    kept = [name for name, of in result.learned.terrains.items() if of is before.get(name)]
    stays = f" ({', '.join(kept)} as given)" if kept else ""
    return f"Next time: --parameters {out / 'learned.toml'} starts from what was learned{stays}"


def _why_nothing(result: "RunResult") -> str:
    """Why a run left the tables of terrains as they were."""
    if not result.replay.accepted.any():
        return "nothing was learned, as no pose was used"
    return (
        "nothing was learned. Each terrain in force, if any, is stated with smaller uncertainties "
        "than this run reaches; a note says where a table does not fit"
    )
