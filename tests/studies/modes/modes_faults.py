"""Modes under faults that begin at some moment of a run: how often a wrong mode is named.

    python -m tests.studies.modes.modes_faults --folder FOLDER [--seeds 10 11] [--faults KEY ...]
        [--worlds NAME ...] [--name answers]
        [--without-poses]

Robots, modes, drives and faults are those of tests/blind/modes, which know nothing of how modes are
recognised. Modes are identified on a minute or two in each; every run changes between two of them,
and the fault begins later. Shares are of the time from its onset to the end (of the whole run where
clean): with a mode named that is not the true one (`wrong`), with the true one (`right`), with
`none of these`, with `undetermined`; of that with the true mode among candidates that are fewer
than all (`narrowed`). On a terrain that is no mode, any mode is wrong. Simulated runs are kept in
FOLDER; every run is a row of FOLDER/NAME.csv. Faults that were made later are not run unless
they are named (`--faults further_cable_dragged robot_payload_shifts ...`).
"""

import argparse
import csv
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.modes.follow.answers import candidates, named_modes
from odometry.modes.follow.track import ModesConfig, follow_modes
from odometry.modes.identify.identify_traction import identify_traction_modes
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.mode_set import DWELL_S, NONE_OF_THESE, UNDETERMINED, ModeSet
from odometry.recording.run import Run
from tests.blind.modes.faults import NAMED, OWN, make_case, possible
from tests.blind.modes.more_faults import MORE
from tests.blind.modes.worlds import World, calibration_runs, worlds

IDENTIFY = {"velocity": identify_velocity_modes, "traction": identify_traction_modes}
SHARES = ("wrong", "right", "none", "undetermined", "narrowed")
COLUMNS = ("world", "fault", "seed", *SHARES)
MOST_MEAN, MOST_WORST = 0.05, 0.15  # of the time with a wrong name


def main() -> None:
    """Follow every run and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--seeds", type=int, nargs="*", default=[10, 11])
    parser.add_argument("--worlds", nargs="*", default=list(worlds()))
    parser.add_argument("--faults", nargs="*", default=["clean", *NAMED, *OWN, *MORE])
    parser.add_argument("--name", default="answers")
    parser.add_argument("--without-poses", action="store_true", help="runs have no pose.csv")
    arguments = parser.parse_args()
    rows: list[dict[str, object]] = []
    arguments.folder.mkdir(parents=True, exist_ok=True)
    with (arguments.folder / f"{arguments.name}.csv").open("w", newline="") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        sheet.writeheader()
        for key in arguments.worlds:
            world = worlds()[key]
            mode_set = identified(world, arguments.folder / key / "calibration")
            for seed in arguments.seeds:
                for fault in arguments.faults:
                    if not possible(world, fault):
                        continue
                    case = make_case(world, fault, seed, arguments.folder / key / str(seed))
                    from_s = -np.inf if fault == "clean" else case.onset_s
                    run = Run.read(case.folder)
                    if arguments.without_poses:
                        run = replace(run, pose=None)
                    shares = judged(run, mode_set, from_s)
                    rows.append({"world": key, "fault": fault, "seed": seed} | shares)
                    sheet.writerow(rows[-1])
                    stream.flush()
    print_tables(rows, arguments.faults, arguments.worlds)


def identified(world: World, folder: Path) -> ModeSet:
    """Modes of a world from its calibration runs, which are made where they are missing."""
    if not folder.exists():
        calibration_runs(world, folder)
    runs = [Run.read(one) for one in sorted(folder.iterdir())]
    modes = IDENTIFY[world.kind](runs)
    return ModeSet(modes, np.full(len(modes.names), DWELL_S))


def judged(run: Run, mode_set: ModeSet, from_s: float) -> dict[str, float]:
    """Shares of the time from a moment on."""
    config = ModesConfig()
    track = follow_modes(run, mode_set, config)
    answers = named_modes(track, config.sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0) * (track.stamps_s >= from_s)
    none, open_ = answers == NONE_OF_THESE, answers == UNDETERMINED
    right = answers == track.labels
    among = candidates(track, config.sure)
    is_true = track.labels[:, None] == np.array(track.names, dtype=object)
    narrowed = open_ & (among & is_true).any(axis=1) & ~among.all(axis=1)
    chosen = (~(none | open_ | right), right, none, open_, narrowed)
    return {
        name: float(lasts_s @ of / lasts_s.sum()) for name, of in zip(SHARES, chosen, strict=True)
    }


def print_tables(
    rows: Sequence[dict[str, object]], faults: Sequence[str], keys: Sequence[str]
) -> None:
    """Means by fault, wrong by world, and whether the marks are met."""
    print(f"{'fault':18}" + "".join(f"{name:>13}" for name in (*SHARES, "worst")), end="  | ")
    print(" ".join(f"{key[:10]:>10}" for key in keys))
    for fault in faults:
        of = [row for row in rows if row["fault"] == fault]
        if not of:
            continue
        means = [np.mean([float(str(row[name])) for row in of]) for name in SHARES]
        worst = max(float(str(row["wrong"])) for row in of)
        print(f"{fault:18}" + "".join(f"{100 * v:12.1f}%" for v in (*means, worst)), end="  | ")
        for key in keys:
            here = [
                100 * float(str(row["right" if fault == "clean" else "wrong"]))
                for row in of
                if row["world"] == key
            ]
            print(f"{np.mean(here) if here else np.nan:10.1f}", end=" ")
        print()
    for title, group in (("named", NAMED), ("own", OWN), ("more", tuple(MORE))):
        each = [
            np.mean([float(str(row["wrong"])) for row in rows if row["fault"] == fault])
            for fault in group
            if any(row["fault"] == fault for row in rows)
        ]
        if each:
            print(
                f"{title}: wrong {100 * np.mean(each):.1f} % in the mean over faults, "
                f"{100 * np.max(each):.1f} % at worst (marks: {100 * MOST_MEAN:g} and "
                f"{100 * MOST_WORST:g} %)"
            )


if __name__ == "__main__":
    main()
