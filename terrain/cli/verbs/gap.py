"""`terrain-odometry gap`: which effect a model lacks, and the gap closed."""

import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES, OUTPUT, require_model
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table, print_written
from terrain.cli.run_folders import RunFolder, RunsFirst

if TYPE_CHECKING:
    from odometry.gap.answer.result import GapResult
    from odometry.recording.run_span import Span

FOLDER = RunFolder()


@click.command(cls=RunsFirst)
@click.argument("folders", metavar="MEASURED...", nargs=-1, required=True, type=FOLDER)
@click.option(
    "--calibration",
    multiple=True,
    required=True,
    metavar="RUN",
    type=FOLDER,
    help="Run without the effect, from which the noise is estimated, and the model unless --model "
    "is a parameter set; repeat.",
)
@click.option(
    "--holdout",
    multiple=True,
    metavar="RUN",
    type=FOLDER,
    help="Run on which the answer is tested; else stretches of MEASURED are held out; repeat.",
)
@click.option(
    "--model",
    default="icr",
    show_default=True,
    metavar="NAME|SET.toml",
    help=f"The model in use so far: {', '.join(MODEL_NAMES)} to identify, or a parameter set "
    "to take as it is.",
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@click.option("--terrain", metavar="NAME", help="Terrain of the set to take, where it has several.")
@click.option(
    "--horizon-s",
    type=float,
    default=2.0,
    show_default=True,
    help="Duration of the windows over which the gap is taken [s].",
)
@span_options
def gap(
    folders: tuple[Path, ...],
    *,
    calibration: tuple[Path, ...],
    holdout: tuple[Path, ...],
    model: str,
    out: Path,
    terrain: str | None,
    horizon_s: float,
    span: "Span",
) -> None:
    """Find which effect a model lacks on the run folders MEASURED, and add it.

    The answer is an effect of the catalogue, "none" (noise explains all), or
    "unknown" (something that no effect explains; a smooth term closes what it can).

    \b
    Example:
      terrain-odometry gap hill_1 --calibration yard --holdout hill_2 --out gap
    """
    from odometry.checks.findings.warned import faults_of
    from odometry.gap.config import GapConfig
    from odometry.gap.gap import find_gap
    from odometry.gap.prepare.uncertain_base import believed_model
    from odometry.gap.show.files import write_gap
    from odometry.report.gap.gap_page import write_gap_report
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.recordings import checks_made, read_runs

    require_model(model)
    output = claim_folder(out)
    config = GapConfig(horizon_s=horizon_s)
    measured, known, held = (read_runs(group, span) for group in (folders, calibration, holdout))
    base, given = believed_model(model, measured, terrain)
    result = find_gap(
        measured, known, held, model=base, given=given, config=config, show_progress=True
    )
    result = replace(result, faults=faults_of(checks_made()))
    for note in result.notes:
        click.echo(f"Note: {note}", err=True)
    with output.writing() as part:
        write_gap(result, part, about(output.made))
        write_gap_report(result, part)
    _print_result(result)
    print_written(out)
    extended = (
        f"; the extended model is {out / 'model.toml'}: terrain-odometry compare RUN "
        f"--model {shlex.quote(str(out / 'model.toml'))} --model {base.name} --out DIR"
    )
    click.echo(f"Next: open {out / 'report.html'}{extended if result.effects else ''}")


def _print_result(result: "GapResult") -> None:
    from odometry.gap.show.advice import listed
    from odometry.gap.show.words import sentences

    rows = [("effect", "form", "gap before [m]", "gap after [m]", "evidence")]
    rows += [
        (
            effect.added.effect.name,
            effect.added.effect.form,
            f"{effect.gap_before:.3g}",
            f"{effect.gap_after:.3g}",
            f"{effect.evidence:.0f}",
        )
        for effect in result.effects
    ]
    others = [one.name for one in result.equivalent if one.instead_of == result.verdict]
    as_well = f", which these runs do not distinguish from {listed(others, 'or')}" if others else ""
    click.echo(f"Verdict: {result.verdict}{as_well}")
    if result.effects:
        print_table(rows)
    for sentence in sentences(result):
        click.echo(sentence)
