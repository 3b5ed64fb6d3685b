"""The digits that an uncertainty allows."""

import pytest

from odometry.digits import three_figures, within_interval, within_sigma


@pytest.mark.parametrize(
    ("value", "low", "high", "expected"),
    [
        (0.66827, 0.61, 0.73, ("0.668", "0.610", "0.730")),
        (0.66827, 0.1, 1.3, ("0.67", "0.10", "1.30")),
        (67.64, 40.0, 90.0, ("68", "40", "90")),
        (0.66827, 0.66827, 0.66827, ("0.668", "0.668", "0.668")),
        (1.0, float("-inf"), float("inf"), ("1", "-inf", "inf")),
    ],
)
def test_digits_are_those_that_the_interval_allows(value, low, high, expected):
    assert within_interval(value, low, high) == expected


@pytest.mark.parametrize(
    ("value", "sigma", "expected"),
    [
        (0.91413, 0.0182, ("0.914", "0.018")),
        (-0.0268, 0.0917, ("-0.027", "0.092")),
        (1.7812, 0.0601, ("1.781", "0.060")),
        (412.3, 25.0, ("412", "25")),
        (0.4, 0.0, ("0.4", "0")),
    ],
)
def test_digits_are_those_that_the_standard_deviation_allows(value, sigma, expected):
    assert within_sigma(value, sigma) == expected


@pytest.mark.parametrize(
    ("value", "expected"),
    [(0.025, "0.0250"), (0.02491, "0.0249"), (1.0, "1.00"), (123.4, "123"), (0.0, "0.00")],
)
def test_figures_of_a_column_end_alike(value, expected):
    assert three_figures(value) == expected
