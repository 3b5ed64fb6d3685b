"""Skid modes in the contact simulator: the experiments of Salvi 2024, Fig. 3 to 6.

    python -m tests.studies.modes.skid_modes [--seeds 50] [--jobs 2] [--only WORD ...]
        [--out skid_modes]

Modes are identified once for each speed, on skidpad, clothoid and sinusoid drives of a Husky-like
robot in every mode; experiments are outward spirals, to the left and to the right in turn, whose
noise differs from seed to seed (gyro 0.02 rad/s, pose 2 cm and 0.5 degrees at 10 Hz).

- grounds: asphalt, grass, crushed concrete, each alone for 30 s (Fig. 3), and 10 s of each, a
  spiral of its own each time (Fig. 4); by treads and gyroscope;
- wheels: none, the front two, the right two, all (Fig. 5), right two and then all (Fig. 6), at
  1, 1.5 and 2 m/s; by treads, pose and gyroscope; with the (k, m) of the paper alone, too; and
  each of the 16 combinations among all 16.

Every stretch of a mode is a row of FOLDER/stretches.csv. Shares are of the time after the mode was
first named, or of all of it where it never was. The way is curved where the radius driven is less
than 6 m, straight where it is more than 12 m.
"""

import argparse
import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from joblib import Parallel, delayed
from tqdm import tqdm

from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.detection import detections, false_switches
from odometry.modes.follow.track import ModesConfig, ModeTrack, follow_modes
from odometry.modes.identify.identify_traction import identify_traction_modes
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.mode_set import DWELL_S, NO_MODES, UNDETERMINED, ModeSet
from odometry.recording.run import Run
from odometry.simulation.contact.drive import ContactDrive, simulate_contact
from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import ContactVehicle, read_contact_vehicle
from odometry.simulation.courses import SPIRAL_WIDTHS, STEP_S, effective_width_m
from odometry.simulation.manoeuvres import outward_spiral
from odometry.simulation.record import contact_run
from odometry.simulation.skid_experiments import (
    GROUNDS,
    SENSORS,
    WHEEL_MODES,
    calibration_courses,
    calibration_runs,
    ground_traction,
    wheel_traction,
)

VEHICLE = Path(__file__).parents[3] / "data" / "vehicles" / "husky_like.toml"
SINGLE_S, PART_S = 30.0, 10.0
CURVED_M, STRAIGHT_M = 6.0, 12.0
SURE = ModesConfig().sure
RIGHT = ("front_right", "rear_right")
FRONT = ("front_left", "front_right")
FOUR = ((), FRONT, RIGHT, ("front_left", "front_right", "rear_left", "rear_right"))
SPEED_M_S, FASTER_M_S = 1.0, (1.5, 2.0)
COLUMNS = (
    *("figure", "speed", "seed", "mode", "detected_after", "false_switches"),
    *("right_curved", "wrong_curved", "right_straight", "wrong_straight", "open_straight", "nis"),
)


@dataclass(frozen=True)
class Experiment:
    """A drive of which noisy runs are made, and the modes that evaluate it."""

    figure: str
    speed_m_s: float
    modes: ModeSet
    drives: tuple[ContactDrive, ...]


