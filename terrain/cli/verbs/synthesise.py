"""`terrain-odometry synthesise`: a run with images made from photographs."""

from pathlib import Path
from typing import Any

import click

from terrain.cli.options import OUTPUT


@click.command()
@click.option(
    "--out",
    required=True,
    metavar="RUN",
    type=OUTPUT,
    help="Folder to make: missing, empty, or made by an earlier `synthesise`.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Seed of all randomness.",
)
@click.option(
    "--zone",
    "zones",
    multiple=True,
    metavar="TERRAIN",
    help="Terrain of one zone along the way; repeat.  [default: gravel, grass, gravel]",
)
@click.option("--zone-length", type=float, help="Length of each zone [m].  [default: 11.5]")
@click.option(
    "--photos",
    type=click.Path(path_type=Path),
    help="Labelled photographs FOLDER/<terrain>/*.jpg|png.  "
    "[default: grass, gravel and brick of scikit-image]",
)
@click.option(
    "--metres-per-pixel",
    type=float,
    help="Scale of the photographs on the terrain. [default: 0.003]",
)
@click.option("--image-rate", type=float, help="Images a second.  [default: 4]")
@click.option("--camera", type=click.Path(path_type=Path), help="TOML file with a [camera] table.")
@click.option("--vehicle", type=click.Path(path_type=Path), help="TOML file with a [robot] table.")
@click.option("--imu", is_flag=True, help="Also imu.csv: vibration by terrain and speed.")
def synthesise(
    *,
    out: Path,
    seed: int,
    zones: tuple[str, ...],
    zone_length: float | None,
    photos: Path | None,
    metres_per_pixel: float | None,
    image_rate: float | None,
    camera: Path | None,
    vehicle: Path | None,
    imu: bool,
) -> None:
    """Make a run folder, patches/ and parameters.toml, ready for train and run.

    A simulated robot drives over zones of terrain that are textured with photographs; its camera's
    images, noisy odometry and poses are written with the truth. No photograph shows both in the
    run and in the patches: those of scikit-image are cut in halves, those of --photos are parted
    by photo_id.

    \b
    Example:
      terrain-odometry synthesise --out my_run --seed 3
      terrain-odometry synthesise --out my_run --photos my_photos --zone asphalt --zone sand
    """
    from terrain.cli.outputs import claim_folder
    from terrain.synthesis.config import read_camera, read_robot
    from terrain.synthetic import SynthesisConfig
    from terrain.synthetic import synthesise as make_run

    output = claim_folder(out)
    given: dict[str, Any] = {
        "zones": zones or None,
        "zone_length_m": zone_length,
        "metres_per_pixel": metres_per_pixel,
        "image_rate_hz": image_rate,
        "camera": read_camera(camera) if camera else None,
        "robot": read_robot(vehicle) if vehicle else None,
    }
    chosen = {name: value for name, value in given.items() if value is not None}
    config = SynthesisConfig(seed=seed, has_imu=imu, **chosen)
    with output.writing() as part:
        make_run(part, config, photos=photos, progress=True)
    click.echo(
        f"Wrote the run {out}, {out / 'patches'} ({config.patch_size_px} px, "
        f"{config.metres_per_pixel:g} m per pixel) and {out / 'parameters.toml'}."
    )
    click.echo("Next:")
    click.echo(f"  terrain-odometry train {out / 'patches'} --out terrain.model")
    click.echo(
        f"  terrain-odometry run {out} --model terrain.model "
        f"--parameters {out / 'parameters.toml'} --out result"
    )
