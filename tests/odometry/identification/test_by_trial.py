"""H of Martinez 2017 eq. 15, which acts through the sign of v_left + H v_right alone."""

import numpy as np
import pytest

from odometry.identification.fit import fit, try_values
from odometry.identification.problem import Problem
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig
from odometry.models.catalogue import MODELS
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances
from odometry.windows.travel.windows import windows_of

MODEL = MODELS["icr_inertia"]
PLACE = [parameter.name for parameter in MODEL.parameters].index("h")
KNOWN = ("mass", "x_cm", "y_cm", "track_width")
CONFIG = SolverConfig(starts=1, loss="squares")


def signs(run, h):
    return np.sign(run.odometry["v_left"] + h * run.odometry["v_right"])


def fit_to(run, synthetic):
    return fit(
        MODEL,
        windows_of([run], WindowConfig()),
        run.robot,
        fixed={name: synthetic.inertia[name] for name in KNOWN},
        window_config=WindowConfig(),
        solver_config=CONFIG,
    )


def test_any_value_that_gives_every_sample_its_sign_will_do(inertial, synthetic):
    """And then the other parameters come back. It has no variance, and is said to have none."""
    found = fit_to(inertial, synthetic)
    assert found.by_trial == ("h",)
    assert "h" not in found.names
    np.testing.assert_array_equal(
        signs(inertial, found.values["h"]), signs(inertial, synthetic.inertia["h"])
    )
    others = {name: value for name, value in synthetic.inertia.items() if name != "h"}
    assert {name: found.values[name] for name in others} == pytest.approx(others, rel=1e-6)


def test_where_every_value_is_another_it_is_found_to_a_few_hundredths(synthetic, tmp_path):
    """Three hundred different speeds; the values tried are 3.4 % apart."""
    run = synthetic.drive_under_inertia(tmp_path / "run", 3)
    found = fit_to(run, synthetic)
    assert found.values["h"] == pytest.approx(synthetic.inertia["h"], rel=0.035)
    assert found.values["eta_0"] == pytest.approx(synthetic.inertia["eta_0"], rel=0.01)


def test_no_value_tried_one_by_one_is_better(inertial, synthetic, stated):
    """With noise, and starting from a wrong value: all others are searched anew for each."""
    run = synthetic.noisy(inertial, np.random.default_rng(5))
    windows = windows_of([run], stated)
    values = MODEL.pack(synthetic.inertia | {"h": 2.5})
    free = np.array([not p.known and not p.in_sign for p in MODEL.parameters])
    problem = Problem(MODEL, windows, values, free, pose_variances(stated))
    sizes = MODEL.ordinary_sizes(run.robot)
    first = solve(problem, values[free], sizes[free], CONFIG)
    tried, solution = try_values(problem, first, sizes, PLACE, CONFIG)
    assert tried.values[PLACE] != 2.5
    np.testing.assert_array_equal(np.delete(tried.values, PLACE), np.delete(values, PLACE))
    for h in np.geomspace(0.25, 2.8, 10):
        other = values.copy()
        other[PLACE] = h
        one = Problem(MODEL, windows, other, free, problem.variances)
        cost = solve(one, solution.chosen, sizes[free], CONFIG).cost
        assert solution.cost <= cost * (1 + 1e-6), h
