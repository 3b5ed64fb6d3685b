"""Which parameters, alone or together, the windows do not determine."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray

SHOWN = 0.3  # a parameter is named if it has this share of a direction


@dataclass(frozen=True)
class Undetermined:
    """A combination of parameters that the windows do not determine.

    Attributes
    ----------
    direction : Mapping of name to share
        Of each parameter in units of its ordinary size; the squares of all add up to 1.
    deviation : float
        Standard deviation along it, in those units; infinite where nothing depends on it.
    """

    direction: dict[str, float]
    deviation: float

    def words(self) -> str:
        """The combination and its deviation in a sentence."""
        terms = [f"{share:+.2f} {name}" for name, share in self.direction.items()]
        subject = " ".join(terms) if len(terms) > 1 else next(iter(self.direction))
        if not np.isfinite(self.deviation):
            return f"{subject}: the predicted motion does not depend on it"
        return f"{subject}: standard deviation {self.deviation:.2g} of its ordinary size"


def undetermined(
    whitened_jacobian: FloatArray,
    names: tuple[str, ...],
    sizes: FloatArray,
    scale: float,
    largest: float,
) -> tuple[Undetermined, ...]:
    """Directions along which the standard deviation is above `largest` ordinary sizes.

    Parameters
    ----------
    whitened_jacobian : (3K, F)
        Residuals of unit variance by the free parameters.
    names : F of str
    sizes : (F,)
    scale : float
        How many times larger the residuals are than stated.
    largest : float
    """
    if not names:
        return ()
    _, singular, directions = np.linalg.svd(whitened_jacobian * sizes, full_matrices=False)
    found = []
    for value, direction in zip(singular, directions, strict=True):
        nothing = value <= 1e-9 * max(singular[0], 1.0)
        deviation = np.inf if nothing else scale / value
        if deviation > largest:
            signed = direction * np.sign(direction[np.argmax(np.abs(direction))])
            shares = {n: float(s) for n, s in zip(names, signed, strict=True) if abs(s) >= SHOWN}
            found.append(Undetermined(shares, float(deviation)))
    return tuple(found)
