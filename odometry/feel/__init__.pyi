from .files import sentences, write_feel
from .follow import FeelConfig, Felt

__all__ = ["FeelConfig", "Felt", "sentences", "write_feel"]
