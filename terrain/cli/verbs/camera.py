"""`terrain-odometry camera`: the terrain in the camera's image, and the calibration."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import OUTPUT
from terrain.cli.recordings import span_options
from terrain.cli.run_folders import RunFolder

if TYPE_CHECKING:
    from odometry.recording.run import Run
    from odometry.recording.run_span import Span
    from terrain.calibration.lens_sources import LensSource
    from terrain.calibration.mount_sources import MountSource

FILE = click.Path(exists=True, dir_okay=False, path_type=Path)
FOLDER = click.Path(exists=True, file_okay=False, path_type=Path)
POSE = "X Y Z ROLL PITCH YAW"


def board_size(text: str) -> tuple[int, int]:
    """Columns and rows of inner corners from a text such as 9x6, or click's error."""
    columns, _, rows = text.lower().partition("x")
    if not (columns.isdecimal() and rows.isdecimal() and len(text) < 9):
        raise click.BadParameter(f"{text!r}, expected inner corners such as 9x6")
    return int(columns), int(rows)


@click.command()
@click.argument("run_folder", metavar="RUN", type=RunFolder())
@click.option(
    "--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for pictures and camera.toml."
)
@click.option(
    "--file",
    "calibration",
    type=FILE,
    help="Lens: ROS camera_info, Kalibr camchain or OpenCV file (YAML, XML, JSON), or TOML.",
)
@click.option("--name", metavar="CAMERA", help="Which camera of a file with several.")
@click.option(
    "--chessboard",
    type=board_size,
    metavar="COLSxROWS",
    help="Lens from --photos of a board with so many inner corners.",
)
@click.option("--square-m", type=float, help="Side of a square of the board [m].")
@click.option("--photos", type=FOLDER, help="Folder of photographs of the board.")
@click.option(
    "--mount",
    type=(float,) * 6,
    metavar=POSE,
    help="Mount as measured [m, rad]; pitch is positive downwards.",
)
@click.option(
    "--transforms",
    type=FILE,
    help="Mount from a file of matrices T_PARENT__CHILD, one of them base_footprint's.",
)
@click.option("--frame", help="Optical frame in --transforms.  [default: the name in --file]")
@click.option(
    "--imu",
    type=(float,) * 6,
    metavar=POSE,
    help="Mount from T_cam_imu of a Kalibr file, with the IMU's place in the robot frame.",
)
@click.option("--points", type=FILE, help="Mount from marked points of the terrain (CSV: u,v,x,y).")
@click.option(
    "--from-motion",
    is_flag=True,
    help="Mount from the run itself: pitch, height, roll and yaw that agree with the odometer.",
)
@click.option("--model", type=FILE, help="Classifier made by `train` that will read the images.")
@click.option("--write", is_flag=True, help="Put [camera] into RUN/run.toml.")
@span_options
def camera(
    run_folder: Path,
    *,
    out: Path,
    calibration: Path | None,
    name: str | None,
    chessboard: tuple[int, int] | None,
    square_m: float | None,
    photos: Path | None,
    mount: tuple[float, ...] | None,
    transforms: Path | None,
    frame: str | None,
    imu: tuple[float, ...] | None,
    points: Path | None,
    from_motion: bool,
    model: Path | None,
    write: bool,
    span: "Span",
) -> None:
    """Show where the terrain lies in the images of the run folder RUN, or calibrate the camera.

    Draws a metric grid, the footprint and the look-ahead place on images of the run. Without
    other options it shows [camera] of run.toml. A lens comes from --file or --chessboard, a mount
    from one of --mount, --transforms, --imu, --points and --from-motion; what is not given is
    that of run.toml. RUN is changed only with --write.

    \b
    Example:
      terrain-odometry camera my_run --file camera.yaml --points marked.csv --out camera
    """
    from terrain.classification.classifier import TerrainClassifier
    from terrain.cli.outputs import claim_folder
    from terrain.cli.recordings import read_run
    from terrain.cli.texts.camera_outputs import draw, write_tables
    from terrain.cli.texts.camera_text import (
        print_doubts,
        print_lens,
        print_mount,
        print_seen,
        print_written,
    )

    sources = {
        "--transforms": transforms,
        "--imu": imu,
        "--points": points,
        "--mount": None if from_motion else mount,
        "--from-motion": from_motion or None,
    }
    _check_sources(sources, calibration, (chessboard, square_m, photos))
    output = claim_folder(out)
    run = read_run(run_folder, span)
    classifier = TerrainClassifier.load(model) if model is not None else None
    lens = _lens(run, calibration, name, (chessboard, square_m, photos))
    print_lens(lens)
    placed = _placed(run, lens, sources, frame, mount)
    if placed is not None:
        print_mount(placed)
        print_seen(placed.camera, run.robot, classifier)
        print_doubts(run, placed)
    with output.writing() as part:
        tables = write_tables(part, run, lens, placed, output.made)
        files = [*draw(part, run, lens, placed, classifier), *tables]
        names = [file.relative_to(part).as_posix() for file in files]
    print_written(out, names)
    if write:
        _write(run_folder, placed)
    is_new = not lens.is_own or any(value is not None for value in sources.values())
    click.echo(_next(run_folder, out, placed, model, asks=is_new and not write))


