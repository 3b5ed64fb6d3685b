"""Changes of mode as a Markov chain in continuous time, given by mean dwell times."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.linalg import expm

from odometry.arrays import FloatArray
from odometry.errors import EstimationError

STEP_RESOLUTION_S = 1e-6  # steps are rounded to it, so that uneven stamps share their matrices
SUM_TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class ModeChain:
    """A Markov chain that stays in mode i for `dwell_s[i]` on average.

    Attributes
    ----------
    dwell_s : (M,)
        Mean time in each mode [s]; infinite where the mode is never left.
    shares : (M, M) or None
        shares[i, j] of the departures from i go to j: zero on the diagonal, rows sum to 1.
        None shares them evenly.

    Raises
    ------
    EstimationError
        If a dwell time is not above zero, or the shares do not fit.
    """

    dwell_s: FloatArray
    shares: FloatArray | None = None
    _rates: bytes = field(init=False, repr=False)

    def __post_init__(self) -> None:
        dwell_s = np.asarray(self.dwell_s, dtype=np.float64)
        if dwell_s.ndim != 1 or not len(dwell_s):
            raise EstimationError(f"dwell times of shape {dwell_s.shape}, expected (modes,)")
        for mode, dwell in enumerate(dwell_s):
            if not dwell > 0:
                raise EstimationError(f"mode {mode}: dwell time {dwell} s, expected above 0")
        shares = _even_shares(len(dwell_s)) if self.shares is None else self._checked_shares()
        rates = (shares - np.eye(len(dwell_s))) / dwell_s[:, None]
        object.__setattr__(self, "_rates", (rates if len(dwell_s) > 1 else 0 * rates).tobytes())

    @property
    def modes(self) -> int:
        """The number M of modes."""
        return len(self.dwell_s)

    @property
    def rates(self) -> FloatArray:
        """The generator (M, M) [1/s]: rate from i to j, rows sum to 0."""
        return np.frombuffer(self._rates).reshape(self.modes, self.modes)

    def transition(self, step_s: float) -> FloatArray:
        """Probability (M, M) of being in j a step after i: exp(rates step), rows sum to 1.

        The step is rounded to a microsecond. The matrix is shared and cannot be written to.

        Raises
        ------
        EstimationError
            If the step is negative or not finite.
        """
        if not 0 <= step_s < np.inf:
            raise EstimationError(f"a step of {step_s} s, expected 0 or more")
        return _transition(self._rates, self.modes, round(step_s / STEP_RESOLUTION_S))

    def _checked_shares(self) -> FloatArray:
        shares = np.asarray(self.shares, dtype=np.float64)
        if shares.shape != (self.modes, self.modes):
            raise EstimationError(
                f"shares of shape {shares.shape}, expected ({self.modes}, {self.modes})"
            )
        for mode, row in enumerate(shares):
            expected = float(self.modes > 1)
            if not (np.all(row >= 0) and abs(row.sum() - expected) < SUM_TOLERANCE):
                raise EstimationError(
                    f"mode {mode}: shares {row.tolist()}, expected none negative, sum {expected:g}"
                )
            if row[mode]:
                raise EstimationError(f"mode {mode}: share {row[mode]} of itself, expected 0")
        return shares


def _even_shares(modes: int) -> FloatArray:
    return (1 - np.eye(modes)) / max(modes - 1, 1)


@lru_cache(maxsize=4096)
def _transition(rates: bytes, modes: int, steps: int) -> FloatArray:
    generator = np.frombuffer(rates).reshape(modes, modes)
    matrix: FloatArray = np.maximum(expm(generator * (steps * STEP_RESOLUTION_S)), 0.0)
    matrix /= matrix.sum(axis=1, keepdims=True)
    matrix.flags.writeable = False
    return matrix
