"""Whether images of a chessboard determine a lens, and what to photograph next."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from terrain.calibration.chessboard import BoardViews
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
        alike = f", {different} of them different" if different < found else ""
        raise CalibrationError(
            f"{found} photographs show the board{alike}, expected at least {FEWEST_VIEWS} that "
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
