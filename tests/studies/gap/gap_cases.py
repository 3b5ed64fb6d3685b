"""The gap workflow on blind cases: what it names, and how much of the held-out excess it closes.

    python -m tests.studies.gap.gap_cases [--seeds 20] [--group seen slips] [--kinds KIND ...]
        [--first-seed 0] [--out gap_cases] [--jobs 2] [--both]

Cases come from `tests/blind`, whose generators know nothing of the catalogue of effects. Seeds
take turns at three noise levels of the pose. Every case is a row of cases.csv, written as soon as
it is known; a case that fails is a row, too. Cases that are in cases.csv are not done again.
"""

import argparse
import csv
import json
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from odometry.errors import OdometryError
from odometry.gap.gap import find_gap
from odometry.gap.show.files import write_gap
from odometry.recording.run import Run
from tests.blind.cases import KINDS, NAMES, Case, make_case
from tests.studies.gap.gap_names import all_named, course_of, score
from tests.studies.gap.gap_table import mistakes_of, table_of

NOISES = (1.0, 0.5, 2.0)
COLUMNS = (
    *("group", "kind", "seed", "noise", "gyroscope", "score", "verdict", "form", "effects"),
    *(
        "equivalent",
        "true",
        "acceptable",
        "course",
        "all_named",
        "course_right",
        "named_equivalent",
    ),
    *("before", "after", "floor", "worse", "closed", "cpu_s", "error"),
)


def main() -> None:
    """Run the cases that are not known yet and print the table of all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--group", nargs="*", choices=tuple(KINDS), default=list(KINDS))
    kinds_help = "instead of groups; a name that does not exist lists them all"
    parser.add_argument("--kinds", nargs="*", choices=NAMES, metavar="KIND", help=kinds_help)
    parser.add_argument("--out", type=Path, default=Path("gap_cases"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument(
        "--both", action="store_true", help="Measure on both runs, and hold out pieces of them."
    )
    arguments = parser.parse_args()
    kinds = arguments.kinds or [kind for group in arguments.group for kind in KINDS[group]]
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = arguments.out / "cases.csv"
    rows = read(file)
    known = {(row["kind"], int(row["seed"])) for row in rows}
    wanted = [(kind, seed) for seed in seeds for kind in kinds if (kind, seed) not in known]
    with file.open("a", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        if not rows:
            sheet.writeheader()
        studied = Parallel(n_jobs=arguments.jobs, return_as="generator")
        for row in studied(
            delayed(study)(kind, seed, both=arguments.both) for kind, seed in wanted
        ):
            rows.append(row)
            sheet.writerow(row)
            stream.flush()
            print(*(row[name] for name in (*COLUMNS[1:9], *COLUMNS[-7:])), sep="  ", flush=True)
    asked = [row for row in rows if row["kind"] in kinds]
    print("\n".join([*table_of(asked), "", *mistakes_of(asked)]))


def read(file: Path) -> list[dict[str, str]]:
    """Rows that are known already."""
    if not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def study(kind: str, seed: int, *, both: bool = False) -> dict[str, str]:
    """One case as a row."""
    noise = NOISES[seed % len(NOISES)]
    row = dict.fromkeys(COLUMNS, "") | {"kind": kind, "seed": f"{seed}", "noise": f"{noise}"}
    row["group"] = next(group for group, kinds in KINDS.items() if kind in kinds)
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        try:
            case = make_case(kind, seed, Path(folder), noise=noise)
            begin = time.process_time()
            found = answer(case, Path(folder) / "gap", both=both)
        except (OdometryError, ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            spent = f"{time.process_time() - begin:.1f}"
            return row | {"score": "failed", "error": _line(error), "cpu_s": spent}
        return row | judged(case, found) | {"cpu_s": f"{time.process_time() - begin:.1f}"}


def answer(case: Case, out: Path, *, both: bool = False) -> dict[str, Any]:
    """gap.json of a case; where both runs with the effect are measured, pieces are held out."""
    measured, calibration, holdout = (
        [Run.read(folder)] for folder in (case.measured, case.calibration, case.holdout)
    )
    if both:
        measured, holdout = [*measured, *holdout], []
    write_gap(find_gap(measured, calibration, holdout), out)
    result: dict[str, Any] = json.loads((out / "gap.json").read_text(encoding="utf-8"))
    return result


def judged(case: Case, found: dict[str, Any]) -> dict[str, str]:
    """Cells of a case and what was answered."""
    named = [(one["name"], course_of(one["form"])) for one in found["effects"]]
    verdict = found["verdict"]
    course = next((course for name, course in named if name == verdict), "")
    others = [(one["name"], "") for one in found["equivalent"]]
    held = found["turns"]["holdout"] if found["turns"] else found["holdout"]
    share = held["share_closed"]
    return {
        "gyroscope": f"{int(case.gyroscope)}",
        "score": score(
            verdict, course, case.parts, case.acceptable_families, [name for name, _ in others]
        ),
        "verdict": verdict,
        "form": "; ".join(one["form"] for one in found["effects"]),
        "effects": "+".join(name for name, _ in named),
        "equivalent": "+".join(name for name, _ in others),
        "true": "+".join("|".join(part) for part in case.parts),
        "acceptable": "|".join(case.acceptable_families),
        "course": case.course,
        "all_named": f"{int(all_named(named, case.parts))}",
        "course_right": f"{int(course == case.course)}",
        "named_equivalent": f"{int(bool(case.parts) and all_named(named + others, case.parts))}",
        "before": f"{held['before']:.5f}",
        "after": f"{held['after']:.5f}",
        "floor": f"{held['noise_floor']:.5f}",
        "worse": f"{int(bool(named) and found['holdout']['after'] > found['holdout']['before'])}",
        "closed": "" if share is None else f"{share:.4f}",
    }


def _line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]


if __name__ == "__main__":
    main()
