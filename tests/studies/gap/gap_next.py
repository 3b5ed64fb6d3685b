"""What to drive next: whether driving it distinguishes rivals, on blind cases of rivals.

    python -m tests.studies.gap.gap_next [--seeds 1] [--first-seed 0] [--pairs NAME ...]
        [--out gap_next] [--jobs 2]

`tests/blind/rivals` writes runs about which two hypotheses say the same; one of them is the truth.
The gap workflow proposes a drive in words; it is driven with the truth for as long as it is meant
to last, and the workflow is asked again with it. They are apart where the first name is then
right and the rival is not among the equivalents of the data: one that has the equations of the
name, as slip has those of one factor of both wheels, stays beside it on any drive. A row of
FOLDER/cases.csv is a case; cases that are in it are not done again.
"""

import argparse
import csv
import json
import math
import re
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
from tests.blind.rivals.cases import EVERY_PAIR, RivalCase, make_rivals
from tests.blind.rivals.drives import Proposal
from tests.studies.gap.gap_cases import read
from tests.studies.gap.gap_names import MEANING, score
from tests.studies.gap.gap_table import with_interval

SHAPES = {
    "spins": "spins",
    "circles": "circles",
    "straights with steps": "steps",
    "curves with steps": "curves",
}
# What no drive distinguishes, by the equations: an arm ahead moves the sensor as ICRs behind move
# the robot; a constant loss of traction is a change of the ICRs, and one of distance alone a map of
# another scale; without gyroscope commands that are late are stamps that are late.
ALIKE = {
    "sensor place": ("sideways",),
    "sideways": ("sensor place",),
    "traction": ("terrain", "reference"),
}
ALIKE_WITHOUT_GYROSCOPE = {
    "late stamps": ("late commands",),
    "late commands": ("late stamps",),
}
OF_SLOPE = {"roll", "pitch"}  # the catalogue has no law of a share of the slope
COLUMNS = (
    *("pair", "truth", "seed", "true", "rival", "first", "equivalent", "proposed", "between"),
    *("odds", "then", "then_equivalent", "score", "apart", "cpu_s", "error"),
)


