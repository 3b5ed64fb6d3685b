import numpy as np

from odometry.models.base import vectors, zero_matrices


def test_entries_are_broadcast_and_their_samples_lie_side_by_side():
    x = np.arange(6.0).reshape(2, 3)
    made = vectors(x, np.zeros(()), x[:1])
    assert made.shape == (2, 3, 3)
    np.testing.assert_array_equal(made[..., 0], x)
    np.testing.assert_array_equal(made[..., 1], 0)
    np.testing.assert_array_equal(made[..., 2], [x[0], x[0]])
    assert made[..., 0].flags.c_contiguous
    assert vectors(np.array(1.0), np.array(2.0)).tolist() == [1.0, 2.0]


def test_matrices_are_zero_and_filled_entry_by_entry():
    made = zero_matrices((4, 2), 3, 5)
    assert made.shape == (4, 2, 3, 5)
    assert not made.any()
    assert made[..., 1, 3].flags.c_contiguous
