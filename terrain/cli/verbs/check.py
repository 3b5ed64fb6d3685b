"""`terrain-odometry check`: what is odd about recordings, before anything is fitted to them."""

import json
import shlex
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from odometry.checks.findings.finding import CheckReport
    from terrain.classification.classifier import TerrainClassifier

NO_DRIVE = ("one_motion", "treads_still")  # `identify` refuses such a run alone


@click.command()
@click.argument(
    "folders", metavar="RUN...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option("--json", "as_json", is_flag=True, help="Print the findings as a JSON list.")
@click.option(
    "--picture",
    type=click.Path(path_type=Path),
    metavar="DIR_or_FILE",
    help="Draw each run: speeds, yaw rates, path, the terrain in one image (PNG).",
)
@click.option(
    "--model",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Classifier made by `train` that is going to read the images.",
)
def check(
    folders: tuple[Path, ...], *, as_json: bool, picture: Path | None, model: Path | None
) -> None:
    """Find problems of the run folders RUN: what was found, its likeliest cause, what to do.

    `refused`: the run cannot be read as it is. `warning`: answers would mislead. `note`: repaired,
    or harmless. The exit code is 1 where a run is refused or has a warning.

    \b
    Example:
      terrain-odometry check my_run other_run --picture pictures
    """
    from terrain.checks.recording import check_run
    from terrain.cli.outputs import claim_picture

    files = _picture_files(folders, picture) if picture is not None else {}
    for file in files.values():
        claim_picture(file)
    classifier = None if model is None else _loaded(model)
    reports = {}
    for folder in dict.fromkeys(folders):
        reports[folder] = check_run(folder, classifier)
        if not as_json:
            print_findings(folder, reports[folder])
        if folder in files and not _drawn(reports[folder], files[folder]):
            click.echo(f"Note: {folder}: no picture, it is refused", err=True)
    if as_json:
        click.echo(json.dumps([report.to_table() for report in reports.values()], indent=2))
    else:
        click.echo(next_step(reports, files))
    if any(report.misleads for report in reports.values()):
        sys.exit(1)


def _loaded(model: Path) -> "TerrainClassifier":
    from terrain.classification.classifier import TerrainClassifier

    return TerrainClassifier.load(model)


def _drawn(report: "CheckReport", file: Path) -> bool:
    from terrain.report.check_figure import write_check_figure

    return write_check_figure(report, file) is not None


def print_findings(folder: Path, report: "CheckReport") -> None:
    """Print what a check found, a line each."""
    if not report.findings:
        click.echo(f"{folder}: no findings")
    else:
        click.echo(f"{folder}:")
        for finding in report.findings:
            click.echo(f"  {' '.join(finding.line.split())}")
    for reason in report.skipped:
        click.echo(f"  not checked: {reason}")


def next_step(reports: Mapping[Path, "CheckReport"], files: Mapping[Path, Path]) -> str:
    """What to do next, in one line."""
    from odometry.checks.findings.finding import Level

    drawn = [file for folder, file in files.items() if not reports[folder].at(Level.REFUSED)]
    place = drawn[0] if len(drawn) == 1 else drawn[0].parent if drawn else ""
    look = f"look at {place}; " if drawn else ""
    odd = {folder: report for folder, report in reports.items() if report.misleads}
    if not odd:
        with_poses = [folder for folder in reports if (folder / "pose.csv").exists()]
        if not with_poses:
            return f"Next: {look}terrain-odometry run {_quoted(reports)[0]} --out results"
        runs = " ".join(_quoted(with_poses))
        if all(_is_no_drive(reports[folder]) for folder in with_poses):
            return (
                f"Next: {look}record turns to both sides, of several radii and speeds: identify "
                f"refuses {runs}"
            )
        return f"Next: {look}terrain-odometry identify {runs} --model icr --out my_robot.toml"
    readable = _quoted(folder for folder, report in odd.items() if not report.at(Level.REFUSED))
    if readable and not files:
        look = f"terrain-odometry check {' '.join(readable)} --picture pictures; "
    slipping = [str(folder) for folder, report in odd.items() if _only_slips(report)]
    others = [str(folder) for folder in odd if str(folder) not in slipping]
    advice = []
    if others:
        advice.append(f"correct or leave out {', '.join(others)}, and check again")
    if slipping:
        advice.append(
            f"use {', '.join(slipping)} as recorded if the robot truly slipped (nothing can be "
            "mended then); else mend the scale that is wrong, and check again"
        )
    return f"Next: {look}{'; '.join(advice)}"


def _quoted(folders: Iterable[Path]) -> list[str]:
    """Paths as a shell reads them."""
    return [shlex.quote(str(folder)) for folder in folders]


def _is_no_drive(report: "CheckReport") -> bool:
    return any(finding.name in NO_DRIVE for finding in report.findings)


def _only_slips(report: "CheckReport") -> bool:
    """Whether all that would mislead may be what the robot truly did."""
    from odometry.checks.findings.finding import Level
    from odometry.checks.findings.warned import TRUE_SLIP

    odd = [finding for finding in report.findings if finding.level is not Level.NOTE]
    return all(finding.name in TRUE_SLIP for finding in odd)


def _picture_files(folders: tuple[Path, ...], picture: Path) -> dict[Path, Path]:
    """One file a run; runs of the same name are numbered."""
    runs = list(dict.fromkeys(folders))
    if picture.suffix.lower() == ".png":
        if len(runs) > 1:
            raise click.UsageError(
                f"--picture {picture} is one file; name a folder for several runs"
            )
        return {runs[0]: picture}
    files: dict[Path, Path] = {}
    for folder in runs:
        name = folder.resolve().name
        taken = sum(other.resolve().name == name for other in files)
        files[folder] = picture / (f"{name}_{taken + 1}.png" if taken else f"{name}.png")
    return files
