from .felt import FeelConfig
from .files import sentences, write_feel
from .follow import Felt

__all__ = ["FeelConfig", "Felt", "sentences", "write_feel"]
