"""Matrix and distortion from views of a chessboard (Zhang 2000, as OpenCV implements it)."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import BoolArray, FloatArray
from terrain.calibration.chessboard import BoardViews, Chessboard
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError

FEWEST_VIEWS, ENOUGH_VIEWS = 5, 12
ALIKE_PX = 0.02  # of the image's diagonal: views nearer to each other than this are one
TILT_DEG, GOOD_TILT_DEG = 15.0, 30.0  # between the boards of two views
CELLS = 3  # the image is cut into as many columns and rows
FEWEST_CELLS = 5  # of nine, in which corners were found
ROWS, COLUMNS = ("top", "middle", "bottom"), ("left", "centre", "right")


def require_variety(seen: BoardViews) -> None:
    """Raise CalibrationError where images are too few, too similar or in one part of the image."""
    found, without = len(seen.views), len(seen.without)
    reason = f"; {without} without: {next(iter(seen.without.values()))}" if without else ""
    advice = "; ".join(what_next(seen, 0.0))
    different = _different(seen)
    if different < FEWEST_VIEWS:
        repeated = f", {different} of them different" if different < found else ""
        raise CalibrationError(
            f"{found} photographs show the board{repeated}, expected at least {FEWEST_VIEWS} that "
            f"differ{reason}. Next: {advice}"
        )
    if np.count_nonzero(_cells(seen)) < FEWEST_CELLS:
        raise CalibrationError(
            f"corners were found in {np.count_nonzero(_cells(seen))} of 9 parts of the image, "
            f"expected {FEWEST_CELLS}: the distortion cannot be determined. Next: {advice}"
        )


def require_tilt(seen: BoardViews, tilt_deg: float) -> None:
    """Raise CalibrationError where boards are so nearly parallel that the focal length is open."""
    if tilt_deg < TILT_DEG:
        raise CalibrationError(
            f"the boards are nearly parallel in all {len(seen.views)} photographs "
            f"({tilt_deg:.0f} degrees), which leaves the focal length open. Next: "
            f"{'; '.join(what_next(seen, tilt_deg))}"
        )


def largest_tilt_deg(rotations: FloatArray) -> float:
    """The largest angle between boards of rotation matrices (V, 3, 3)."""
    normals = rotations[:, :, 2]
    return float(np.degrees(np.arccos(np.clip((normals @ normals.T).min(), -1, 1))))


def what_next(seen: BoardViews, tilt_deg: float) -> tuple[str, ...]:
    """What photographs would make the calibration better; nothing where they suffice.

    Parameters
    ----------
    seen : BoardViews
    tilt_deg : float
        The largest angle between boards; 0 where it is not known.
    """
    advice = []
    cells = _cells(seen)
    empty = [f"{ROWS[row]} {COLUMNS[column]}" for row, column in np.argwhere(~cells) if seen.views]
    if empty:
        advice.append(f"photograph the board in these parts of the image: {', '.join(empty)}")
    if tilt_deg < GOOD_TILT_DEG:
        advice.append("tilt the board by 30 to 45 degrees to the left, right, towards and away")
    missing = ENOUGH_VIEWS - _different(seen)
    if missing > 0:
        advice.append(f"take {missing} more from other places, the whole board in the image")
    return tuple(advice)


def _cells(seen: BoardViews) -> BoolArray:
    """In which parts (rows, columns) of the image a corner was found."""
    cells = np.zeros((CELLS, CELLS), dtype=bool)
    for view in seen.views:
        column, row = np.floor(CELLS * view.corners_px / np.array(seen.image_size)).astype(int).T
        cells[np.clip(row, 0, CELLS - 1), np.clip(column, 0, CELLS - 1)] = True
    return cells


def _different(seen: BoardViews) -> int:
    """How many views are not nearly one that came before; a board may be found turned about."""
    apart_px = ALIKE_PX * float(np.hypot(*seen.image_size))
    kept: list[FloatArray] = []
    for view in seen.views:
        near = (
            min(np.abs(view.corners_px - one).max(), np.abs(view.corners_px[::-1] - one).max())
            for one in kept
        )
        if all(distance > apart_px for distance in near):
            kept.append(view.corners_px)
    return len(kept)


WIDEST_FOCUS = 0.02  # of a focal length, half of its 95 % interval
WORST_RMS_PX = 2.0
SURE_SIGMAS = 1.96
CORNER_PX = 0.05  # corners are no better than this, whatever few views say


@dataclass(frozen=True, eq=False)
class LensFit:
    """A lens, and how well the photographs determine it.

    Attributes
    ----------
    lens : Lens
    half_interval : (4,)
        Half of the 95 % intervals of fx, fy, cx, cy [px].
    photo_rms_px : (V,)
        Root mean square of the reprojection errors of each photograph, in the order of its views.
    rms_px : float
        Of all.
    distances_m : (V,)
        From the camera to the middle of the board.
    next_photos : tuple of str
        What would make it better.
    """

    lens: Lens
    half_interval: FloatArray
    photo_rms_px: FloatArray
    rms_px: float
    distances_m: FloatArray
    next_photos: tuple[str, ...]


def lens_from_boards(seen: BoardViews, board: Chessboard) -> LensFit:
    """Calibrate matrix and the five coefficients k1, k2, p1, p2, k3.

    Raises
    ------
    CalibrationError
        If the images are too few or too similar, or do not determine the focal length; the message
        says photograph next.
    """
    require_variety(seen)
    corners_m = board.corners_m.astype(np.float32)
    pixels = [view.corners_px.astype(np.float32).reshape(-1, 1, 2) for view in seen.views]
    _, matrix, distortion, turns, shifts, sigmas, _, per_photo = cv2.calibrateCameraExtended(
        [corners_m] * len(pixels), pixels, seen.image_size, np.eye(3), np.zeros(5)
    )
    photo_rms_px = np.asarray(per_photo, dtype=np.float64).ravel()
    rms_px = float(np.sqrt(np.mean(photo_rms_px**2)))
    # OpenCV's deviations are those of errors as large as were left
    half = SURE_SIGMAS * np.asarray(sigmas, dtype=np.float64).ravel()[:4]
    half *= max(1.0, CORNER_PX / max(rms_px, 1e-9))
    tilt_deg = largest_tilt_deg(np.stack([cv2.Rodrigues(turn)[0] for turn in turns]))
    _check(np.asarray(matrix, dtype=np.float64), half, rms_px, seen, tilt_deg)
    middle_m = board.corners_m.mean(axis=0)
    distances_m = [
        float(np.linalg.norm(cv2.Rodrigues(turn)[0] @ middle_m + np.ravel(shift)))
        for turn, shift in zip(turns, shifts, strict=True)
    ]
    return LensFit(
        Lens.of(seen.image_size, matrix, np.asarray(distortion, dtype=np.float64).ravel()[:5]),
        half,
        photo_rms_px,
        rms_px,
        np.array(distances_m),
        what_next(seen, tilt_deg),
    )


def _check(
    matrix: FloatArray, half: FloatArray, rms_px: float, seen: BoardViews, tilt_deg: float
) -> None:
    focus = matrix[[0, 1], [0, 1]]
    if not rms_px <= WORST_RMS_PX:
        raise CalibrationError(
            f"the reprojection error is {rms_px:.2g} px, expected less than {WORST_RMS_PX:g}: is "
            "the board flat, are the photographs sharp, of one camera and of one zoom and focus?"
        )
    require_tilt(seen, tilt_deg)
    if not (half[:2] <= WIDEST_FOCUS * focus).all():
        advice = what_next(seen, tilt_deg) or ("photograph the board nearer and more tilted",)
        raise CalibrationError(
            f"the photographs do not determine the focal length: {focus[0]:.0f} px, give or take "
            f"{half[0]:.0f}. Next: {'; '.join(advice)}"
        )
