"""Borders of the regions of up to eight binary images at once, of many planes at once."""

import threading
from math import prod

import numpy as np

from odometry.arrays import ByteImage

INSIDE = 255  # all eight bits

MOST_SHAPES = 256  # views of kept bytes that are remembered; then all begin anew


class _Kept(threading.local):
    """Bytes by use, and views of them by use and shape, of one thread."""

    def __init__(self) -> None:
        self.buffers: dict[str, ByteImage] = {}
        self.views: dict[tuple[str, tuple[int, ...]], ByteImage] = {}


_KEPT = _Kept()


def region_borders(bits: ByteImage) -> ByteImage:
    """Keep the pixels that have a zero among their eight neighbours (eq. 21).

    Parameters
    ----------
    bits : (H, W) or (N, H, W) array of uint8
        One binary image in each bit.

    Returns
    -------
    array of uint8 of the same shape
        One border image in each bit. What lies outside the image counts as one, so the edge of
        the image is not a border.

    References
    ----------
    Chen et al. 2023, eq. 21.
    """
    planes = bits.reshape(-1, *bits.shape[-2:])
    padded = framed(len(planes), *bits.shape[-2:])
    padded[:, 1:-1, 1:-1] = planes
    return framed_borders(padded).copy().reshape(bits.shape)


def framed(planes: int, rows: int, columns: int) -> ByteImage:
    """Planes with a frame of ones round a middle (N, H, W) that is to be filled; kept."""
    padded = kept("framed", (planes, rows + 2, columns + 2))
    padded[:, 0] = padded[:, -1] = INSIDE
    padded[:, :, 0] = padded[:, :, -1] = INSIDE
    return padded


def framed_borders(padded: ByteImage) -> ByteImage:
    """Borders (N, H, W) of the middle of planes (N, H + 2, W + 2); a view of what is kept.

    The planes are one long row whose neighbours are found by shifting it: what then mixes two
    rows or planes lies in the frame.
    """
    flat, width = padded.ravel(), padded.shape[2]
    across = kept("across", (flat.size - 2,))
    np.bitwise_and(flat[:-2], flat[1:-1], out=across)
    across &= flat[2:]
    borders = kept("borders", padded.shape)
    inside = borders.reshape(-1)[: flat.size - 2 * width - 2]
    np.bitwise_and(across[: -2 * width], across[width:-width], out=inside)
    inside &= across[2 * width :]
    inside ^= flat[width + 1 : -width - 1]  # inside is a part of bits: what is left is its border
    return borders[:, :-2, :-2]


def kept(use: str, shape: tuple[int, ...]) -> ByteImage:
    """Bytes of any content for one use; the next call with this use gets the same ones.

    Parameters
    ----------
    use : str
        What the thread has one of.
    shape : tuple of int
    """
    view = _KEPT.views.get((use, shape))
    return _new_view(use, shape) if view is None else view


def _new_view(use: str, shape: tuple[int, ...]) -> ByteImage:
    size = prod(shape)
    buffer = _KEPT.buffers.get(use)
    if buffer is None or buffer.size < size:
        buffer = _KEPT.buffers[use] = np.empty(size, np.uint8)
        _KEPT.views.clear()  # those of the smaller buffer would keep it
    if len(_KEPT.views) >= MOST_SHAPES:
        _KEPT.views.clear()
    view = _KEPT.views[use, shape] = buffer[:size].reshape(shape)
    return view
