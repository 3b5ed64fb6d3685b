"""What faults of a drive do to odometer and estimate, and what the filter says of them.

    python -m tests.studies.main_job.estimation_faults [--only KEY ...] [--bases NAME ...]
        [--seeds 1]
        [--half] [--save FILE] [--against FILE]
        [--scratch FOLDER]

Needs TERRAIN_ODOMETRY_DATA. Faults come from tests/blind/estimation, at random moments; half of
them and more the project's issue does not name. Errors are distances from the clean reference.
Bounded: nowhere farther off than the clean run's largest error, 0.3 m, the size of what the poses
claim, and SHARE of the wheel travel where the robot must reckon, together. Flagged: an event of
a right kind in `filter.events`, while the fault acts or up to 30 s later. False: events of runs
without a fault.
"""

import argparse
import json
import os
import re
import tempfile
from dataclasses import replace
from pathlib import Path as Folder

import numpy as np
from tqdm import tqdm

from odometry.errors import OdometryError
from odometry.recording.run import Run
from tests.blind.estimation.case import SHARE, acts, reference_of, travel_m
from tests.blind.estimation.catalogue import FAULTS, make_case
from tests.blind.faults.recordings import write_recording
from tests.studies.main_job.estimation_bases import bases
from tests.studies.main_job.estimation_outputs import outputs_of
from tests.studies.main_job.estimation_reckoning import Path, position_errors_m

SLACK_M = 0.3
EARLY_S, LATE_S = 1.0, 30.0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", default=list(FAULTS), choices=list(FAULTS))
    parser.add_argument("--bases", nargs="+", default=None)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--half", action="store_true", help="each fault on every second recording")
    parser.add_argument("--save", type=Folder, help="keep the figures here (JSON)")
    parser.add_argument("--against", type=Folder, help="figures of an earlier run")
    parser.add_argument("--scratch", type=Folder, default=None, help="keep simulated runs here")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scratch = arguments.scratch or Folder(folder)
        recordings = bases(os.environ["TERRAIN_ODOMETRY_DATA"], scratch, arguments.bases)
        found = study(recordings, arguments)
    if arguments.against:
        print("\nearlier, the same cases")
        print_table(same_cases(json.loads(arguments.against.read_text()), found))
    print("\nnow")
    print_table(found)


def study(recordings, arguments):
    """Clean rows by base, and one row a case; saved after each fault."""
    found = {"clean": {name: judged(clean_case(r)) for name, r in recordings.items()}, "rows": []}
    for key in tqdm(arguments.only, "faults"):
        for name in (
            list(recordings)[list(FAULTS).index(key) % 2 :: 2] if arguments.half else recordings
        ):
            for seed in range(arguments.seeds):
                case = make_case(FAULTS[key], recordings[name], name, seed)
                if case is not None:
                    row = judged(case) | {"key": key, "base": name, "seed": seed}
                    found["rows"].append(
                        row | verdicts(FAULTS[key], case, row, found["clean"][name])
                    )
        if arguments.save:
            arguments.save.write_text(json.dumps(found, indent=1))
    return found


def same_cases(earlier, found):
    """Rows of an earlier run whose case was drawn again."""
    drawn = {(row["key"], row["base"], row["seed"]) for row in found["rows"]}
    rows = [r for r in earlier["rows"] if (r["key"], r["base"], r["seed"]) in drawn]
    return {"clean": earlier["clean"], "rows": rows}


def clean_case(recording):
    t = recording["odometry"]["t"]
    return acts(recording, t[0], t[-1], reference=reference_of(recording))


