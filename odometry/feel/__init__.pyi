from .labels.felt import FeelConfig
from .labels.files import sentences, write_feel
from .labels.follow import Felt

__all__ = ["FeelConfig", "Felt", "sentences", "write_feel"]
