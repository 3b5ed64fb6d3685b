"""The lines of a report against the numbers of the fit that they state."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.digits import within_interval, within_sigma
from odometry.identification.identify import identify
from odometry.identification.report import correlations, in_short, report
from odometry.identification.start import SolverConfig
from odometry.windows.stretches.stretch_noise import UNKNOWN_NOISE


@pytest.fixture(scope="module")
def found(winding, synthetic, stated):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    options = {"window_config": stated, "solver_config": SolverConfig(starts=2)}
    return identify([run], "icr", fixed={"x_icr": 0.06}, **options).terrains["gravel"]


def cells(lines, name):
    return next(line.split() for line in lines if line.strip().startswith(name))


def test_each_variable_stands_with_its_interval_and_where_it_started(found):
    lines = report("gravel", found)
    assert lines[0] == "[gravel] icr"
    for name, of in found.fit.intervals.items():
        row = [cell for cell in cells(lines, name) if cell != "%"]
        value, sigma = found.fit.values[name], found.fit.sigmas[name]
        assert (row[1], *row[4:6]) == within_interval(value, of.low, of.high)
        assert row[2] == within_sigma(value, sigma)[1]
        share, start = float(row[3]), float(row[6])
        assert share == pytest.approx(100 * sigma / abs(value), abs=0.06)
        assert start == {"y": 0.375, "a": 1.0}[name[0]] * (-1 if name == "y_right" else 1)
    assert cells(lines, "x_icr") == ["x_icr", "0.06", "given", "m"]


def test_a_wide_deviation_is_stated_as_a_share_of_the_value(found):
    fit = replace(found.fit, covariance=1000 * found.fit.covariance)
    lines = report("gravel", replace(found, fit=fit))
    shares = {n: 100 * s / abs(fit.values[n]) for n, s in fit.sigmas.items()}
    name = max(shares, key=lambda one: shares[one])
    assert shares[name] > 20  # so that one in a hundred of it shows in its first decimal
    assert cells(lines, name)[3:5] == [f"{shares[name]:.1f}", "%"]


def test_statistics_are_those_of_the_fit(found):
    lines = report("gravel", found)
    assert cells(lines, "data  ")[1] == str(len(found.fit.windows))
    assert cells(lines, "measured numbers")[2] == str(3 * len(found.fit.windows))
    assert cells(lines, "free parameters")[2] == "4"
    assert float(cells(lines, "residuals")[1]) == pytest.approx(found.fit.scale, abs=0.005)


def test_correlations_are_sorted_and_above_the_limit(found):
    fit = found.fit
    sigmas = np.array(list(fit.sigmas.values()))
    of = fit.covariance / np.outer(sigmas, sigmas)
    told = correlations(fit, 0.1)
    assert [abs(value) for *_, value in told] == sorted((abs(v) for *_, v in told), reverse=True)
    for first, second, value in told:
        i, j = fit.names.index(first), fit.names.index(second)
        assert value == pytest.approx(of[i, j])
    assert len(told) == np.sum(np.abs(of[np.triu_indices(4, 1)]) >= 0.1)
    assert correlations(replace(fit, at_bound=fit.names), 0.0) == []


def test_what_has_no_interval_says_why(found):
    fit = replace(found.fit, at_bound=("alpha_left",))
    lines = report("gravel", replace(found, fit=fit, held_out=None))
    assert "at its bound" in next(line for line in lines if "alpha_left" in line)
    assert any("No held-out error" in line for line in lines)


def test_a_fit_in_short_names_what_is_identified_and_what_to_doubt(found):
    doubted = replace(found, fit=replace(found.fit, at_bound=("y_left",), by_trial=("x_icr",)))
    line = in_short("gravel", doubted)
    start, values = line.split(" times the noise: ")
    assert start == (
        f"[gravel] icr, {len(found.fit.windows)} windows, residuals {found.fit.scale:.2f}"
    )
    of = found.fit.values
    assert values.split(", ") == [
        f"y_left = {of['y_left']:.4g} (at its bound)",
        f"y_right = {of['y_right']:.4g}",
        f"alpha_left = {of['alpha_left']:.4g}",
        f"alpha_right = {of['alpha_right']:.4g}",
        "x_icr = 0.06 (by trial)",
    ]


def test_residuals_are_compared_with_the_noise_that_is_known(found):
    """That of positions has a least value: residuals of SLAM are smoother than its errors."""
    assert found.fit.compared_with == "the poses' stated noise"
    for position_m, words in ((0.05, "positions (0.05 m)"), (0.001, "0.02 m (the noise found")):
        noise = replace(UNKNOWN_NOISE, variances=np.array([position_m**2, 0.0, 0.0]))
        assert words in replace(found.fit, noise=noise).compared_with


def test_statistics_stand_in_two_columns(found):
    lines = report("gravel", found)
    rows = lines[2 : lines.index("  Variables")]
    begins = {len(row) - len(row[4:].split("  ", 1)[1].lstrip()) for row in rows}
    assert len(begins) == 1
