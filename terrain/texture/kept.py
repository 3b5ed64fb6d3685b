"""Arrays that a thread keeps from image to image: fresh pages cost more than what is done there."""

import threading
from math import prod

import numpy as np

from odometry.arrays import ByteImage

_OF_THREAD = threading.local()


def kept(use: str, shape: tuple[int, ...]) -> ByteImage:
    """Bytes of any content for one use; the next call with this use gets the same ones.

    Parameters
    ----------
    use : str
        What the thread has one of.
    shape : tuple of int
    """
    size = prod(shape)
    buffer: ByteImage | None = getattr(_OF_THREAD, use, None)
    if buffer is None or buffer.size < size:
        buffer = np.empty(size, np.uint8)
        setattr(_OF_THREAD, use, buffer)
    return buffer[:size].reshape(shape)
