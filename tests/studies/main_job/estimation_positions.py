"""Positions without yaw: the estimate against that of full poses, and identification from them.

    python -m tests.studies.main_job.estimation_positions [--seven] [--loops-only] [--save FILE]
        [--against FILE]

Needs TERRAIN_ODOMETRY_DATA. The world is turned by 120 degrees, and the yaw column of pose.csv
emptied. Every second second of poses is withheld, and the estimate is evaluated there after the
first 20 m of wheel travel: its mean distance with positions alone, by that with full poses. Initial
yaw: how far the odometer's first yaw is off the measured one. Loops: models are identified from
positions alone, and the treads are reckoned open loop by a loop of the study's own; root mean
square distance by length, from the measured first pose, and (turned) with the heading that fits
best, as positions cannot give one.
"""

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path as Folder

import numpy as np

from odometry.errors import OdometryError
from odometry.identification.identify import identify
from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import outputs_of, with_columns, with_poses_withheld
from tests.studies.main_job.estimation_reckoning import (
    Path,
    at,
    icr_drive,
    position_errors_m,
    reference_path,
    wheel_travel_m,
)
from tests.studies.main_job.estimation_recordings import motion, recordings, withheld_reference
from tests.studies.main_job.estimation_simulation import Noise, drive, loop, run_of

AFTER_M = 20.0
TURNED_RAD = math.radians(120.0)
LOOPS = (
    "warthog_gravel_20240806_1137_s02",
    "warthog_2023_s02",
    "warthog_asphalt_fast_20240807_1130_s00",
    "marmotte_boreal_20240125_1215_s02",
    "warthog_asphalt_20240920_0813",
)
MODELS = ("icr", "icr_symmetric")
GNSS_M = (0.02, 0.3, 1.0)
ICRS = (0.45, -0.40, -0.05)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seven", action="store_true")
    parser.add_argument("--loops-only", action="store_true")
    parser.add_argument("--save", type=Folder)
    parser.add_argument("--against", type=Folder)
    arguments = parser.parse_args()
    earlier = json.loads(arguments.against.read_text()) if arguments.against else {}
    found = {}
    if not arguments.loops_only:
        for name in recordings(seven=arguments.seven):
            found[name] = compared(turned(Run.read(motion() / name)))
            if name in earlier:
                print(f"{name:40} earlier {words(earlier[name])}")
            print(f"{name:40} {words(found[name])}", flush=True)
            if arguments.save:
                arguments.save.write_text(json.dumps(found, indent=1))
        print_summary(found)
    for name in LOOPS:
        print_loop(name, Run.read(motion() / name))
    for sigma_m in GNSS_M:
        for seed in range(3):
            icrs = dict(zip(("y_left", "y_right", "x_icr"), ICRS, strict=True))
            title = f"simulated, {sigma_m} m, seed {seed}"
            print_loop(title, simulated_loop(sigma_m, seed), icrs=icrs)


def turned(run):
    """The world turned by 120 degrees: recordings begin at yaw 0, which a filter may suppose."""
    way = np.exp(1j * TURNED_RAD) * (run.pose["x"] + 1j * run.pose["y"])
    yaw = wrapped(run.pose["yaw"] + TURNED_RAD)
    return replace(run, pose=with_columns(run.pose, x=way.real, y=way.imag, yaw=yaw))


def without_yaw(run):
    """The run with the yaw of every pose emptied."""
    yaw = np.full(len(run.pose), np.nan)
    return replace(run, pose=with_columns(run.pose, yaw=yaw))


def compared(run):
    """Errors with full poses and with positions alone, as plain values."""
    fewer, withheld = with_poses_withheld(run)
    unseen = withheld_reference(run, fewer, withheld)
    travel = wheel_travel_m(run, unseen.stamps_s)
    late = travel > travel[0] + AFTER_M
    judge = Path(unseen.stamps_s[late], unseen.poses[late])
    row = {}
    for name, one in (("full", fewer), ("positions", without_yaw(fewer))):
        try:
            outputs = outputs_of(one)
        except OdometryError as error:
            row[name] = {"refused": str(error)}
            continue
        estimate, odometer = outputs.paths["estimate"], outputs.paths["odometer"]
        measured = at(reference_path(run), odometer.stamps_s[:1])[0, 2]
        row[name] = {
            "mean_m": float(position_errors_m(estimate, judge).mean()),
            "yaw_deg": float(np.abs(yaw_errors_deg(estimate, judge)).mean()),
            "yaw_after_deg": float(yaw_errors_deg(estimate, judge)[0]),
            "initial_yaw_deg": math.degrees(wrapped(odometer.poses[0, 2] - measured)),
            "odometer_end_m": float(position_errors_m(odometer, judge)[-1]),
            "kinds": outputs.kinds,
        }
    return row


def yaw_errors_deg(path, judge):
    return np.degrees(wrapped(at(path, judge.stamps_s)[:, 2] - judge.poses[:, 2]))


