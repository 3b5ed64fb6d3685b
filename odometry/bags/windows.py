"""A file in windows that overlap, so that a search misses nothing at their edges."""

from collections.abc import Iterator
from typing import BinaryIO

SEARCHED = 4 * 1024**2  # bytes of a window


def windows(stream: BinaryIO, begin: int, overlap: int) -> Iterator[tuple[int, bytes]]:
    """Windows from a place in a file to its end, each with the place of its first byte.

    Each begins with the last `overlap` bytes of the one before.
    """
    stream.seek(begin)
    kept = b""
    while piece := stream.read(SEARCHED):
        window = kept + piece
        yield stream.tell() - len(window), window
        kept = window[-overlap:]
