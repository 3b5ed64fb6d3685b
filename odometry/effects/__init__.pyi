from .catalogue import added_effects
from .corrected import Corrected

__all__ = [
    "Corrected",
    "added_effects",
]
