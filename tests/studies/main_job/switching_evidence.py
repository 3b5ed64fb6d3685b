"""Where the switch happens by labels that may be wrong, alone, in pairs or in stretches.

    PYTHONPATH=. python -m tests.studies.main_job.switching_evidence [--seeds 20] [--half kept]

Drives of `tests/terrain/switch/switch_drives.py` over terrains 3 to 9 m wide, ahead alone and with
turns on the spot, reversals and returns; labels of the ground 0.95 m ahead every 0.15 m, of which
0.9 are right. Settings may be chosen on the even seeds (`--half chosen`) alone. Printed: switches,
false ones (to a terrain that is not within 0.5 m) for 100 m of wheel travel, those that no true
edge is near (0.25 m), and how late the first switch to a terrain came after the robot's middle did.
"""

import argparse

import numpy as np
from tqdm import tqdm

from odometry.geometry import se2
from terrain.switch.place_labels import Footprint, PlaceLabel
from terrain.switch.switch import Switch, SwitchConfig
from tests.terrain.switch.switch_drives import FOOTPRINT_M, STEP_S, forward, random_drive

WAYS = {"ahead": {"manoeuvres": (forward,)}, "spins and reversals": {}}
LABELS = {
    "all right": {"accuracy": 1.0},
    "0.90 right, alone": {},
    "wrong two in a row": {"in_row": 2},
    "wrong for 0.3 m": {"held_m": 0.3},
    "wrong for 0.6 m": {"held_m": 0.6},
}
RULES = {"evidence": SwitchConfig(), "two in a row": SwitchConfig(labels_in_row=2)}
NEAR_M, FALSE_M = 0.25, 0.5
LASTS_M = 1.5  # a crossing between two ways so long has a switch of its own


def main() -> None:
    """Print a row for every way, kind of labels and rule."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20, help="drives of each kind")
    parser.add_argument("--half", choices=["chosen", "kept"], default="kept")
    arguments = parser.parse_args()
    seeds = 2 * np.arange(arguments.seeds) + (arguments.half == "kept")
    for way, manoeuvres in WAYS.items():
        drives = [random_drive(np.random.default_rng(seed), legs=5, **manoeuvres) for seed in seeds]
        travel_m = sum(driven.travel_m[-1] for driven in drives)
        print(f"{way}: {len(drives)} drives, {travel_m:.0f} m of wheel travel", flush=True)
        for labels, errors in LABELS.items():
            for rule, config in RULES.items():
                found = []
                for seed, driven in zip(seeds, tqdm(drives, rule), strict=True):
                    named = labelled(driven, np.random.default_rng([seed, 1]), **errors)
                    found.append(judged(driven, named, config))
                print(f"  {labels:20s} {rule:14s} {row(found, travel_m)}", flush=True)


def labelled(driven, rng, *, accuracy=0.9, in_row=1, held_m=0.0):
    """The labels of a drive, wrong in rows or over stretches that make up as much of the way."""
    names = sorted(set(driven.land.terrains))
    labels, wrong, row_left, until_m, last_m = [], "", 0, -1.0, 0.0
    for look in driven.looks:
        travel_m = driven.travel_m[look.step]
        since_m, last_m = travel_m - last_m, travel_m
        error = (1 - accuracy) / (in_row * accuracy + 1 - accuracy)
        if held_m:
            error = (1 - accuracy) / accuracy * since_m / (held_m + since_m)
        if row_left == 0 and travel_m >= until_m:
            if rng.random() >= error:
                labels.append(look.true_label)
                continue
            wrong = str(rng.choice([name for name in names if name != look.true_label]))
            row_left, until_m = in_row, travel_m + held_m * rng.exponential()
        row_left = max(0, row_left - 1)
        labels.append(wrong)
    return labels


def judged(driven, labels, config):
    """Switches, false ones, far ones, and metres late at each true crossing."""
    switch = Switch(str(driven.terrains[0]), Footprint(*FOOTPRINT_M), config)
    looks = {look.step: (look, label) for look, label in zip(driven.looks, labels, strict=True)}
    in_force, events = [], []
    for step, (pose, travel_m) in enumerate(zip(driven.odometer, driven.travel_m, strict=True)):
        if step in looks:
            look, label = looks[step]
            place = se2.transform(pose, look.place_robot)
            place_label = PlaceLabel(label, step * STEP_S, travel_m, place, look.distance_ahead_m)
            switch = switch.add_label(place_label)
        switch = switch.at(step * STEP_S, pose, travel_m)
        in_force.append(switch.in_force)
        events += [(step, switch.event.terrain)] if switch.event else []
    false = sum(is_false(driven, *event) for event in events)
    far = sum(driven.edge_distance_m(step) > NEAR_M for step, _ in events)
    return len(events), false, far, late_m(driven, np.array(in_force))


def is_false(driven, step, terrain):
    """Whether a switch is to a terrain that is not near."""
    along_m = driven.land.along_m(driven.poses[step, :2]) + np.linspace(-FALSE_M, FALSE_M, 11)
    codes = np.searchsorted(driven.land.edges_m, along_m)
    return terrain not in {driven.land.terrains[code] for code in codes}


def late_m(driven, in_force):
    """Metres from each crossing that lasts to its switch; negative where that came before."""
    late = []
    ends = [0, *driven.crossings, len(in_force) - 1]
    for before, crossing, end in zip(ends[:-2], ends[1:-1], ends[2:], strict=True):
        if min(np.diff(driven.travel_m[[before, crossing, end]])) < LASTS_M:
            continue
        right = in_force == driven.terrains[crossing]
        if right[crossing]:
            first = 1 + int(np.flatnonzero(~right[:crossing]).max(initial=-1))
        elif right[crossing:end].any():
            first = crossing + int(np.argmax(right[crossing:end]))
        else:
            late.append(np.inf)
            continue
        late.append(float(driven.travel_m[first] - driven.travel_m[crossing]))
    return late


def row(found, travel_m):
    """One line of the table."""
    switches, false, far = np.sum([numbers[:3] for numbers in found], axis=0)
    late = np.array([metres for numbers in found for metres in numbers[3]])
    low, middle, high = np.quantile(late, [0.05, 0.5, 0.95], method="nearest")
    return (
        f"switches {switches:4d}  false {false:3d} ({100 * false / travel_m:.2f} in 100 m)  "
        f"beyond {NEAR_M} m {far:3d}  true ones late by m {middle:5.2f} [{low:5.2f}, {high:5.2f}], "
        f"within {NEAR_M} m {np.mean(np.abs(late) <= NEAR_M):.2f} of {len(late)}"
    )


if __name__ == "__main__":
    main()
