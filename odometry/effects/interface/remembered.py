"""Answers that an effect gave to the same numbers before."""

from collections.abc import Callable, Sequence

import numpy as np

from odometry.arrays import FloatArray

MOST = 64  # answers


class Remembered:
    """The latest answers of one effect: beside others it is asked the same again."""

    def __init__(self) -> None:
        self._answers: dict[bytes, FloatArray] = {}

    def to(self, asked: Sequence[FloatArray], answer: Callable[[], FloatArray]) -> FloatArray:
        """What was answered to the same arrays, or the answer now."""
        key = b"".join(np.ascontiguousarray(of).tobytes() for of in asked)
        if key not in self._answers:
            while len(self._answers) >= MOST:
                self._answers.pop(next(iter(self._answers)))
            self._answers[key] = answer()
        return self._answers[key]
