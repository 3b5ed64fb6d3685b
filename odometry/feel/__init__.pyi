from .files import write_feel
from .follow import FeelConfig, Felt
from .words import sentences

__all__ = ["FeelConfig", "Felt", "sentences", "write_feel"]
