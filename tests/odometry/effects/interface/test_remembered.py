"""Answers that are kept: which, and how many."""

import numpy as np
import pytest

from odometry.effects.interface.remembered import MOST, MOST_BYTES, Remembered


def test_the_same_arrays_have_the_answer_of_before():
    remembered, answers = Remembered(), iter(range(9))

    def asked(*arrays):
        return remembered.to(arrays, lambda: np.array([float(next(answers))]))[0]

    table = np.arange(12.0).reshape(3, 4)
    assert [asked(table), asked(table), asked(table[:, ::2]), asked(table + 1e-15)] == [0, 0, 1, 2]
    assert asked(np.empty(0), table) == asked(table) == 0


@pytest.mark.parametrize(("size", "kept"), [(1, MOST), (MOST_BYTES // 8 // 3, 3), (MOST_BYTES, 1)])
def test_large_answers_are_kept_by_their_bytes(size, kept):
    remembered, computed = Remembered(), []

    def ask(number):
        def answer():
            computed.append(number)
            return np.zeros(size)

        remembered.to([np.array([float(number)])], answer)

    for number in [*range(kept + 1), *range(1, kept + 1), 0]:
        ask(number)
    assert computed == [*range(kept + 1), 0]
