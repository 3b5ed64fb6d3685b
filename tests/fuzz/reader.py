"""One reader of the project under fuzzing."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Reader:
    """A valid content of a file, how to make it wrong, and what reads and uses it."""

    name: str
    file: Path
    valid: bytes
    changed: Callable[[bytes, np.random.Generator], bytes]
    read: Callable[[], object]


def reader_of(name, file, valid, changed, read):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(valid)
    return Reader(name, file, valid, changed, read)
