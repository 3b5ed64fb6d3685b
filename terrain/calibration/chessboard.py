"""Inner corners of a chessboard in photographs."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from tqdm import tqdm

from odometry.arrays import ByteImage, FloatArray
from terrain.errors import CalibrationError, ImageError
from terrain.images import read_image, to_grey

SUFFIXES = (".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff")
MOST_PHOTOS = 500
WINDOW_SHARE = 0.25  # of the distance of corners, half a side of the window that refines one


@dataclass(frozen=True)
class Chessboard:
    """A board: inner corners, where four squares meet, along its two sides.

    Attributes
    ----------
    columns, rows : int
        A board of 10 x 7 squares has 9 x 6 inner corners.
    square_m : float
        Side of a square.
    """

    columns: int
    rows: int
    square_m: float

    def __post_init__(self) -> None:
        if min(self.columns, self.rows) < 3 or self.columns * self.rows > 10_000:
            raise CalibrationError(
                f"a chessboard of {self.columns} x {self.rows} inner corners, expected at least "
                "3 x 3"
            )
        if not 1e-4 <= self.square_m <= 10:
            raise CalibrationError(
                f"squares of {self.square_m:g} m, expected 0.0001 to 10: the side of one, in metres"
            )

    @property
    def corners_m(self) -> FloatArray:
        """Corners (columns * rows, 3) in the plane of the board, row by row."""
        x, y = np.meshgrid(np.arange(self.columns), np.arange(self.rows))
        flat = np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3)
        return np.asarray(flat * self.square_m, dtype=np.float64)


@dataclass(frozen=True, eq=False)
class BoardView:
    """The board in one photograph.

    Attributes
    ----------
    file : Path
    corners_px : (columns * rows, 2)
    """

    file: Path
    corners_px: FloatArray


@dataclass(frozen=True)
class BoardViews:
    """The photographs that show the board, and those that do not.

    Attributes
    ----------
    image_size : (int, int)
    views : tuple of BoardView
    without : Mapping of file to the reason
    """

    image_size: tuple[int, int]
    views: tuple[BoardView, ...]
    without: dict[Path, str]


def photo_files(folder: Path) -> list[Path]:
    """The photographs of a folder, by name.

    Raises
    ------
    CalibrationError
        If there is none, or more than MOST_PHOTOS.
    """
    if not folder.is_dir():
        raise CalibrationError(f"{folder}: no such folder, expected one of photographs")
    files = sorted(file for file in folder.iterdir() if file.suffix.lower() in SUFFIXES)
    if not 0 < len(files) <= MOST_PHOTOS:
        raise CalibrationError(
            f"{folder}: {len(files)} photographs ({', '.join(SUFFIXES)}), expected 1 to "
            f"{MOST_PHOTOS}"
        )
    return files


def find_boards(
    files: Sequence[Path], board: Chessboard, *, show_progress: bool = False
) -> BoardViews:
    """Find the board in photographs of one camera.

    Raises
    ------
    CalibrationError
        If photographs differ in size, or none can be read.
    """
    views, without, sizes = [], {}, {}
    bar: Iterable[Path] = tqdm(
        files, "photographs", unit="photo", disable=None if show_progress else True
    )
    for file in bar:
        try:
            image = to_grey(read_image(file))
        except ImageError as error:
            without[file] = str(error)
            continue
        sizes[file] = image.shape[::-1]
        corners = board_corners(image, board)
        if corners is None:
            without[file] = _other_count(image, board)
        else:
            views.append(BoardView(file, corners))
    if not sizes:
        raise CalibrationError("none of the photographs can be read")
    (first, size), *others = sizes.items()
    for file, other in others:
        if other != size:
            raise CalibrationError(
                "{}: {} x {} pixels, {} has {} x {}; expected photographs of one camera".format(
                    file, *other, first, *size
                )
            )
    return BoardViews(size, tuple(views), without)


def board_corners(image: ByteImage, board: Chessboard) -> FloatArray | None:
    """Inner corners (N, 2) of the board in a grey image (H, W); None where there is none."""
    size = (board.columns, board.rows)
    flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_FAST_CHECK
    found, corners = cv2.findChessboardCorners(image, size, flags=flags)
    if not found:  # the other search finds more boards, but places them worse where lenses bend
        found, corners = cv2.findChessboardCornersSB(
            image, size, flags=cv2.CALIB_CB_NORMALIZE_IMAGE
        )
    if not found:
        return None
    grid = corners.reshape(board.rows, board.columns, 2)
    nearest_px = min(float(np.linalg.norm(np.diff(grid, axis=a), axis=-1).min()) for a in (0, 1))
    half = max(2, int(WINDOW_SHARE * nearest_px))
    stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-3)
    start = np.asarray(corners, dtype=np.float32)
    refined = cv2.cornerSubPix(image, start, (half, half), (-1, -1), stop)
    return np.asarray(refined, dtype=np.float64).reshape(-1, 2)


def _other_count(image: ByteImage, board: Chessboard) -> str:
    """Whether the squares were counted instead of the corners between them."""
    if min(board.columns, board.rows) > 3:
        inner = Chessboard(board.columns - 1, board.rows - 1, board.square_m)
        if board_corners(image, inner) is not None:
            return (
                f"no board of {board.columns} x {board.rows} inner corners, but one of "
                f"{inner.columns} x {inner.rows}: count the corners between squares, not the "
                "squares"
            )
    return f"no board of {board.columns} x {board.rows} inner corners was found whole"
