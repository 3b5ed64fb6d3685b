"""Trajectory errors against evo, run as a separate program on our TUM files."""

import json
import subprocess
import sys
import zipfile
from dataclasses import asdict
from importlib.metadata import entry_points

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon, dead_reckon_in_space
from odometry.evaluation.relative import EvaluationConfig, position_errors, relative_errors
from odometry.installed import shipped_data
from odometry.io.trajectory_files import write_trajectory
from odometry.io.tum import write_spatial_tum, write_tum
from odometry.trajectory import SpatialTrajectory
from terrain.main_job import run_odometry
from terrain.results import write_results
from tests.reference.pose_metrics.alignment import align_origin, align_rigid
from tests.reference.pose_metrics.pose_errors import (
    absolute_pose_errors,
    relative_pose_errors,
    statistics,
)
from tests.reference.pose_metrics.pose_pairs import (
    all_frame_pairs,
    all_path_pairs,
    consecutive_frame_pairs,
    consecutive_path_pairs,
)

STEP_S, SPEED, STEPS = 0.25, 1.0, 160  # binary fractions: wheel travel has no rounding
STAMPS_S = STEP_S * np.arange(STEPS + 1)
RELATIONS = {"trans_part": "translation_m", "angle_rad": "rotation_rad", "full": "full"}
ALIGNMENTS = {"-a": align_rigid, "--align_origin": align_origin}
PAIRS = {
    "-d 7 -u f": lambda ours: consecutive_frame_pairs(ours, 7),
    "-d 7 -u f --all_pairs": lambda ours: all_frame_pairs(ours, 7),
    "-d 3.3 -u m": lambda ours: consecutive_path_pairs(ours, 3.3),
    "-d 3.3 -u m -t 0.02 --all_pairs": lambda ours: all_path_pairs(ours, 3.3, 0.02),
}


def weaving():
    """Body twists of a path that bends to both sides, and of an odometer that drifts from it."""
    turns = 0.6 * np.sin(0.2 * STAMPS_S)
    twists = np.column_stack([np.full(STEPS + 1, SPEED), 0 * turns, turns])
    drifting = twists * [0.97, 1, 1.05] + [0, 0.02, 0.01]
    drifting[:, 0] += 0.1 * np.sin(0.7 * STAMPS_S)  # uneven steps: not every pair is near enough
    return twists, drifting


def plane():
    twists, drifting = weaving()
    start = np.array([3.0, -2.0, 2.5])
    reference = dead_reckon(STAMPS_S, twists, start)
    return reference, dead_reckon(STAMPS_S, drifting, np.add(start, [0.2, -0.1, 0.05]))


def space():
    """Over rolling ground; the odometer reads its tilt with a bias and starts off the place."""
    twists, drifting = weaving()
    roll, pitch = 0.3 * np.sin(0.5 * STAMPS_S), 0.2 * np.cos(0.3 * STAMPS_S)
    start = np.array([3.0, -2.0, 1.0, 2.5])
    reference = dead_reckon_in_space(STAMPS_S, twists, roll, pitch, start)
    shifted = np.add(start, [0.2, -0.1, 0.3, 0.05])
    return reference, dead_reckon_in_space(STAMPS_S, drifting, roll + 0.02, pitch - 0.03, shifted)


@pytest.fixture(scope="module")
def trajectories(tmp_path_factory):
    """By kind: a folder of TUM files, the reference and the odometer in space."""
    found = {}
    for kind, make, write in (("plane", plane, write_tum), ("space", space, write_spatial_tum)):
        folder = tmp_path_factory.mktemp(kind)
        reference, drifting = make()
        write(folder / "reference.tum", reference)
        write(folder / "drifting.tum", drifting)
        if kind == "plane":
            reference, drifting = map(SpatialTrajectory.from_plane, (reference, drifting))
        found[kind] = folder, reference, drifting
    return found


# One process for all commands: evo takes a second to start, a result a hundredth of one.
EVO = """
import json, os, sys
from importlib.metadata import entry_points
for line in sys.stdin:
    folder, program, *options = json.loads(line)
    os.chdir(folder)
    sys.argv = [program, *options]
    (script,) = entry_points(group="console_scripts", name=program)
    script.load()()
    print("done", flush=True)
"""


