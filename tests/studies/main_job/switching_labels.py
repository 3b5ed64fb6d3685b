"""Where the switch happens, on drives with spins and reversals, with labels that may be wrong.

    python -m tests.studies.main_job.switching_labels [--seeds 20] [--out FOLDER]

Courses of `switching_courses`: Chen's A - B - A, three terrains, three terrains with turns on the
spot and reversals, and these with a rear camera. Sources of terrain: labels of regions ahead that
are all right, right nine times in ten, or wrong in stretches of 0.3 m a tenth of the way, by
accumulated evidence and by two labels in a row (Chen 2023); the true name at the true edge; the
true shares of the footprint; and one terrain throughout. Printed: error per metre of the odometer
over 5 m, switches, those that no true edge is near (0.25 m), false ones (to a terrain that is not
within 0.5 m), and true changes.
"""

import argparse
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.score import reference_of, score
from odometry.replays.pipeline import ConstantTerrain, replay
from odometry.replays.terrain_sources import labelled_terrain
from terrain.config import Config
from tests.studies.main_job.switching_courses import LabellingWatcher, TrueFooting, make_course

A_B_A, THREE = ("gravel", "grass", "gravel"), ("gravel", "grass", "brick", "gravel", "brick")
COURSES = {
    "A - B - A": {"zones": A_B_A},
    "three terrains": {"zones": THREE},
    "spins and reversals": {"zones": THREE, "manoeuvres": True},
    "the same, rear camera": {"zones": THREE, "manoeuvres": True, "rear": True},
}
LABELS = {
    "right": {"accuracy": 1.0},
    "0.90 right": {"accuracy": 0.9},
    "0.90 right, in stretches": {"accuracy": 0.9, "held_m": 0.3},
}
NEAR_M, FALSE_M = 0.25, 0.5
PAPER = {"labels_in_row": 2, "by_shares": False}
STEP = {"by_shares": False}


@dataclass(frozen=True)
class Numbers:
    """What one replay showed."""

    per_m: float
    switches: int = 0
    far: int = 0
    false: int = 0
    distances_m: tuple[float, ...] = ()


def main() -> None:
    """Run the study and print its tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--out", type=Path, default=None, help="keep the run folders here")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        for name, course in COURSES.items():
            study(name, course, (arguments.out or Path(scratch)), arguments.seeds)


def study(name, settings, out, seeds):
    """One kind of course."""
    found, changes = {}, 0
    for seed in tqdm(range(seeds), name):
        folder = out / name.replace(" ", "_").replace(",", "") / f"seed_{seed:02d}"
        course = make_course(folder, seed, **settings)
        terrains = np.array(course.drive.terrains)
        changes += int((terrains[1:] != terrains[:-1]).sum())
        for source, numbers in replays(course, seed):
            found.setdefault(source, []).append(numbers)
    print(f"\n{name}: {seeds} drives, {changes} true changes")
    for source, numbers in found.items():
        distances = [m for n in numbers for m in n.distances_m]
        quantiles = np.quantile(distances, [0.5, 0.95, 1.0]) if distances else [np.nan] * 3
        print(
            f"  {source:42s} {np.mean([n.per_m for n in numbers]):.4f} m/m"
            f"  switches {sum(n.switches for n in numbers):4d}"
            f"  beyond {NEAR_M} m {sum(n.far for n in numbers):3d}"
            f"  false {sum(n.false for n in numbers):3d}"
            f"  from the edge {quantiles[0]:.2f}, 95 % {quantiles[1]:.2f}, most {quantiles[2]:.2f}",
            flush=True,
        )


def replays(course, seed):
    """Every source of terrain on one course."""
    config = Config()
    for labels, errors in LABELS.items():
        for rule, switch in {"evidence": {}, "evidence, step": STEP, "two in a row": PAPER}.items():
            if rule == "evidence, step" and errors["accuracy"] < 1:
                continue
            own = replace(config, switch=replace(config.switch, **switch))
            watcher = LabellingWatcher(course, own, seed=seed, **errors)
            yield f"labels {labels}: {rule}", judged(course, watcher, own)
    initial = course.ground.terrains[0]
    yield "true name at the true edge", judged(course, labelled_terrain(course.run), config)
    yield "true shares", judged(course, TrueFooting(course), config)
    yield "one terrain throughout", judged(course, ConstantTerrain(initial), config)


def judged(course, source, config):
    """Replay with a source of terrain and hold its switches against the ground."""
    run = course.run
    estimator = IcrEkf(run.robot.track_width, course.parameters, config.filter)
    trajectory = replay(run, estimator, source).odometer()
    _, reference = reference_of(run)
    per_m = score(run, trajectory, reference, config.evaluation).mean_translation_per_m
    events = getattr(source, "events", ())
    distances = tuple(course.edge_distance_m(event.stamp_s) for event in events)
    return Numbers(
        per_m,
        len(events),
        sum(distance > NEAR_M for distance in distances),
        sum(is_false(course, event) for event in events),
        distances,
    )


def is_false(course, event):
    """Whether a switch is to a terrain that is not near."""
    x, y = (
        np.interp(event.stamp_s, course.drive.stamps_s, of) for of in course.drive.poses_world.T[:2]
    )
    near = np.stack([x + np.linspace(-FALSE_M, FALSE_M, 11), np.full(11, y)], axis=-1)
    return event.terrain not in {course.ground.terrains[k] for k in course.ground.strip_at(near)}


if __name__ == "__main__":
    main()
