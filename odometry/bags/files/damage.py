"""Cut and damaged bags: what is left of compressed parts, searching on, sentences of losses."""

import bz2
import sys
import zlib
from collections.abc import Iterable, Iterator
from importlib import import_module
from typing import Any, BinaryIO, Protocol

MOST_LINES = 30


class Losses:
    """Sentences in their order; a badly damaged bag has thousands, of which the first are kept."""

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self._lines: list[str] = []
        self._more = 0
        self += lines

    def append(self, line: str) -> None:
        """Add a sentence."""
        if len(self._lines) < MOST_LINES:
            self._lines.append(line)
        else:
            self._more += 1

    def __iadd__(self, lines: Iterable[str]) -> "Losses":
        for line in lines:
            self.append(line)
        return self

    @property
    def lines(self) -> tuple[str, ...]:
        """The sentences that are kept, and how many more there were."""
        more = (f"and {self._more} more losses of such kinds",) if self._more else ()
        return (*self._lines, *more)


ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
PIECE = 65536  # bytes at a time: what comes before a damaged piece is kept


class _Decompressor(Protocol):
    @property
    def eof(self) -> bool: ...

    def decompress(self, data: bytes) -> bytes: ...


def decompressed(data: bytes, compression: str) -> tuple[bytes, str]:
    """Content of compressed bytes, and what is wrong with the rest (empty where nothing is)."""
    if compression in ("", "none"):
        return data, ""
    decompressor = _decompressor(compression)
    if decompressor is None:
        return b"", f"its compression {compression!r} is not known"
    parts = []
    try:
        for begin in range(0, len(data), PIECE):
            parts.append(decompressor.decompress(data[begin : begin + PIECE]))
            if decompressor.eof:
                return b"".join(parts), ""
    except (OSError, RuntimeError, EOFError, ValueError, zlib.error) as problem:
        return b"".join(parts), f"it cannot be decompressed: {problem}"
    except Exception as problem:  # zstd's own error has no base but Exception
        if type(problem).__name__ != "ZstdError":
            raise
        return b"".join(parts), f"it cannot be decompressed: {problem}"
    return b"".join(parts), "its end is missing"


def _decompressor(compression: str) -> _Decompressor | None:
    if compression == "bz2":
        return bz2.BZ2Decompressor()
    if compression == "lz4":
        lz4: _Decompressor = import_module("lz4.frame").LZ4FrameDecompressor()
        return lz4
    if compression == "zstd":
        zstd: _Decompressor = zstd_package().ZstdDecompressor()
        return zstd
    return None


def zstd_package() -> Any:
    """Python's own zstd, or its backport; imported only where a bag is compressed."""
    return import_module("compression.zstd" if sys.version_info >= (3, 14) else "backports.zstd")


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
