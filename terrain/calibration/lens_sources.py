"""The lens of a run's camera: from a calibration file, from photographs, or as run.toml has it."""

from dataclasses import dataclass
from pathlib import Path

from odometry.run import Run
from terrain.calibration.chessboard import BoardViews, Chessboard, find_boards, photo_files
from terrain.calibration.first_image import first_image, require_size
from terrain.calibration.lens_from_boards import LensFit, lens_from_boards
from terrain.camera_files.calibration import Calibration, Lens
from terrain.camera_files.read import read_calibration
from terrain.errors import CalibrationError, CameraError


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