def wrapped(angle):
    return np.angle(np.exp(1j * angle))


def words(row):
    full, positions = row["full"], row["positions"]
    if "refused" in full or "refused" in positions:
        return f"refused: {(full | positions).get('refused')}"
    ratio = positions["mean_m"] / full["mean_m"]
    return (
        f"full {full['mean_m']:.3f} m {full['yaw_deg']:.2f} deg, positions "
        f"{positions['mean_m']:.3f} m {positions['yaw_deg']:.2f} deg, ratio {ratio:.2f}; "
        f"initial yaw {positions['initial_yaw_deg']:+.2f} deg, at {AFTER_M:.0f} m "
        f"{positions['yaw_after_deg']:+.2f} deg; odometer ends {full['odometer_end_m']:.2f} > "
        f"{positions['odometer_end_m']:.2f} m; {', '.join(positions['kinds']) or 'nothing'} flagged"
    )


def print_summary(found):
    rows = [r for r in found.values() if "refused" not in r["positions"]]
    ratios = np.array([r["positions"]["mean_m"] / r["full"]["mean_m"] for r in rows])
    initial = np.abs([r["positions"]["initial_yaw_deg"] for r in rows])
    after = np.abs([r["positions"]["yaw_after_deg"] for r in rows])
    print(f"{len(rows)} of {len(found)}: ratio within 1.5 on {np.sum(ratios <= 1.5)}, median "
          f"{np.median(ratios):.2f}, worst {ratios.max():.2f}; initial yaw within 3 degrees on "
          f"{np.sum(initial <= 3)} (median {np.median(initial):.2f}), at {AFTER_M:.0f} m on "
          f"{np.sum(after <= 3)}")  # fmt: skip


def simulated_loop(sigma_m, seed):
    """A loop of 300 m at 1 m/s, GNSS at 5 Hz, tread noise of 5 mm/s."""
    rng = np.random.default_rng([seed, int(sigma_m * 100)])
    noise = Noise(position=0.003, yaw=0.001, pose_m=sigma_m, pose_rad=0.01, tread_m_s=0.005,
                  gyro=0.002)  # fmt: skip
    one = drive(loop(300.0, ICRS), np.array(ICRS), noise, rng)
    return replace(run_of(one, gyroscope=True), truth=truth_of(one))


def truth_of(one):
    x, y, yaw = one.states[:, :3].T
    table = run_of(one, gyroscope=False).odometry
    return replace(table, columns={"t": one.stamps_s, "x": x, "y": y, "yaw": yaw})


def print_loop(name, run, *, icrs=None):
    """Open loop errors: ideal, true ICRs where known, and what positions and poses identify."""
    reference = reference_path(run)
    length = float(wheel_travel_m(run, reference.stamps_s)[-1])
    known = {"ideal": ideal(run)} | ({"true ICRs": icrs} if icrs else {})
    print(f"loop {name}, {length:.0f} m")
    for title, values in known.items():
        print(f"    {title:26} {open_loop_share(run, reference, values, length)}")
    for title, one in (("positions", without_yaw(run)), ("full poses", run)):
        for model in MODELS:
            try:
                fitted = identify([replace(one, truth=None)], model)
                values = next(iter(fitted.to_parameter_set().terrains.values()))
                answer = open_loop_share(run, reference, icrs_of(values), length)
            except OdometryError as error:
                answer = f"refused: {str(error)[:100]}"
            print(f"    {title + ', ' + model:26} {answer}", flush=True)


def icrs_of(table):
    """ICRs and slip factors of a table of `icr` or `icr_symmetric` (alpha, b_hat)."""
    values = dict(table.values)
    if table.model == "icr":
        return values
    half = values["b_hat"] / 2
    factor = values["alpha"]
    return {"y_left": half, "y_right": -half, "x_icr": 0.0, "alpha_left": factor,
            "alpha_right": factor}  # fmt: skip


def ideal(run):
    half = run.robot.track_width / 2
    return {"y_left": half, "y_right": -half, "x_icr": 0.0, "alpha_left": 1.0, "alpha_right": 1.0}


def open_loop_share(run, reference, values, length_m):
    """RMS distance by length, percent: from the measured pose, and turned to fit best."""
    path = icr_drive(run, values, reference.stamps_s[0], reference.poses[0])
    there = at(path, reference.stamps_s)[:, :2]
    start = reference.poses[0, :2]
    seen, true = ((xy - start) @ [1, 1j] for xy in (there, reference.poses[:, :2]))
    turn = np.exp(1j * np.angle(np.sum(np.conj(seen) * true)))
    shares = [math.sqrt(np.mean(np.abs(s - true) ** 2)) / length_m for s in (seen, seen * turn)]
    return f"{shares[0]:.2%} (turned {shares[1]:.2%})"


if __name__ == "__main__":
    main()
