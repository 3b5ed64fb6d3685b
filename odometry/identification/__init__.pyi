from .fitters import fitter

__all__ = [
    "fitter",
]
