"""Whether the covariance of an odometer without poses is as large as its errors, on recordings.

    python -m tests.studies.main_job.odometer_without_poses [--no-gyroscope]

Needs TERRAIN_ODOMETRY_DATA. Of a robot and terrain that were recorded more than once, ICRs are
identified on all but one recording, which is then replayed without its poses, in five parts of up
to 150 s. NEES of x, y and yaw of odometer and estimate against its poses, by the covariance of
odometer.csv, and by that of the filter alone; 3 is expected.
"""

import argparse
import itertools
import re
from dataclasses import replace

import numpy as np

from odometry.evaluation.odometer_uncertainty import path_of
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.identification.identify import identify
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from terrain.main_job import run_odometry
from tests.studies.main_job.estimation_outputs import without_gyroscope
from tests.studies.main_job.estimation_recordings import motion, recordings

DISTANCES_M = (5.0, 20.0, 50.0, 100.0)
PARTS, LONGEST_S, SHORTEST_S = 5, 150.0, 40.0
KINDS = (
    "odometer, by odometer.csv",
    "odometer, by the filter",
    "estimate, by odometer.csv",
    "estimate, by the filter",
)
REFERENCE = np.square([0.02, 0.02, 0.01])  # m^2, rad^2: of the poses


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--no-gyroscope", action="store_true")
    treads_alone = parser.parse_args().no_gyroscope
    found = []
    for name, others in alike():
        run = Run.read(motion() / name)
        known = identify([Run.read(motion() / other) for other in others], "icr")
        bare = replace(without_gyroscope(run) if treads_alone else run, pose=None)
        rows = [row for part in parts(run) for row in figures(cut_run(bare, part), run.pose, known)]
        found += [(name, *row) for row in rows]
        print(f"{name:42} {words(rows)}", flush=True)
    for distance_m in DISTANCES_M:
        here = [row[2:] for row in found if row[1] == distance_m]
        for kind, nees in zip(KINDS, np.transpose(here), strict=True):
            print(f"{distance_m:5g} m, {len(nees):3} parts, {kind:27}: mean {nees.mean():.1f}, "
                  f"median {np.median(nees):.1f}")  # fmt: skip


def alike():
    """Recordings with the others of the same robot on the same terrain, without the time of day."""
    names = recordings(seven=False)
    kinds = {name: re.sub(r"(_\d{8}(_\d{4})?)?(_s\d+)?(_\d{2})?$", "", name) for name in names}
    for name in names:
        others = [other for other in names if other != name and kinds[other] == kinds[name]]
        if others:
            yield name, others


def parts(run):
    """Spans that begin where there is a pose."""
    first_s, last_s = run.odometry.stamps_s[[0, -1]]
    begin_s = max(first_s, run.pose.stamps_s[0])
    for at_s in np.linspace(begin_s, last_s - SHORTEST_S, PARTS) - first_s:
        yield Span(float(at_s), float(min(last_s - first_s, at_s + LONGEST_S)))


def figures(bare, pose, known):
    """Distance, and NEES of `KINDS`."""
    terrain = next(iter(known.terrains))
    result = run_odometry(bare, parameters=known.to_parameter_set(), vision=False, terrain=terrain)
    path, replay = path_of(result.replay), result.replay
    measured = pose.stack("x", "y", "yaw")
    measured[:, 2] = np.unwrap(measured[:, 2])
    true = np.column_stack(
        [np.interp(replay.stamps_s, pose.stamps_s, column) for column in measured.T]
    )
    covariances = (
        result.uncertainty.covariances,
        replay.pose_covariances_of(slice(0, len(replay.stamps_s))),
    )
    estimate = replay.numbers("mean", columns=slice(0, 3))
    for distance_m in DISTANCES_M:
        at = int(np.searchsorted(path.travel_m, distance_m))
        if at < len(true) and replay.stamps_s[at] <= pose.stamps_s[-1]:
            of = itertools.product((path.poses, estimate), covariances)
            yield distance_m, *(nees(poses, true, by, at) for poses, by in of)


def nees(poses, true, covariances, at):
    error = se2.between(poses[0], poses[at]) - se2.between(true[0], true[at])
    error[2] = wrap(error[2])
    turn = np.eye(3)
    cosine, sine = np.cos(poses[0, 2]), np.sin(poses[0, 2])
    turn[:2, :2] = [[cosine, sine], [-sine, cosine]]
    x, y, _ = se2.between(true[0], true[at])
    by_first_yaw = np.array([y, -x, -1.0])
    of_reference = np.diag(2 * REFERENCE - [0.0, 0.0, REFERENCE[2]])
    of_reference += REFERENCE[2] * np.outer(by_first_yaw, by_first_yaw)
    return error @ np.linalg.solve(turn @ covariances[at] @ turn.T + of_reference, error)


def words(rows):
    return "  ".join(
        f"{distance_m:g} m: {np.mean([row[1] for row in rows if row[0] == distance_m]):.1f}"
        for distance_m in DISTANCES_M
        if any(row[0] == distance_m for row in rows)
    )


if __name__ == "__main__":
    main()
