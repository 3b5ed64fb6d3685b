"""Every shipped parameter set against the numbers that its paper prints.

The numbers are typed from the papers in the papers' own symbols; the conversions are those of the
table in data/README.md: with Y forward and X right, y_left = -x_ICR^l, y_right = -x_ICR^r,
x_icr = y_ICR, and (x_cm, y_cm) = (y_CM, -x_CM).
"""

from pathlib import Path

import pytest

from odometry.parameters import read_parameters

FOLDER = Path(__file__).parents[2] / "data" / "parameters"
GAMMAS = ("gamma_11", "gamma_12", "gamma_21", "gamma_22", "gamma_31", "gamma_32")


def baril_asymmetric(alpha_l, alpha_r, x_v, y_l, y_r):
    """Baril 2020, Table I, "Extended DD Asymmetric": the frame is ours, x_v is our x_icr."""
    return {
        "y_left": y_l,
        "y_right": y_r,
        "x_icr": x_v,
        "alpha_left": alpha_l,
        "alpha_right": alpha_r,
    }


def baril_roc(alpha, beta_1, beta_2):
    """Baril 2020, Table I, "ROC with b = 1.2 m"."""
    return {"alpha": alpha, "beta_1": beta_1, "beta_2": beta_2, "track_width": 1.2}


def martinez_icrs(x_icr_l, x_icr_r, y_icr):
    return {"y_left": -x_icr_l, "y_right": -x_icr_r, "x_icr": y_icr}


PRINTED = {
    "warthog_icr_symmetric": (
        "icr_symmetric",
        {
            "concrete": {"alpha": 0.94, "b_hat": 4.46},
            "snow": {"alpha": 0.86, "b_hat": 3.08},
        },
    ),
    "warthog_icr": (
        "icr",
        {
            "concrete": baril_asymmetric(0.90, 0.92, -2.57, 4.66, -5.00),
            "snow": baril_asymmetric(0.81, 0.84, -2.71, 3.00, -3.85),
        },
    ),
    "warthog_radius_of_curvature": (
        "radius_of_curvature",
        {"concrete": baril_roc(0.91, 42.73, 11.09), "snow": baril_roc(0.80, 1.36, -0.18)},
    ),
    "warthog_full_linear": (
        "full_linear",
        {
            "concrete": dict(zip(GAMMAS, (0.47, 0.44, -0.22, 0.26, -0.10, 0.08), strict=True)),
            "snow": dict(zip(GAMMAS, (0.46, 0.36, -0.31, 0.34, -0.13, 0.12), strict=True)),
        },
    ),
    # Martinez 2024, Table I; v_y^m, x_m and y_m in section IV.
    "j8": (
        "icr_slope",
        {
            "smooth_concrete": {
                **martinez_icrs(-0.980, 1.073, 0.206),
                "alpha_left": 1.004,
                "alpha_right": 1.011,
                "lambda_1": 1.222,
                "lambda_2": 4.965,
                "v_max": 1.0,
                "half_width": 0.6,
                "half_length": 1.06,
            }
        },
    ),
    # Martinez 2024, section III-A; v_y^m in section II-B.
    "lazaro": (
        "icr_slope",
        {
            "melamine": {
                **martinez_icrs(-0.44, 0.42, 0.03),
                "lambda_1": 4.68,
                "lambda_2": 6.54,
                "v_max": 0.28,
                "half_width": 0.2,
                "half_length": 0.2,
            }
        },
    ),
    # Martinez 2017, section II, below eq. 3.
    "auriga_alpha_icr": ("icr", {"hard_ground": martinez_icrs(-0.458, 0.630, 0.0482)}),
    # Martinez 2017: Table I, eq. 13, and below eq. 25, 26 and 27.
    "auriga_alpha": (
        "icr_inertia",
        {
            "hard_ground": {
                "zeta_0": 0.048,
                "zeta_1": 0.0002424,
                "epsilon_0": 0.106,
                "epsilon_1": 0.0011,
                "eta_0": 2.62,
                "eta_1": 0.0019,
                "eta_2": 0.00001,
                "h": 0.67134,
                "mass": 258.0,
                "x_cm": 0.04,
                "y_cm": 0.015,
                "track_width": 0.42,
            }
        },
    ),
}


def test_every_shipped_set_is_known_here():
    assert sorted(file.stem for file in FOLDER.glob("*.toml")) == sorted(PRINTED)


@pytest.mark.parametrize("name", PRINTED)
def test_numbers_are_those_of_the_paper(name):
    model, terrains = PRINTED[name]
    shipped = read_parameters(FOLDER / f"{name}.toml")
    assert {terrain: dict(table.values) for terrain, table in shipped.terrains.items()} == terrains
    assert {table.model for table in shipped.terrains.values()} == {model}
    assert all(table.source for table in shipped.terrains.values())
    assert shipped.vehicle["name"]
