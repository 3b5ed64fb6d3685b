from .catalogue import added_effects
from .interface.corrected import Corrected

__all__ = [
    "Corrected",
    "added_effects",
]
