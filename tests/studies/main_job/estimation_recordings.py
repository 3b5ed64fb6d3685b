"""Error of every trajectory on the real recordings with poses, against plain baselines.

    python -m tests.studies.main_job.estimation_recordings [--seven] [--save FILE] [--against FILE]

Needs TERRAIN_ODOMETRY_DATA. Error per metre: over 5 m of wheel travel, a window from every pose,
mean, metres per metre. The ideal drive and the gyroscope with mean wheel speed are computed by
loops of the study's own; the odometer (open loop) and the estimate come out of the program. The
estimate is evaluated on withheld poses: every second second of pose.csv is taken away.
"Ends" is the distance from the last pose. `--against` shows the figures of an earlier run beside.
"""

import argparse
import json
import math
import os
from pathlib import Path as Folder

import numpy as np

from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import (
    outputs_of,
    with_poses_withheld,
    without_gyroscope,
)
from tests.studies.main_job.estimation_reckoning import (
    Path,
    error_per_metre,
    gyroscope_drive,
    ideal_drive,
    position_errors_m,
    reference_path,
    wheel_travel_m,
)

SEVEN = (
    "warthog_grass_20240729_1404",
    "warthog_grass_20240729_1446",
    "warthog_asphalt_20240920_0813",
    "husky_tile_20231212_1616_s00",
    "marmotte_boreal_20240125_1215_s00",
    "warthog_ice_20240730_1630_s00",
    "warthog_gravel_20240806_1137_s00",
)
ROWS = ("ideal", "gyroscope", "odometer_no_gyroscope", "odometer", "estimate_withheld", "estimate")
WORDS = ("ideal", "gyro", "odo -g", "odo", "est wh", "est")
GUARD_S = 0.15  # a withheld pose so near to one that was used says little


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seven", action="store_true", help="only the seven of the final figure")
    parser.add_argument("--save", type=Folder, help="keep the figures here (JSON)")
    parser.add_argument("--against", type=Folder, help="figures of an earlier run")
    arguments = parser.parse_args()
    earlier = json.loads(arguments.against.read_text()) if arguments.against else {}
    found = {}
    for name in recordings(seven=arguments.seven):
        found[name] = figures(Run.read(motion() / name))
        print_row(name, found[name], earlier.get(name))
        if arguments.save:
            arguments.save.write_text(json.dumps(found, indent=1))
    for title, figures_of in (("earlier", earlier), ("now", found)):
        if figures_of:
            print_summary(title, {name: figures_of[name] for name in found if name in figures_of})


def motion():
    return Folder(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"


def recordings(*, seven):
    """The seven first, then all others with poses."""
    others = (folder.parent.name for folder in sorted(motion().glob("*/pose.csv")))
    return SEVEN if seven else (*SEVEN, *(name for name in others if name not in SEVEN))


def figures(run):
    """Errors of all trajectories of one recording, as plain values."""
    reference = reference_path(run)
    start = reference.stamps_s[0], reference.poses[0]
    fewer, withheld = with_poses_withheld(run)
    full, half, blind = (outputs_of(one) for one in (run, fewer, without_gyroscope(run)))
    paths = {
        "ideal": ideal_drive(run, *start),
        "gyroscope": gyroscope_drive(run, *start),
        "odometer_no_gyroscope": blind.paths["odometer"],
        "odometer": full.paths["odometer"],
        "estimate_withheld": half.paths["estimate"],
        "estimate": full.paths["estimate"],
    }
    unseen = withheld_reference(run, fewer, withheld)
    result = {"events": full.events, "events_withheld": half.events}
    for name, path in paths.items():
        judge = unseen if name == "estimate_withheld" else reference
        distances = position_errors_m(path, judge)
        result[name] = {
            "per_metre": error_per_metre(path, judge, wheel_travel_m(run, judge.stamps_s)),
            "mean_m": float(distances.mean()),
            "final_m": float(distances[-1]),
        }
    result["program"] = {
        name: [errors["translation_m_per_m"]["mean"], errors["position_m"]["final"]]
        for name, errors in full.result["errors"].items()
    }
    return result


def withheld_reference(run, fewer, withheld):
    """Poses that were taken away and do not lie next to one that was used."""
    stamps_s, used_s = run.pose.stamps_s, fewer.pose.stamps_s
    distance_s = np.abs(stamps_s[:, None] - used_s[None, :]).min(axis=1)
    poses = run.pose.stack("x", "y", "yaw")
    first_s, last_s = run.odometry.stamps_s[[0, -1]]
    chosen = withheld & (distance_s > GUARD_S) & np.isfinite(poses).all(axis=1)
    chosen &= (first_s <= stamps_s) & (stamps_s <= last_s)
    return Path(stamps_s[chosen], poses[chosen])


def print_row(name, now, earlier):
    if earlier:
        print_line(f"{name}  earlier", earlier)
    print_line(f"{name}{'  now' if earlier else ''}", now)
    kinds = sorted({event["kind"] for event in now["events"]})
    kinds_withheld = sorted({event["kind"] for event in now["events_withheld"]})
    print(f"    flagged: {', '.join(kinds) or 'nothing'}; "
          f"with poses withheld: {', '.join(kinds_withheld) or 'nothing'}")  # fmt: skip


def print_line(title, one):
    errors = "  ".join(f"{w} {one[r]['per_metre']:.3f}" for r, w in zip(ROWS, WORDS, strict=True))
    ends = "  ".join(f"{w} {one[r]['final_m']:.2f}" for r, w in zip(ROWS, WORDS, strict=True))
    print(f"{title}\n    per m: {errors}\n    ends m: {ends}", flush=True)


def print_summary(title, found):
    print(f"\n{title}: {len(found)} recordings")
    for row in ("odometer_no_gyroscope", "odometer"):
        for names in (SEVEN, [name for name in found if name not in SEVEN]):
            ratios = [
                found[n][row]["per_metre"] / found[n]["gyroscope"]["per_metre"]
                for n in names
                if n in found
            ]
            if ratios:
                mean = math.exp(np.mean(np.log(ratios)))
                print(f"  {row} by gyroscope with mean speed, {len(ratios)} recordings: "
                      f"geometric mean {mean:.2f}, worst {max(ratios):.2f}")  # fmt: skip
    for row, events in (("estimate", "events"), ("estimate_withheld", "events_withheld")):
        worse = [n for n in found if found[n][row]["final_m"] > found[n]["ideal"]["final_m"]]
        print(f"  {row} ends farther off than the ideal drive: "
              f"{[(n, 'says so' if found[n][events] else 'SILENT') for n in worse]}")  # fmt: skip
    off = [program_difference(found[name]) for name in found]
    print(f"  largest difference of final positions, program's rows against the loops: {max(off)}")


def program_difference(one):
    """Largest difference in metres of the rows that both compute, and of which row."""
    pairs = (("ideal", "differential_drive"), ("gyroscope", "gyroscope"), ("odometer", "odometer"))
    there = [(mine, theirs) for mine, theirs in pairs if theirs in one["program"]]
    return max(
        (round(abs(one["program"][theirs][1] - one[mine]["final_m"]), 3), theirs)
        for mine, theirs in there
    )


if __name__ == "__main__":
    main()
