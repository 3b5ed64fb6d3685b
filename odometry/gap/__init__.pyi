from .files import write_gap
from .words import sentences

__all__ = [
    "sentences",
    "write_gap",
]