@pytest.fixture(scope="module")
def evo(tmp_path_factory):
    """A process that runs evo's commands, one a line."""
    if not entry_points(group="console_scripts", name="evo_ape"):
        pytest.skip("evo is not installed: it is in the extra `test`")
    home = str(tmp_path_factory.mktemp("home"))
    with subprocess.Popen(
        [sys.executable, "-c", EVO],
        env={"HOME": home, "MPLBACKEND": "agg", "OMP_NUM_THREADS": "1"},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        yield process
        process.stdin.close()


TUM_FILES = ("tum", "reference.tum", "drifting.tum")


def evo_results(evo, folder, program, *options, files=TUM_FILES):
    """The error array and the statistics that an evo program saves."""
    result = folder / f"{program}{files[0]}{''.join(options)}.zip"
    command = [str(folder), program, *files, *options]
    print(
        json.dumps([*command, "--save_results", str(result), "--no_warnings"]),
        file=evo.stdin,
        flush=True,
    )
    said = []
    while said[-1:] != ["done\n"]:
        said.append(evo.stdout.readline())
        assert said[-1], "".join(said)  # it has ended
    with zipfile.ZipFile(result) as archive:
        errors = np.load(archive.open("error_array.npy"), allow_pickle=False)
        return errors, json.loads(archive.read("stats.json"))


def assert_agrees(ours, theirs, their_statistics):
    """Each error and each statistic; a sum of squares relative to its size."""
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
    assert theirs.mean() > 0.01
    our_statistics = asdict(statistics(ours))
    assert our_statistics.keys() == their_statistics.keys()
    for name, value in our_statistics.items():
        assert value == pytest.approx(their_statistics[name], rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize(
    ("kind", "relation", "alignment"),
    [
        *[("space", relation, flag) for relation in RELATIONS for flag in (None, *ALIGNMENTS)],
        ("plane", "full", None),
        ("plane", "angle_rad", "-a"),
        ("plane", "trans_part", "--align_origin"),
    ],
)
def test_absolute_pose_errors(evo, trajectories, kind, relation, alignment):
    folder, reference, drifting = trajectories[kind]
    aligned = ALIGNMENTS[alignment](drifting, reference) if alignment else drifting
    ours = getattr(absolute_pose_errors(aligned, reference), RELATIONS[relation])
    flags = [alignment] if alignment else []
    assert_agrees(ours, *evo_results(evo, folder, "evo_ape", "-r", relation, *flags))


@pytest.mark.parametrize(
    ("kind", "relation", "delta"),
    [
        ("space", "full", "-d 7 -u f"),
        ("space", "angle_rad", "-d 7 -u f --all_pairs"),
        ("space", "trans_part", "-d 3.3 -u m"),
        ("space", "angle_rad", "-d 3.3 -u m"),
        ("space", "full", "-d 3.3 -u m -t 0.02 --all_pairs"),
        ("plane", "angle_rad", "-d 7 -u f"),
        ("plane", "trans_part", "-d 7 -u f --all_pairs"),
        ("plane", "full", "-d 3.3 -u m"),
        ("plane", "trans_part", "-d 3.3 -u m -t 0.02 --all_pairs"),
    ],
)
def test_relative_pose_errors(evo, trajectories, kind, relation, delta):
    folder, reference, drifting = trajectories[kind]
    pairs = PAIRS[delta](drifting)
    assert 5 < len(pairs) < STEPS
    ours = getattr(relative_pose_errors(drifting, reference, pairs), RELATIONS[relation])
    assert_agrees(ours, *evo_results(evo, folder, "evo_rpe", "-r", relation, *delta.split()))


@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("kitti", ("kitti", "reference_kitti.txt", "drifting_kitti.txt")),
        ("euroc", ("euroc", "reference_euroc.csv", "drifting.tum")),
    ],
)
@pytest.mark.parametrize("relation", RELATIONS)
def test_other_formats_are_read_alike(evo, trajectories, name, files, relation):
    """KITTI files have other axes, of body and fixed frame: no error depends on them."""
    folder, reference, drifting = trajectories["space"]
    write_trajectory(folder, "reference", reference, name)
    write_trajectory(folder, "drifting", drifting, name)
    theirs = evo_results(evo, folder, "evo_ape", "-r", relation, files=files)
    ours = absolute_pose_errors(drifting, reference)
    assert_agrees(getattr(ours, RELATIONS[relation]), *theirs)


def test_position_errors_of_the_plane(evo, trajectories):
    folder, reference, drifting = trajectories["plane"]
    theirs, _ = evo_results(evo, folder, "evo_ape", "-r", "trans_part")
    _, ours = position_errors(drifting.plane, reference.plane)
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
    assert theirs.mean() > 0.5


@pytest.mark.parametrize(
    ("relation", "name"), [("trans_part", "translation_per_m"), ("angle_rad", "rotation_per_m")]
)
def test_relative_errors_over_five_metres(evo, trajectories, relation, name):
    """Twenty frames are five metres of wheel travel; evo's windows follow one another."""
    folder, reference, drifting = trajectories["plane"]
    theirs, _ = evo_results(evo, folder, "evo_rpe", "-d", "20", "-u", "f", "-r", relation)
    config = EvaluationConfig(horizon_m=5.0, stride_m=5.0)
    ours = relative_errors(drifting.plane, reference.plane, STAMPS_S, SPEED * STAMPS_S, config)
    assert len(theirs) == 8
    np.testing.assert_allclose(getattr(ours, name) * 5, theirs, rtol=0, atol=1e-8)
    assert theirs.mean() > 0.05


def test_the_odometer_of_a_run(evo, tmp_path):
    """odometer.tum and the truth, by evo; ours is what result.json says."""
    result = run_odometry(shipped_data() / "runs" / "demo", vision=False)
    write_results(result, tmp_path)
    write_tum(tmp_path / "truth.tum", result.reference)
    files = ("tum", "truth.tum", "odometer.tum")
    theirs, _ = evo_results(evo, tmp_path, "evo_ape", "-r", "trans_part", files=files)
    content = json.loads((tmp_path / "result.json").read_text())
    ours = content["errors"]["odometer"]["position_m"]
    assert len(theirs) == len(result.reference)
    assert ours["mean"] == pytest.approx(theirs.mean(), rel=1e-9)
    assert ours["final"] == pytest.approx(theirs[-1], rel=1e-9)
