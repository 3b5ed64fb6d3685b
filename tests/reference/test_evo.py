"""Position and relative errors against evo, run as a separate program on our TUM files."""

import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon
from odometry.evaluation.relative import EvaluationConfig, position_errors, relative_errors
from odometry.io.tum import write_tum

STEP_S, SPEED, STEPS = 0.25, 1.0, 160  # binary fractions: wheel travel has no rounding


@pytest.fixture(scope="module")
def trajectories(tmp_path_factory):
    """A weaving reference and an odometer that drifts from it, also as TUM files."""
    folder = tmp_path_factory.mktemp("evo")
    stamps_s = STEP_S * np.arange(STEPS + 1)
    turns = 0.6 * np.sin(0.2 * stamps_s)
    twists = np.column_stack([np.full(STEPS + 1, SPEED), 0 * turns, turns])
    reference = dead_reckon(stamps_s, twists, np.array([3.0, -2.0, 2.5]))
    drifting = dead_reckon(stamps_s, twists * [0.97, 1, 1.05] + [0, 0.02, 0.01], reference.poses[0])
    write_tum(folder / "reference.tum", reference)
    write_tum(folder / "drifting.tum", drifting)
    return folder, reference, drifting


def evo_errors(folder, program, *options):
    """The error array that an evo program saves."""
    executable = Path(sys.executable).with_name(program)
    if not executable.exists():
        pytest.skip(f"{program} is not installed: it is in the extra `test`")
    result = folder / f"{program}{len(options)}{options[-1]}.zip"
    command = [executable, "tum", "reference.tum", "drifting.tum", *options]
    finished = subprocess.run(
        [*command, "--save_results", result, "--no_warnings"],
        cwd=folder,
        env={"HOME": str(folder), "MPLBACKEND": "agg", "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stdout + finished.stderr
    with zipfile.ZipFile(result) as archive:
        return np.load(archive.open("error_array.npy"), allow_pickle=False)


def test_position_errors_without_alignment(trajectories):
    folder, reference, drifting = trajectories
    theirs = evo_errors(folder, "evo_ape", "--pose_relation", "trans_part")
    _, ours = position_errors(drifting, reference)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
    assert abs(ours.mean() - theirs.mean()) < 1e-9
    assert theirs.mean() > 0.5


@pytest.mark.parametrize(
    ("relation", "name"), [("trans_part", "translation_per_m"), ("angle_rad", "rotation_per_m")]
)
def test_relative_errors_over_five_metres(trajectories, relation, name):
    """Twenty frames are five metres of wheel travel; evo's windows follow one another."""
    folder, reference, drifting = trajectories
    theirs = evo_errors(
        folder, "evo_rpe", "--delta", "20", "--delta_unit", "f", "--pose_relation", relation
    )
    config = EvaluationConfig(horizon_m=5.0, stride_m=5.0)
    travel_m = SPEED * reference.stamps_s
    ours = relative_errors(drifting, reference, reference.stamps_s, travel_m, config)
    assert len(theirs) == 8
    np.testing.assert_allclose(getattr(ours, name) * 5, theirs, rtol=0, atol=1e-8)
    assert theirs.mean() > 0.05
