"""Compressed parts of bags, as far as they can be had where they are cut or damaged."""

import bz2
import sys
import zlib
from importlib import import_module
from typing import Any, Protocol

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
