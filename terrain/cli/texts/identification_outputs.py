"""What `identify` prints and the files that it writes, claimed before any work."""

import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from odometry.identification.identification import Identification, Identified
    from odometry.outputs.provenance import Made
    from odometry.parameters import ParameterSet
    from odometry.recording.run import Run


def require_icr_form(model: str) -> None:
    """Refuse --ros of a model that has no multiplier in ROS, before any run is read."""
    from odometry.estimation.terrain_beliefs import ICR_FORM_MODELS

    if model in MODEL_NAMES and model not in ICR_FORM_MODELS:
        raise click.UsageError(
            f"--ros: the model {model!r} has no constant ICRs, so no multipliers stand for it; it "
            f"takes {', '.join(ICR_FORM_MODELS)}"
        )


def draw(
    picture: Path, runs: "Sequence[Run]", found: "Identification", terrain: str | None
) -> None:
    """Draw the picture, or say why there is none: the parameter set is written without it."""
    from odometry.errors import OdometryError
    from odometry.outputs.output_file import picture_source
    from odometry.positions.heading import headed
    from odometry.report.icrs.icr_picture import save_identified_icrs

    try:
        with_yaw = headed(runs).runs
        save_identified_icrs(picture, with_yaw, found, terrain, source=picture_source("identify"))
    except OdometryError as error:
        picture.unlink(missing_ok=True)  # that of an earlier call shows other parameters
        click.echo(f"Note: no picture is drawn: {error}", err=True)
    else:
        click.echo(f"Wrote {picture}")


def claimed(out: Path, picture: Path | None, ros: Path | None) -> "Made":
    """Claim the files that are going to be written; what makes them is returned."""
    from odometry.outputs.output_file import is_set_of, is_text_of
    from terrain.cli.outputs import claim_file, claim_picture

    for option, file, suffix in (
        ("--out", out, ".toml"),
        ("--picture", picture, ".png"),
        ("--ros", ros, ".yaml"),
    ):
        if file is not None and file.suffix != suffix:
            raise click.UsageError(f"{option} {file}: expected a name that ends in {suffix}")
    made = claim_file(out, is_set_of("identify"))
    if picture is not None:
        claim_picture(picture)
    if ros is not None:
        claim_file(ros, is_text_of("identify"))
    return made


def write_ros(ros: Path, runs: "Sequence[Run]", found: "Identification", comment: str) -> None:
    """Write what was found for nodes of ROS 2."""
    from odometry.export.ros_file import identified_ros_yaml, write_text

    write_text(ros, identified_ros_yaml(found, runs, comment))
    click.echo(f"Wrote {ros}")


def print_identification(found: "Identification") -> None:
    """Print the report of each terrain; what to doubt goes to standard error."""
    from odometry.identification.plausibility import (
        notes,
        short_windows,
        turns_one_way,
        turns_outside,
    )
    from odometry.identification.position_notes import position_notes
    from odometry.identification.report import report
    from odometry.identification.shorter_windows import shortened
    from odometry.windows.recorded.record import words

    for name, of_terrain in found.terrains.items():
        if of_terrain.mixed:
            click.echo(f"Warning: [{name}] {of_terrain.mixed}", err=True)
    for name, of_terrain in found.terrains.items():
        click.echo("\n".join(report(name, of_terrain)))
        windows, config = of_terrain.fit.windows, found.window_config
        taken_m = of_terrain.horizon_m or config.travel_m
        doubts = (
            shortened(windows, config.travel_m, taken_m),
            *notes(of_terrain.fit),
            turns_outside(of_terrain.fit, found.robot),
            turns_one_way(of_terrain.fit),
            *_assumed(of_terrain),
            *_no_gain(of_terrain),
            of_terrain.halves and of_terrain.halves.note(),
            short_windows(windows, replace(config, horizon_m=taken_m)),
        )
        for doubt in filter(None, (*position_notes(of_terrain.fit), *doubts)):
            click.echo(f"Note: {doubt}", err=True)
    if found.left_out:
        click.echo(f"Note: {words(found.left_out)}", err=True)


def warned(found: "Identification") -> "tuple[ParameterSet, str]":
    """The set whose tables say what is to be doubted, and the last words; "" where nothing is.

    It is written all the same: what the check finds odd may be what the robot did.
    """
    identified, by_check = _warned_by_check(found.to_parameter_set())
    mixed = [name for name, of_terrain in found.terrains.items() if of_terrain.mixed]
    if not mixed:
        return identified, by_check
    terrains = dict(identified.terrains)
    for name in mixed:
        source = f"{terrains[name].source}; an average of parts that differ"
        terrains[name] = replace(terrains[name], source=source)
    last = (
        f"These parameters are not recommended: averages of parts that differ ({', '.join(mixed)}; "
        "see the warning above)."
    )
    return replace(identified, terrains=terrains), "\n".join(filter(None, (last, by_check)))


def _warned_by_check(identified: "ParameterSet") -> "tuple[ParameterSet, str]":
    from odometry.checks.findings.finding import Level
    from odometry.checks.findings.warned import faults_of, sensor_faults
    from terrain.cli.recordings import checks_made

    warnings = [one for one in faults_of(checks_made()) if one[1].level is Level.WARNING]
    names = ", ".join(sensor_faults(warnings))
    if not names:
        return identified, ""
    tables = {
        name: replace(table, source=f"{table.source}; check warns of {names}")
        for name, table in identified.terrains.items()
    }
    folders = [str(report.folder) for report in checks_made() if report.at(Level.WARNING)]
    last = (
        f"These parameters are not recommended: check warns of {names}, which they take for what "
        "the robot does.\nNext: correct or leave out what it warns of, and identify again: "
        f"terrain-odometry check {shlex.join(folders)}"
    )
    return replace(identified, terrains=tables), last


def require_determined(found: "Identification") -> None:
    """Refuse a fit that is no answer: why, what the check warned of, and the fit in short.

    Raises
    ------
    IdentificationError
    """
    from odometry.checks.findings.finding import Level
    from odometry.errors import IdentificationError
    from odometry.identification.identify import SIMPLE, simpler_model
    from odometry.identification.report import in_short
    from odometry.windows.recorded.record import words
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
        lines += ["First correct what the check warned of:", *causes] if causes else []
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
        "state what you know better with --fix NAME=VALUE"
    ]


def _no_gain(found: "Identified") -> list[str]:
    if found.held_out is None or (
        found.held_out.translation_per_m.mean() < found.ideal.translation_per_m.mean()
        and found.held_out.rotation_per_m.mean() < found.ideal.rotation_per_m.mean()
    ):
        return []
    return [
        "held out, its error is no smaller than that of no model at all: too little data, or an "
        "effect that this model does not have"
    ]
