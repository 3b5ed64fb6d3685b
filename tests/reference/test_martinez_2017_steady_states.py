"""Mean track ICRs of the 441 steady states of Martinez 2017 (section II).

The paper leaves open rollers, friction and height; the shipped vehicle chose them so that the
means come near. What nothing was chosen for: the ratio H, and the signs of the indices' trends.
"""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

from odometry.simulation.contact.vehicle import read_contact_vehicle

STUDY = Path(__file__).parents[1] / "studies" / "identification" / "auriga.py"


@pytest.fixture(scope="module")
def study():
    spec = importlib.util.spec_from_file_location("auriga_study", STUDY)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def states(study):
    return study.solve(read_contact_vehicle(study.VEHICLE))


def test_the_means_are_near_the_papers(states, study):
    assert states.settled.all()
    np.testing.assert_allclose(np.nanmean(states.icrs_m, axis=0), study.PAPER_ICRS_M, atol=0.015)


def test_turning_on_the_spot_needs_the_papers_ratio(states, study):
    assert study.spot_turn_ratio(states) == pytest.approx(study.PAPER_H, abs=0.05)


def test_inertia_moves_the_icrs_as_eq_25_to_27_print(states):
    """Fits by least squares: eps_1, eta_1 and zeta_1 are positive, and of the printed size."""
    force, indices = states.inertial_force_n[states.turns], states.indices[states.turns]
    left, right = states.pairs_m_s[states.turns].T
    forward, product = np.sign(left + 0.67134 * right), np.sign(left - right)
    ones = np.ones_like(force)

    def slope(signs, index):
        return np.linalg.lstsq(np.column_stack([ones, force * signs]), index, rcond=None)[0][1]

    assert slope(forward, indices[:, 0]) == pytest.approx(0.0002424, rel=0.3)
    assert slope(forward * product, indices[:, 1]) == pytest.approx(0.0011, rel=0.4)
    assert slope(forward * product, indices[:, 2]) == pytest.approx(0.0019, rel=0.4)
