"""What the treads of a run did up to any moment, each speed held until the next stamp."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.run import Run


@dataclass(frozen=True)
class TreadTravel:
    """Integrals over the tread speeds of a run, up to each of N stamps.

    Attributes
    ----------
    stamps_s : (N,)
    integrals_m : (N, 4)
        Of the speed (v_left + v_right) / 2, of the difference v_right - v_left, of the size of
        this difference, and of |v_left| + |v_right|.
    """

    stamps_s: FloatArray
    integrals_m: FloatArray

    def between(self, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
        """Integrals (4, K) from stamps (K,) to others; treads stand outside of the N stamps."""
        return np.stack(
            [
                np.interp(end_s, self.stamps_s, column) - np.interp(begin_s, self.stamps_s, column)
                for column in self.integrals_m.T
            ]
        )


def tread_travel(run: Run) -> TreadTravel:
    """Integrate the tread speeds of a run."""
    left, right = run.odometry.stack("v_left", "v_right").T
    rates = np.column_stack(
        [(left + right) / 2, right - left, np.abs(right - left), np.abs(left) + np.abs(right)]
    )
    stamps_s = run.odometry.stamps_s
    steps_m = rates[:-1] * np.diff(stamps_s)[:, None]
    return TreadTravel(stamps_s, np.concatenate([np.zeros((1, 4)), np.cumsum(steps_m, axis=0)]))
