"""The gap workflow on robots of any size and pace: what it names.

    python -m tests.studies.gap.gap_any_robot [--first-seed 0] [--seeds 60] [--kinds KIND ...]
        [--pairs] [--out gap_any_robot]

Cases come from `tests/blind/any_robot_gap.py`. Each is a row of cases.csv, written as soon as it is
known; cases that are in it are not done again. In every third both runs with the effect are
measured, and pieces of them are held out.
"""

import argparse
import csv
import tempfile
import time
from pathlib import Path

import numpy as np

from odometry.errors import OdometryError
from tests.blind.any_robot_effects import CLEAN, KINDS, NAMED
from tests.blind.any_robot_gap import kind_of, make_case, pair_of
from tests.studies.gap import gap_cases
from tests.studies.gap.gap_table import mistakes_of, table_of

COLUMNS = (*gap_cases.COLUMNS, "track_m", "fastest_m_s", "odometry_hz", "pose_hz", "size", "truth")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=60)
    parser.add_argument("--out", type=Path, default=Path("gap_any_robot"))
    parser.add_argument("--kinds", nargs="*", choices=KINDS, help="each of every seed")
    parser.add_argument("--pairs", action="store_true", help="two kinds at once")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "cases.csv"
    rows = gap_cases.read(file)
    known = {(row["kind"], int(row["seed"])) for row in rows}
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    drawn = pair_of if options.pairs else kind_of
    wanted = [(kind, seed) for seed in seeds for kind in options.kinds or [drawn(seed)]]
    with file.open("a", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        if not rows:
            sheet.writeheader()
        for kind, seed in wanted:
            if (kind, seed) not in known:
                rows.append(study(kind, seed))
                sheet.writerow(rows[-1])
                stream.flush()
                print(*(rows[-1][name] for name in COLUMNS[1:]), sep="  ", flush=True)
    print("\n".join([*table_of(rows), "", *mistakes_of(rows)]))


def study(kind, seed):
    """One case as a row."""
    group = "pairs" if "+" in kind else "clean" if kind in CLEAN else "unnamed"
    group = "named" if kind in NAMED else group
    row = dict.fromkeys(COLUMNS, "") | {"group": group, "kind": kind, "seed": f"{seed}"}
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        try:
            case = make_case(kind, seed, Path(folder))
            row |= {name: f"{value:.3g}" for name, value in case.truth["robot"].items()}
            row["truth"] = str(case.truth["hidden"])
            begin = time.process_time()
            found = gap_cases.answer(case, Path(folder) / "gap", both=seed % 3 == 2)
            row |= gap_cases.judged(case, found)
        except (OdometryError, ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            row |= {"score": "failed", "error": " ".join(str(error).split())[:200]}
        return row | {"cpu_s": f"{time.process_time() - begin:.1f}"}


if __name__ == "__main__":
    main()