def main() -> None:
    """Run the cases that are not known yet, and count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--pairs", nargs="*", choices=tuple(EVERY_PAIR), default=list(EVERY_PAIR))
    parser.add_argument("--out", type=Path, default=Path("gap_next"))
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = arguments.out / "cases.csv"
    rows = read(file)
    known = {(row["pair"], row["truth"], row["seed"]) for row in rows}
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    every = [(pair, truth, seed) for seed in seeds for pair in arguments.pairs for truth in (0, 1)]
    wanted = [one for one in every if (one[0], str(one[1]), str(one[2])) not in known]
    with file.open("a", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        if not rows:
            sheet.writeheader()
        studied = Parallel(n_jobs=arguments.jobs, return_as="generator")
        for row in studied(delayed(study)(*one) for one in wanted):
            rows.append(row)
            sheet.writerow(row)
            stream.flush()
            print(*row.values(), sep="  ", flush=True)
    for words, of in counted(rows).items():
        print(f"{words}: {of}")


def study(pair: str, truth: int, seed: int) -> dict[str, str]:
    """One case as a row."""
    row = dict.fromkeys(COLUMNS, "") | {"pair": pair, "truth": f"{truth}", "seed": f"{seed}"}
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            case = make_rivals(pair, truth, seed, folder)
            row |= judged(case, folder)
        except (OdometryError, ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            row |= {"score": "failed", "error": " ".join(str(error).split())[:200]}
    return row | {"cpu_s": f"{time.process_time() - begin:.1f}"}


def judged(case: RivalCase, folder: Path) -> dict[str, str]:
    """Cells of what was answered before and after the proposed drive."""
    found = answer(case, [case.measured], folder / "gap")
    row = {
        "true": case.true,
        "rival": case.rival,
        "first": found["verdict"],
        "equivalent": names(found),
    }
    if not found["next_drives"]:
        return row | apart(case, found)
    proposed = found["next_drives"][0]
    driven = case.drive(proposal_of(proposed["words"]), folder / "driven")
    then = answer(case, [case.measured, driven], folder / "then")
    return row | {
        "proposed": proposed["words"],
        "between": "+".join(proposed["between"]),
        "odds": f"{proposed['odds']:.3f}",
        "then": then["verdict"],
        "then_equivalent": names(then),
        **apart(case, then),
    }


def apart(case: RivalCase, found: dict[str, Any]) -> dict[str, str]:
    """Score of the first name, and whether it is right and the rival is out."""
    alike = ALIKE.get(case.true, ())
    if not case.drawn.scene.sensors.gyroscope:
        alike = (*alike, *ALIKE_WITHOUT_GYROSCOPE.get(case.true, ()))
    true = ((case.true, *alike),)
    near = [one["name"] for one in found["equivalent"]]
    scored = score(named(case, found), "", true, (), near)
    data = [one["name"] for one in found["equivalent"] if not one["by_equation"]]
    rivals = set(data) & set(MEANING[case.rival])
    return {"score": scored, "apart": f"{int(scored == 'right' and not rivals)}"}


def named(case: RivalCase, found: dict[str, Any]) -> str:
    """The verdict; of a slope without a law in the catalogue, what depends on attitude is it."""
    follows = {one.get("variable") for one in found["effects"][:1]}
    of_slope = found["verdict"] == "unknown" and follows <= OF_SLOPE and follows
    return "slope_sliding" if of_slope and case.true == "slope" else str(found["verdict"])


def answer(case: RivalCase, measured: list[Path], out: Path) -> dict[str, Any]:
    """gap.json of a case with these measured runs."""
    runs = [Run.read(folder) for folder in (*measured, case.calibration, case.holdout)]
    write_gap(find_gap(runs[:-2], runs[-2:-1], runs[-1:]), out)
    result: dict[str, Any] = json.loads((out / "gap.json").read_text(encoding="utf-8"))
    return result


def names(found: dict[str, Any]) -> str:
    """Names of the equivalents."""
    return "+".join(one["name"] for one in found["equivalent"])


def proposal_of(words: str) -> Proposal:
    """A drive of a minute from the words of a proposal.

    Raises
    ------
    ValueError
        If the words begin with none of `SHAPES`, or a number is missing.
    """
    shape = next((shape for begin, shape in SHAPES.items() if words.startswith(begin)), None)
    numbers = {
        unit: re.search(rf"([\d.]+) {unit}", words) for unit in ("m radius", "m/s", "degrees")
    }
    speed, radius = numbers["m/s"], numbers["m radius"]
    if shape == "circles" and "steps" in words:
        shape = "stepped circles"
    if shape is None or speed is None or ("circles" in shape and radius is None):
        raise ValueError(f"words = {words!r}, expected one of {', '.join(SHAPES)} with a speed")
    slope = numbers["degrees"]
    return Proposal(
        shape,
        speed_m_s=float(speed[1]),
        radius_m=float(radius[1]) if radius else 0.0,
        slope_rad=math.radians(float(slope[1])) if slope else 0.0,
    )


def counted(rows: list[dict[str, str]]) -> dict[str, str]:
    """Shares with 95 % intervals."""
    proposed = [row for row in rows if row["proposed"]]
    after = sum(row["apart"] == "1" for row in proposed)
    at_all = sum(row["apart"] == "1" for row in rows)
    wrong = sum(row["score"] == "wrong" for row in rows)
    return {
        "a drive proposed, %": with_interval(len(proposed), len(rows)),
        "then apart, % of those": with_interval(after, len(proposed)),
        "apart in the end, %": with_interval(at_all, len(rows)),
        "wrong first name in the end, %": with_interval(wrong, len(rows)),
    }


if __name__ == "__main__":
    main()
