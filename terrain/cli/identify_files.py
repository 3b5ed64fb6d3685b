"""The files that `identify` writes: claimed before any work, and what is written with the set."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import MODEL_NAMES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from odometry.identification.identification import Identification
    from odometry.outputs.made import Made
    from odometry.run import Run


def require_icr_form(model: str) -> None:
    """Refuse --ros of a model that has no multiplier in ROS, before any run is read."""
    from odometry.estimation.icr_prior import ICR_FORM_MODELS

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
    from odometry.report.icr_picture import save_identified_icrs

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
