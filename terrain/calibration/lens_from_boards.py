"""Matrix and distortion from views of a chessboard (Zhang 2000, as OpenCV implements it)."""

from dataclasses import dataclass

import cv2
import numpy as np

from odometry.arrays import FloatArray
from terrain.calibration.board_variety import (
    largest_tilt_deg,
    require_tilt,
    require_variety,
    what_next,
)
from terrain.calibration.chessboard import BoardViews, Chessboard
from terrain.camera_files.calibration import Lens
from terrain.errors import CalibrationError

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
