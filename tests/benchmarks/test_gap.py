"""Time of one case of the gap workflow: an effect by its formula, and one by contact forces."""

import time

import pytest

from odometry.gap.gap import find_gap
from odometry.recording.run import Run
from tests.blind.cases import make_case


@pytest.mark.parametrize("kind", ["curvature", "contact_slope"])
def test_a_gap_case(benchmark, kind, tmp_path):
    """Its figure is the time of the processor, which bears a busy machine better."""
    case = make_case(kind, 1, tmp_path)
    folders = (case.measured, case.calibration, case.holdout)
    measured, calibration, holdout = ([Run.read(folder)] for folder in folders)
    spent_s = []

    def find():
        started = time.process_time()
        found = find_gap(measured, calibration, holdout)
        spent_s.append(time.process_time() - started)
        return found

    assert benchmark.pedantic(find, rounds=2).verdict
    benchmark.extra_info["figure"] = min(spent_s)