def _check_sources(
    sources: dict[str, Any], calibration: Path | None, board: tuple[Any, Any, Any]
) -> None:
    """Raise click's error where options contradict each other, before any work."""
    given = [name for name, value in sources.items() if value is not None]
    if len(given) > 1:
        raise click.UsageError(f"{' and '.join(given)}: expected one source of the mount")
    if any(one is not None for one in board) and None in board:
        raise click.UsageError("--chessboard, --square-m and --photos go together")
    if calibration is not None and board[0] is not None:
        raise click.UsageError("--file and --chessboard: expected one source of the lens")
    if sources["--imu"] is not None and calibration is None:
        raise click.UsageError("--imu needs --file, a Kalibr file with T_cam_imu")


def _lens(
    run: "Run", calibration: Path | None, name: str | None, board: tuple[Any, Any, Any]
) -> "LensSource":
    from terrain.calibration.chessboard import Chessboard
    from terrain.calibration.lens_sources import lens_of_file, lens_of_photos, lens_of_run

    size, square_m, photos = board
    if size is not None:
        board_seen = Chessboard(size[0], size[1], square_m)
        return lens_of_photos(run, photos, board_seen, show_progress=True)
    return lens_of_run(run) if calibration is None else lens_of_file(run, calibration, name)


def _placed(
    run: "Run",
    lens: "LensSource",
    sources: dict[str, Any],
    frame: str | None,
    stated: tuple[float, ...] | None,
) -> "MountSource | None":
    """The camera where the options say that it sits, else where run.toml or the file does."""
    from terrain.calibration import mount_sources as mounts
    from terrain.main_job import run_odometry

    if sources["--transforms"] is not None:
        return mounts.mount_of_transforms(lens, sources["--transforms"], frame)
    if sources["--imu"] is not None:
        return mounts.mount_of_imu(lens, sources["--imu"])
    if sources["--points"] is not None:
        return mounts.mount_of_points(lens.lens, sources["--points"])
    known: MountSource | None
    if stated is not None:
        known = mounts.mount_as_stated(lens.lens, stated)
    elif lens.file is not None and lens.file.mount is not None:
        known = mounts.mount_as_stated(lens.lens, lens.file.mount, lens.where)
    else:
        known = mounts.mount_of_run(run, lens)
    if sources["--from-motion"] is None:
        return known
    place = known.camera.mount if known is not None else None
    result = run_odometry(run, vision=False)
    odometer = result.replay.odometer()
    found = mounts.mount_of_motion(result.run, odometer, lens.lens, place, show_progress=True)
    return found if stated is not None else mounts.with_height(found)


def _write(run_folder: Path, placed: "MountSource | None") -> None:
    from terrain.calibration.camera_table import write_camera
    from terrain.cli.texts.camera_text import is_no_mount
    from terrain.errors import CalibrationError

    if placed is None:
        raise CalibrationError(
            "--write: nothing says where the camera sits, and a run needs it; give --points, "
            "--from-motion, --transforms or --mount as well"
        )
    if placed.fit is not None and placed.fit.contradiction:
        raise CalibrationError(
            f"--write: run.toml is left as it was, {placed.fit.contradiction}, or delete it"
        )
    if is_no_mount(placed):
        raise CalibrationError(
            "--write: run.toml is left as it was: no camera sits so; give x, y, z in metres, roll, "
            "pitch, yaw in radians, pitch positive downwards"
        )
    write_camera(run_folder, placed.camera.to_table())
    click.echo(f"Wrote [camera] of {run_folder / 'run.toml'}")


def _next(
    run_folder: Path, out: Path, placed: "MountSource | None", model: Path | None, *, asks: bool
) -> str:
    """What to do next, in one line."""
    run, made, table = (shlex.quote(str(path)) for path in (run_folder, out, out / "camera.toml"))
    verb = f"terrain-odometry camera {run}"
    if placed is None:
        return (
            f"Next: where the camera sits is not known: {verb} --file {table} "
            f"--points marked.csv --out {made} (u,v,x,y of at least 4 points of the terrain), or "
            "--from-motion"
        )
    look = f"look at {out / 'figures'}: do grid and footprint lie where they should?"
    if asks:
        return f"Next: {look} Then the same command with --write puts [camera] into run.toml"
    named = shlex.quote(str(model)) if model else "MODEL"
    return f"Next: {look} Then terrain-odometry run {run} --model {named} --out results"
