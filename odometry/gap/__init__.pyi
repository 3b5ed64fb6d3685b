from .show.files import write_gap
from .show.words import sentences

__all__ = [
    "sentences",
    "write_gap",
]
