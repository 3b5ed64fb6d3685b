"""The lens of a run's camera: from a file, from photographs, or as run.toml has it."""

from dataclasses import dataclass
from pathlib import Path

from odometry.arrays import ByteImage
from odometry.recording.run import Run
from terrain.calibration.chessboard import BoardViews, Chessboard, find_boards, photo_files
from terrain.calibration.lens_from_boards import LensFit, lens_from_boards
from terrain.camera_files.lens_models import Calibration, Lens
from terrain.camera_files.read import read_calibration
from terrain.errors import CalibrationError, CameraError, ImageError
from terrain.images import read_image

TRIES = 20


def first_image(run: Run) -> ByteImage | None:
    """The first image of a run that can be read; None where it has none."""
    if run.images is None:
        return None
    for name in run.images["file"][:TRIES]:
        try:
            return read_image(run.folder / str(name))
        except ImageError:
            continue
    return None


def require_size(run: Run, lens: Lens) -> None:
    """Raise CameraError unless the run's images have the size of the lens, or there are none."""
    image = first_image(run)
    if image is None:
        return
    height, width = image.shape[:2]
    if (width, height) == lens.image_size:
        return
    lens_width, lens_height = lens.image_size
    advice = "give the calibration of this camera"
    if width * lens_height == height * lens_width:
        advice = (
            f"if the images were made smaller or larger, not cut, multiply fx, fy, cx and cy by "
            f"{width / lens_width:g} and state the images' size"
        )
    raise CameraError(
        f"the images of {run.folder} have {width} x {height} pixels, the lens is that of "
        f"{lens_width} x {lens_height}: {advice}"
    )


@dataclass(frozen=True, eq=False)
class LensSource:
    """A lens and its source.

    Attributes
    ----------
    lens : Lens
    where : str
        In words.
    is_own : bool
        Whether it is that of run.toml.
    file : Calibration or None
        What else a calibration file said.
    boards : (BoardViews, LensFit) or None
        What photographs of a chessboard said.
    """

    lens: Lens
    where: str
    is_own: bool = False
    file: Calibration | None = None
    boards: tuple[BoardViews, LensFit] | None = None


def lens_of_run(run: Run) -> LensSource:
    """The lens of [camera] in run.toml.

    Raises
    ------
    CameraError
        If there is none.
    """
    table = run.settings.get("camera")
    where = f"{run.folder / 'run.toml'}"
    if not isinstance(table, dict) or not {"image_size", "matrix"} <= table.keys():
        raise CalibrationError(
            f"{where}: no [camera] with image_size and matrix; give a calibration file (--file), "
            "or photographs of a chessboard (--chessboard, --square-m, --photos)"
        )
    try:
        lens = Lens.of(table["image_size"], table["matrix"], table.get("distortion", []))
    except (CameraError, TypeError, ValueError) as error:
        raise CameraError(f"{where}: [camera] {error}") from error
    require_size(run, lens)
    return LensSource(lens, where, is_own=True)


def lens_of_file(run: Run, file: Path, name: str | None = None) -> LensSource:
    """The lens of a calibration file, of the size of the run's images where it says none.

    Raises
    ------
    CameraError
        If the file holds none that [camera] can express, or one of another size.
    """
    image = first_image(run)
    size = None if image is None else (image.shape[1], image.shape[0])
    found = read_calibration(file, name=name, image_size=size)
    require_size(run, found.lens)
    return LensSource(found.lens, str(file), file=found)


def lens_of_photos(
    run: Run, folder: Path, board: Chessboard, *, show_progress: bool = False
) -> LensSource:
    """The lens from photographs of a chessboard.

    Raises
    ------
    CameraError
        If the photographs do not determine it, or are of another size than the run's images.
    """
    seen = find_boards(photo_files(folder), board, show_progress=show_progress)
    fit = lens_from_boards(seen, board)
    require_size(run, fit.lens)
    return LensSource(fit.lens, str(folder), boards=(seen, fit))
