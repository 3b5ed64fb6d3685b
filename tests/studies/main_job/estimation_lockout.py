"""Whether poses that are few, late or noisy lock the filter out: the estimate against ideal drive.

    python -m tests.studies.main_job.estimation_lockout [--only NAME ...] [--save FILE]

Needs TERRAIN_ODOMETRY_DATA. On recordings of fast drives and of ice, pose.csv is thinned, delayed
and made noisy; the estimate is evaluated on all recorded poses. "Worse" is farther off than the
ideal drive, at the end or in the mean; it is allowed only where an event of the filter says so.
"""

import argparse
import json
from dataclasses import replace
from pathlib import Path as Folder

import numpy as np

from odometry.recording.run import Run
from tests.studies.main_job.estimation_outputs import outputs_of, with_columns, with_rows
from tests.studies.main_job.estimation_reckoning import (
    ideal_drive,
    position_errors_m,
    reference_path,
)
from tests.studies.main_job.estimation_recordings import motion

FAST = (
    "warthog_ice_20240730_1630_s00",
    "warthog_ice_20240730_1630_s02",
    "warthog_ice_20240730_1630_s04",
    "warthog_gravel_20240806_1137_s00",
    "warthog_sand_20240925_1413_s00",
    "warthog_sand_20240925_1413_s02",
    "warthog_asphalt_fast_20240807_1130_s01",
    "warthog_2023_s00",
    "husky_2023_s02",
)
VARIANTS = {
    "as recorded": {},
    "1 Hz": {"period_s": 1.0},
    "0.2 Hz": {"period_s": 5.0},
    "0.3 s late": {"late_s": 0.3},
    "1 Hz, 0.5 s late": {"period_s": 1.0, "late_s": 0.5},
    "noise of 0.5 m": {"sigma_m": 0.5},
    "1 Hz, noise of 1 m": {"period_s": 1.0, "sigma_m": 1.0},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", default=FAST)
    parser.add_argument("--save", type=Folder)
    arguments = parser.parse_args()
    rows = []
    for name in arguments.only:
        run = Run.read(motion() / name)
        for title, change in VARIANTS.items():
            rows.append({"name": name, "variant": title, **compared(run, **change)})
            print_row(rows[-1])
            if arguments.save:
                arguments.save.write_text(json.dumps(rows, indent=1))
    worse = [row for row in rows if is_worse(row)]
    silent = sum(not row["kinds"] for row in worse)
    print(f"worse than the ideal drive: {len(worse)} of {len(rows)}, {silent} of them silent")


def compared(run, *, period_s=0.0, late_s=0.0, sigma_m=0.0):
    """Errors of the estimate on changed poses, and of the ideal drive, on all recorded poses."""
    reference = reference_path(run)
    rng, t = np.random.default_rng(7), run.pose.stamps_s
    kept = np.append(True, np.diff(np.floor(t / period_s)) > 0) if period_s else np.isfinite(t)
    noisy = {name: run.pose[name] + rng.normal(0, 1, len(t)) * sigma_m for name in ("x", "y")}
    pose = with_rows(with_columns(run.pose, t=t + late_s, **noisy), kept)
    outputs = outputs_of(replace(run, pose=pose))
    paths = {
        "estimate": outputs.paths["estimate"],
        "ideal": ideal_drive(run, reference.stamps_s[0], reference.poses[0]),
    }
    distances = {name: position_errors_m(path, reference) for name, path in paths.items()}
    filter_of = outputs.result["filter"]
    return {
        "kinds": outputs.kinds,
        "refused": [filter_of["poses_refused"], filter_of["poses"]],
        **{f"{name}_mean_m": float(d.mean()) for name, d in distances.items()},
        **{f"{name}_end_m": float(d[-1]) for name, d in distances.items()},
    }


def is_worse(row):
    return any(row[f"estimate_{what}_m"] > row[f"ideal_{what}_m"] for what in ("mean", "end"))


def print_row(row):
    refused, poses = row["refused"]
    print(f"{row['name'][:34]:34} {row['variant']:20} estimate mean {row['estimate_mean_m']:6.2f} "
          f"end {row['estimate_end_m']:6.2f}  ideal mean {row['ideal_mean_m']:6.2f} end "
          f"{row['ideal_end_m']:6.2f}  refused {refused}/{poses} "
          f"{'WORSE ' if is_worse(row) else ''}{', '.join(row['kinds'])}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
