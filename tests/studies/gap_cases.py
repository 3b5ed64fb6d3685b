"""The gap workflow on blind cases: what it names, and how much of the held-out excess it closes.

    python tests/studies/gap_cases.py [--seeds 20] [--kinds KIND ...] [--out gap_cases] [--jobs 2]

Cases come from `tests/blind`, whose generators know nothing of the catalogue of effects. Seeds
take turns at three noise levels of the pose. Every case is a row of cases.csv, written as soon as
it is known; a case that fails is a row, too.
"""

import argparse
import csv
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
from joblib import Parallel, delayed

sys.path.insert(0, str(Path(__file__).parents[2]))

from odometry.errors import OdometryError
from odometry.gap.gap import find_gap
from odometry.run import Run
from tests.blind.cases import KINDS, NAMES, make_case

NOISES = (1.0, 0.5, 2.0)
COLUMNS = (
    *("kind", "seed", "noise", "verdict", "effects", "true", "acceptable", "equivalent"),
    *("before", "after", "floor", "closed", "seconds", "error"),
)


def main() -> None:
    """Run all cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--kinds", nargs="*", default=list(NAMES))
    parser.add_argument("--out", type=Path, default=Path("gap_cases"))
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    wanted = [(kind, seed) for seed in seeds for kind in arguments.kinds]
    rows = []
    with (arguments.out / "cases.csv").open("w", newline="") as stream:
        table = csv.DictWriter(stream, COLUMNS)
        table.writeheader()
        studied = Parallel(n_jobs=arguments.jobs, return_as="generator")
        for row in studied(delayed(study)(kind, seed) for kind, seed in wanted):
            rows.append(row)
            table.writerow(row)
            stream.flush()
            print(*(f"{row[name]}" for name in COLUMNS), sep="  ", flush=True)
    print_table(rows)


def study(kind: str, seed: int) -> dict[str, object]:
    """One case as a row."""
    with tempfile.TemporaryDirectory() as folder:
        case = make_case(kind, seed, Path(folder), noise=NOISES[seed % len(NOISES)])
        row: dict[str, object] = dict.fromkeys(COLUMNS, "")
        row |= {"kind": kind, "seed": seed, "noise": case.noise, "true": "+".join(case.effects)}
        row["acceptable"] = "+".join(case.acceptable)
        begin = time.perf_counter()
        try:
            runs = [Run.read(f) for f in (case.measured, case.calibration, case.holdout)]
            result = find_gap(runs[:1], runs[1:2], runs[2:])
        except (OdometryError, ArithmeticError, np.linalg.LinAlgError) as error:
            return row | {"verdict": "failed", "error": str(error)}
        closing = result.holdout
        return row | {
            "verdict": result.verdict,
            "effects": "+".join(one.effect.name for one in result.added),
            "equivalent": "+".join(one.name for one in result.equivalent),
            "before": round(closing.before.value, 5),
            "after": round(closing.after.value, 5),
            "floor": round(closing.noise_floor.value, 5),
            "closed": round(closing.share_closed, 4),
            "seconds": round(time.perf_counter() - begin, 1),
        }


def print_table(rows: list[dict[str, object]]) -> None:
    """By kind and by group: right names, share of the excess closed, seconds."""
    print(f"{'kind':34} cases  right  all named  closed median [5 %, mean]  seconds median, most")
    for group, kinds in KINDS.items():
        by_kind = defaultdict(list)
        for row in rows:
            if row["kind"] in kinds:
                by_kind[row["kind"]].append(row)
        everything = [row for kind in by_kind.values() for row in kind]
        for kind, of in (*by_kind.items(), (f"ALL {group}", everything)):
            if of:
                print_row(kind, of)


def print_row(kind: str, rows: list[dict[str, object]]) -> None:
    """One line of the table."""
    right = np.mean([is_right(row) for row in rows])
    named = np.mean([set(_names(row["effects"])) >= set(_names(row["true"])) for row in rows])
    closed = np.array([float(row["closed"]) for row in rows if row["closed"] != ""])
    seconds = np.array([float(row["seconds"]) for row in rows if row["seconds"] != ""])
    shares = "-"
    if len(closed) and np.isfinite(closed).any():
        kept = closed[np.isfinite(closed)]
        shares = f"{np.median(kept):.3f} [{np.quantile(kept, 0.05):.3f}, {kept.mean():.3f}]"
    times = f"{np.median(seconds):.1f}, {seconds.max():.1f}" if len(seconds) else "-"
    print(f"{kind:34} {len(rows):5}  {right:5.0%}  {named:9.0%}  {shares:26}  {times}")


def is_right(row: dict[str, object]) -> bool:
    """Whether the verdict is a true effect, or none where there is none."""
    return str(row["verdict"]) in (_names(row["true"]) or ["none"])


def _names(text: object) -> list[str]:
    return [name for name in str(text).split("+") if name]


if __name__ == "__main__":
    main()