def judged(case):
    """Errors of both trajectories, or the refusal."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            run = Run.read(write_recording(case.recording, Folder(folder) / "run"))
            truth = replace(run.pose, columns=case.reference)  # read for the program's own scores
            outputs = outputs_of(replace(run, truth=truth))
    except OdometryError as error:
        return {"refused": str(error)}
    row = {"events": outputs.events, "begin_s": case.begin_s, "end_s": case.end_s}
    reference = judged_reference(case, outputs.paths["estimate"])
    for name, path in outputs.paths.items():
        distances = position_errors_m(path, reference)
        row[name] = {
            "mean_m": float(distances.mean()),
            "end_m": float(distances[-1]),
            "largest_m": float(distances.max()),
        }
    return row


def judged_reference(case, path):
    """Where the robot was, at the stamps that the trajectory covers."""
    t = case.reference["t"]
    poses = np.stack([case.reference[name] for name in ("x", "y", "yaw")], axis=-1)
    chosen = (path.stamps_s[0] <= t) & (t <= path.stamps_s[-1]) & np.isfinite(poses).all(axis=1)
    return Path(t[chosen], poses[chosen])


def verdicts(fault, case, row, clean):
    """Whether the estimate stayed bounded, and whether a right kind was flagged in time."""
    if "refused" in row or "refused" in clean:
        return {"bounded": False, "flagged": False, "bound_m": None}
    bound = clean["estimate"]["largest_m"] + SLACK_M + case.size_m
    if case.reckons:
        bound += SHARE * travel_m(case.recording, case.begin_s, case.end_s)
    events = [
        event
        for event in row["events"]
        if re.search(fault.kinds, event["kind"].replace("_", " "), re.IGNORECASE)
        and event["begin_s"] <= case.end_s + LATE_S
        and event["end_s"] >= case.begin_s - EARLY_S
    ]
    return {
        "bounded": row["estimate"]["largest_m"] <= bound,
        "bound_m": bound,
        "flagged": bool(events),
    }


def print_table(found):
    print(f"{'':20} cases  estimate mean  end     largest     odometer end    bounded flagged")
    keys = list(dict.fromkeys(row["key"] for row in found["rows"]))
    for named in (True, False):
        print("named by the issue:" if named else "not named:")
        for key in keys:
            if FAULTS[key].named == named:
                print_fault(key, found)
    rows = [row for row in found["rows"] if "refused" not in row]
    needed = [row for row in rows if FAULTS[row["key"]].flag]
    print(f"bounded {sum(r['bounded'] for r in rows)} of {len(found['rows'])}; flagged, where "
          f"silence is wrong, {sum(r['flagged'] for r in needed)} of {len(needed)}; unbounded and "
          f"silent {sum(not r['bounded'] and not r['events'] for r in rows)}")  # fmt: skip
    for name, row in found["clean"].items():
        print(f"clean {name}: estimate {spread(row['estimate'])}, odometer end "
              f"{row['odometer']['end_m']:.2f} m, false flags: {kinds_of([row])}")  # fmt: skip


def print_fault(key, found):
    rows = [row for row in found["rows"] if row["key"] == key]
    judged_rows = [row for row in rows if "refused" not in row]
    if not judged_rows:
        print(f"{key:20} {len(rows)} refused: {rows[0]['refused'] if rows else ''}")
        return
    cells = []
    for trajectory, statistic in COLUMNS:
        with_fault = np.mean([row[trajectory][statistic] for row in judged_rows])
        without = np.mean(
            [found["clean"][row["base"]][trajectory][statistic] for row in judged_rows]
        )
        cells.append(f"{without:.2f}>{with_fault:.2f}")
    bounded, flagged = (sum(row[name] for row in judged_rows) for name in ("bounded", "flagged"))
    print(f"{key:20} {len(rows):3}  {'  '.join(f'{cell:>12}' for cell in cells)}  "
          f"{bounded}/{len(rows)}  {flagged}/{len(rows)}  {kinds_of(judged_rows)}")  # fmt: skip


COLUMNS = (
    ("estimate", "mean_m"),
    ("estimate", "end_m"),
    ("estimate", "largest_m"),
    ("odometer", "end_m"),
)


def spread(errors):
    return f"mean {errors['mean_m']:.2f} largest {errors['largest_m']:.2f} m"


def kinds_of(rows):
    """Kinds of events, and in how many of the rows each stands."""
    kinds = [kind for row in rows for kind in {event["kind"] for event in row["events"]}]
    counts = sorted({(kind, kinds.count(kind)) for kind in kinds}, key=lambda pair: -pair[1])
    return ", ".join(f"{kind} {count}" for kind, count in counts) or "none"


if __name__ == "__main__":
    main()
