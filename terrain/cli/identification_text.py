"""How `identify` prints what it found, or why that is no answer."""

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from odometry.identification.identification import Identification, Identified


def print_identification(found: "Identification") -> None:
    """Print the report of each terrain; what to doubt goes to standard error."""
    from odometry.identification.from_positions import position_notes
    from odometry.identification.plausibility import notes
    from odometry.identification.report import report
    from odometry.identification.short_windows import short_windows
    from odometry.windows.left_out import words

    for name, of_terrain in found.terrains.items():
        click.echo("\n".join(report(name, of_terrain)))
        short = short_windows(of_terrain.fit.windows, found.window_config)
        doubts = (
            *notes(of_terrain.fit),
            *_assumed(of_terrain),
            *_no_gain(of_terrain),
            of_terrain.halves and of_terrain.halves.note(),
            short,
        )
        for doubt in filter(None, (*position_notes(of_terrain.fit), *doubts)):
            click.echo(f"Note: {doubt}", err=True)
    if found.left_out:
        click.echo(f"Note: {words(found.left_out)}", err=True)


def require_determined(found: "Identification") -> None:
    """Refuse a fit that is no answer: why, what the check warned of, and the fit in short.

    Raises
    ------
    IdentificationError
    """
    from odometry.checks.finding import Level
    from odometry.identification.errors import IdentificationError
    from odometry.identification.report import in_short
    from odometry.identification.simpler_model import SIMPLE, simpler_model
    from odometry.windows.left_out import words
    from terrain.cli.recordings import checks_made

    try:
        found.require_determined()
    except IdentificationError as error:
        causes = [
            f"  {report.folder}: {warning.cause}. {warning.remedy}."
            for report in checks_made()
            for warning in report.at(Level.WARNING)
        ]
        lines = [str(error)]
        lines += ["Mend first what the check warned of:", *causes] if causes else []
        lines += ["Nothing is written. The fit that is refused:"]
        lines += [f"  {in_short(name, one)}" for name, one in found.terrains.items()]
        lines += [f"  {words(found.left_out)}"] if found.left_out else []
        simpler = simpler_model(found)
        if simpler is not None:
            lines += [f"The same runs determine a model with fewer parameters: --model {SIMPLE}"]
            lines += [f"  {in_short(name, one)}" for name, one in simpler.terrains.items()]
        raise IdentificationError("\n".join(lines)) from error


def _assumed(found: "Identified") -> list[str]:
    fit = found.fit
    names = [n for n in fit.values if n not in (*fit.names, *fit.by_trial, *found.given)]
    if not names:
        return []
    return [
        f"{', '.join(names)}: assumed from [robot] of run.toml or by rule of thumb; "
        "--fix NAME=VALUE says better"
    ]


def _no_gain(found: "Identified") -> list[str]:
    if found.held_out is None or (
        found.held_out.translation_per_m.mean() < found.ideal.translation_per_m.mean()
        and found.held_out.rotation_per_m.mean() < found.ideal.rotation_per_m.mean()
    ):
        return []
    return [
        "held out, it errs no less than no model at all: too little data, or an effect that this "
        "model does not have"
    ]