def main() -> None:
    """Run all experiments and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="*", default=[""], help="words in the names of figures")
    parser.add_argument("--out", type=Path, default=Path("skid_modes"))
    arguments = parser.parse_args()
    vehicle = read_contact_vehicle(VEHICLE)
    made = experiments(vehicle, SPEED_M_S)
    for speed in FASTER_M_S:
        made += four_wheel_experiments(vehicle, speed)
    wanted = [one for one in made if any(word in one.figure for word in arguments.only)]
    tasks = [(one, seed) for one in wanted for seed in range(arguments.seeds)]
    studied = Parallel(n_jobs=arguments.jobs, return_as="generator")
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, object]] = []
    with (arguments.out / "stretches.csv").open("w", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        sheet.writeheader()
        for found in tqdm(studied(delayed(study)(*task) for task in tasks), total=len(tasks)):
            rows += found
            sheet.writerows(found)
            stream.flush()
    print_table(rows)


def experiments(vehicle: ContactVehicle, speed: float) -> list[Experiment]:
    """All experiments at one largest tread speed."""
    grounds = [ground_traction(vehicle, name) for name in GROUNDS]
    wheels = [wheel_traction(vehicle, slipping) for slipping in WHEEL_MODES]
    of_grounds = identify_velocity_modes(calibrated(vehicle, grounds, speed))
    ground_set = ModeSet(of_grounds, np.full(len(of_grounds.names), DWELL_S))
    of_four = calibrated(vehicle, [wheel_traction(vehicle, one) for one in FOUR], speed)
    paper = mode_set_of(of_four, paper=True)
    all_16 = mode_set_of(calibrated(vehicle, wheels, speed))
    switching = [
        replace(ground_traction(vehicle, name), from_s=PART_S * place)
        for place, name in enumerate(("crushed_concrete", "grass", "asphalt"))
    ]
    return [
        *(
            Experiment("3 grounds", speed, ground_set, spirals(vehicle, speed, [one], 1))
            for one in grounds
        ),
        Experiment("4 grounds switch", speed, ground_set, spirals(vehicle, speed, switching, 3)),
        *four_wheel_experiments(vehicle, speed),
        *(
            Experiment(
                "5 (k, m) alone",
                speed,
                paper,
                spirals(vehicle, speed, [wheel_traction(vehicle, one)], 1),
            )
            for one in FOUR
        ),
        *(
            Experiment("16 wheels", speed, all_16, spirals(vehicle, speed, [one], 1))
            for one in wheels
        ),
    ]


def four_wheel_experiments(vehicle: ContactVehicle, speed: float) -> list[Experiment]:
    """Those of the four sets of wheels of Fig. 5 and 6."""
    tractions = [wheel_traction(vehicle, slipping) for slipping in FOUR]
    few = mode_set_of(calibrated(vehicle, tractions, speed))
    then_all = [wheel_traction(vehicle, RIGHT), wheel_traction(vehicle, FOUR[-1], PART_S)]
    return [
        *(
            Experiment("5 wheels", speed, few, spirals(vehicle, speed, [one], 1))
            for one in tractions
        ),
        Experiment("6 wheels switch", speed, few, spirals(vehicle, speed, then_all, 2)),
    ]


def calibrated(vehicle: ContactVehicle, tractions: Sequence[Traction], speed: float) -> list[Run]:
    """Noisy runs of the calibration courses in every mode."""
    courses = calibration_courses(vehicle, speed)
    runs = calibration_runs(vehicle, tractions, courses, np.random.default_rng(0))
    return [run for of in runs.values() for run in of]


def mode_set_of(runs: Sequence[Run], *, paper: bool = False) -> ModeSet:
    """Traction modes of calibration runs."""
    modes = identify_traction_modes(runs, paper=paper)
    return ModeSet(modes, np.full(len(modes.names), DWELL_S))


def spirals(
    vehicle: ContactVehicle, speed: float, traction: Sequence[Traction], parts: int
) -> tuple[ContactDrive, ...]:
    """Drives to the left and to the right: one spiral of 30 s, or `parts` of 10 s each.

    The radius grows by as much in a second in both: a part ends at a third of the way.
    """
    width, lasts_s = effective_width_m(vehicle), SINGLE_S if parts == 1 else PART_S
    widths = SPIRAL_WIDTHS[0] + np.array([0.0, np.ptp(SPIRAL_WIDTHS) * lasts_s / SINGLE_S])
    drives = []
    for side in (1, -1):
        one = outward_spiral(
            lasts_s,
            STEP_S,
            width_m=width,
            speed_m_s=speed / (1 + 0.5 / SPIRAL_WIDTHS[0]),
            radii_m=(width * widths[0], width * widths[1]),
            side=side,
        )
        speeds = np.concatenate([one[:-1]] * parts)
        drives.append(simulate_contact(vehicle, speeds, STEP_S, traction=traction))
    return tuple(drives)


def study(experiment: Experiment, seed: int) -> list[dict[str, object]]:
    """One noisy run of an experiment, a row for each mode that it had."""
    drive = experiment.drives[seed % len(experiment.drives)]
    rng = np.random.default_rng([seed, len(experiment.modes.names)])
    run = contact_run("experiment", drive, SENSORS, rng, terrain=None)
    track = follow_modes(run, experiment.modes)
    answers, radius_m = named_modes(track, SURE), radii_m(track, drive)
    rows = []
    for one in detections(track, SURE):
        here = (track.stamps_s >= one.from_s) & (track.stamps_s <= one.to_s)
        after = here & (track.stamps_s >= one.from_s + np.nan_to_num(one.after_s, nan=0.0))
        curved, straight = after & (radius_m < CURVED_M), after & (radius_m > STRAIGHT_M)
        told = curved & np.isfinite(one.after_s)
        rows.append(
            {
                "figure": experiment.figure,
                "speed": experiment.speed_m_s,
                "seed": seed,
                "mode": one.mode,
                "detected_after": one.after_s,
                "false_switches": false_switches(track, SURE),
                "right_curved": share(answers[told] == one.mode),
                "wrong_curved": share(wrong(answers, one.mode)[curved]),
                "right_straight": share(answers[straight] == one.mode),
                "wrong_straight": share(wrong(answers, one.mode)[straight]),
                "open_straight": share(answers[straight] == UNDETERMINED),
                "nis": float(np.nanmean(track.normalised_squared)),
            }
        )
    return rows


def wrong(answers: np.ndarray, mode: str) -> np.ndarray:
    """Where another mode is named."""
    return (answers != mode) & ~np.isin(answers, NO_MODES)


def radii_m(track: ModeTrack, drive: ContactDrive) -> np.ndarray:
    """Radius (N,) that was driven at each stamp; standing is straight."""
    speed, omega = drive.twists_body[:, 0], drive.twists_body[:, 2]
    radius = np.abs(speed) / np.maximum(np.abs(omega), 1e-6)
    radius = np.where(np.abs(speed) < 0.05, np.inf, radius)
    return np.asarray(radius[np.searchsorted(drive.stamps_s, track.stamps_s, side="right") - 1])


def share(chosen: np.ndarray) -> float:
    """Share of the samples; NaN of none."""
    return float(chosen.mean()) if len(chosen) else float("nan")


def print_table(rows: list[dict[str, object]]) -> None:
    """By figure, speed and mode: times to detection and shares."""
    print(
        f"{'figure':18} {'m/s':>4} {'mode':45} {'named':>5}  {'after, median [5-95 %]':24} "
        f"{'false':>6}  {'curved: right':>13} {'wrong':>6}  {'straight: right':>15} {'wrong':>6} "
        f"{'open':>5}  {'NIS':>5}"
    )
    groups = dict.fromkeys((row["figure"], row["speed"], row["mode"]) for row in rows)
    for figure, speed, mode in groups:
        of = [r for r in rows if (r["figure"], r["speed"], r["mode"]) == (figure, speed, mode)]
        columns = {name: np.array([float(str(r[name])) for r in of]) for name in COLUMNS[4:]}
        after = columns["detected_after"]
        told = np.isfinite(after)
        times = "-"
        if told.any():
            low, middle, high = np.sort(np.where(told, after, np.inf))[
                [int(q * len(after)) for q in (0.05, 0.5, 0.95)]
            ]
            times = f"{middle:.1f} [{low:.1f}-{high:.1f}]"
        means = {
            name: f"{np.nanmean(v):.2f}" if np.isfinite(v).any() else "-"
            for name, v in columns.items()
        }
        print(
            f"{figure:18} {speed:4} {mode:45} {told.mean():5.0%}  {times:24} "
            f"{means['false_switches']:>6}  {means['right_curved']:>13} "
            f"{means['wrong_curved']:>6}  {means['right_straight']:>15} "
            f"{means['wrong_straight']:>6} {means['open_straight']:>5}  {means['nis']:>5}"
        )


if __name__ == "__main__":
    main()
