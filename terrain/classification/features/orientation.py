"""Directions of gradients as bytes: those of `np.arctan2`, in a fraction of its time."""

from functools import cache

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage

HALF_TURN = np.float32(np.pi)
BYTES_A_RADIAN = 255 / np.pi
MARGIN, CLOSE = 0.03, 0.02  # of a byte, 0.7 degrees; OpenCV's angles are off by 0.014
DIRECTIONS = 4096


def half_turn_bytes(across: AnyArray, down: AnyArray) -> ByteImage:
    """Directions modulo half a turn, 255 bytes to half a turn, rounded.

    Nearly all bytes are certain from OpenCV's approximate angle; where it comes near the edge of
    a byte, or there is no gradient, the angle is computed exactly.

    Parameters
    ----------
    across, down : (rows, columns) array of float32
    """
    if not approximate_is_close():
        return _exact(across, down)
    levels = _levels(across, down)
    nearest = np.rint(levels)
    numbers = nearest.astype(np.int16)
    numbers += numbers > 255  # as a byte n + 1 is n - 255: the second half of the turn
    result = numbers.astype(np.uint8)
    levels -= nearest
    unsure = np.abs(levels, out=levels) > 0.5 - MARGIN
    unsure |= (result == 0) | (result == 255)  # there the sign alone distinguishes half a turn
    near_edges = np.flatnonzero(unsure)
    result.ravel()[near_edges] = _exact(across.ravel()[near_edges], down.ravel()[near_edges])
    return result


@cache
def approximate_is_close() -> bool:
    """Whether OpenCV's angles are as close here as was found elsewhere, on directions all round."""
    angles = (np.arange(DIRECTIONS) + 0.5) * (2 * np.pi / DIRECTIONS)
    across, down = np.cos(angles).astype(np.float32), np.sin(angles).astype(np.float32)
    off = np.abs(_levels(across[None], down[None]) - angles * BYTES_A_RADIAN)
    return bool(off.max() < CLOSE)


def _levels(across: AnyArray, down: AnyArray) -> AnyArray:
    """Directions in bytes, 0 to 510, nearly."""
    levels: AnyArray = cv2.phase(across, down)
    levels *= BYTES_A_RADIAN
    return levels


def _exact(across: AnyArray, down: AnyArray) -> ByteImage:
    angle: AnyArray = np.arctan2(down, across)
    angle[angle == HALF_TURN] = 0.0
    angle += HALF_TURN * (angle < 0)  # modulo half a turn
    return np.clip(np.rint(angle * BYTES_A_RADIAN), 0, 255).astype(np.uint8)
