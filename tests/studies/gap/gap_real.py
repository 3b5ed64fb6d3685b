"""The gap workflow on real recordings: what it names, what that closes, what it leaves unknown.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.gap.gap_real [--out gap_real]
        [--only WORD ...]

Four kinds of cases, on recordings with a pose, each terrain as INDEX.csv names it:

- real: nothing was done to the data. The Husky on tile with a base that is given x_icr = 0; the
  Warthog on the steepest grass recorded; the Marmotte, one sequence each to calibrate, measure
  and evaluate;
- withheld: a terrain that the calibration never saw, joined with one that it did; stamps of the
  poses late by 0.15 s; roll and pitch taken out of a run on a slope;
- control: each recording by halves, calibrated on one half and measured on the other, both ways
  round. The robot, terrain and hour are the same, so that a name is a false one, or an effect that
  came up within minutes;
- changed: the same first halves, and second halves changed by hand (`gap_real_changes`).

Windows last 1.5 s: the lidar poses of most recordings are chained in stretches of 2 s, of which a
window of the usual 2 s would leave one pose in three.

Every case is a row of FOLDER/cases.csv, written as soon as it is known, and a page
FOLDER/CASE/report.html (controls have none); at the end the table goes to FOLDER/gap_real.md.
"""

import argparse
import csv
import os
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from odometry.effects.unknown.residual import Residual
from odometry.errors import OdometryError
from odometry.gap.answer.result import GapResult, NamedEffect
from odometry.gap.config import GapConfig
from odometry.gap.gap import find_gap
from odometry.gap.prepare.measured import measured_of
from odometry.gap.show.files import write_gap
from odometry.gap.show.quantities import held_out_share, percent, with_interval
from odometry.gap.show.words import parameter_words
from odometry.io.files import atomic_write
from odometry.report.gap.gap_page import write_gap_report
from tests.studies.gap.gap_real_cases import Case, controls, real, recordings, withheld
from tests.studies.gap.gap_real_changes import changed, count_of_changes, made_m

CONFIG = GapConfig(horizon_s=1.5)
SAID = 3  # parameters of an effect that are printed
COLUMNS = (
    *("kind", "case", "expected", "windows", "verdict", "effects", "parameters", "equivalent"),
    *(
        "evidence",
        "before",
        "after",
        "floor",
        "ratio",
        "made",
        "closed",
        "chi_squared",
        "latency_s",
        "seconds",
        "error",
    ),
)


def main() -> None:
    """Run all cases and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("gap_real"))
    parser.add_argument(
        "--only", nargs="*", default=[""], help="words in the kind or name of cases"
    )
    arguments = parser.parse_args()
    runs = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    every = [*real(runs), *withheld(runs), *controls(runs), *changed(runs)]
    wanted = [c for c in every if any(word in f"{c.kind} {c.name}" for word in arguments.only)]
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = []
    with (arguments.out / "cases.csv").open("w", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        sheet.writeheader()
        for case in wanted:
            rows.append(study(case, arguments.out))
            sheet.writerow(rows[-1])
            stream.flush()
            print(*(f"{name}={text}" for name, text in rows[-1].items() if text), sep="  ")
    counts = [*count_of_controls(rows), *count_of_changes(rows)]
    text = "\n".join([*table(rows), "", *counts, ""])
    print(text)
    with atomic_write(arguments.out / "gap_real.md") as part:
        part.write_text(text, encoding="utf-8")


def study(case: Case, out: Path) -> dict[str, str]:
    """One case as a row."""
    row = dict.fromkeys(COLUMNS, "")
    row |= {"kind": case.kind, "case": case.name, "expected": case.expected}
    begin = time.perf_counter()
    try:
        result = find_gap(
            case.measured, case.calibration, case.holdout, given=case.given, config=CONFIG
        )
    except OdometryError as error:
        return row | {"verdict": "not judged", "error": str(error).splitlines()[0]}
    row["seconds"] = f"{time.perf_counter() - begin:.0f}"
    if case.kind not in ("control", "changed", "strong"):
        write_gap(result, out / case.name)
        write_gap_report(result, out / case.name)
    if case.kind == "changed":
        row["made"] = f"{made_m(result, case.expected) / result.holdout.noise_floor.value:.2f}"
    return row | said(result)


def said(result: GapResult) -> dict[str, str]:
    """What a result says, in cells."""
    share, held = held_out_share(result), result.holdout
    groups = ([s for _, s in result.calibration.held_back], result.measured_scenes)
    windows = [sum(map(len, scenes)) for scenes in (*groups, result.holdout_scenes)]
    return {
        "windows": "/".join(map(str, windows)),
        "verdict": result.verdict,
        "effects": " + ".join(name_of(one) for one in result.effects),
        "parameters": "; ".join(", ".join(parameter_words(e)[:SAID]) for e in result.effects),
        "equivalent": ", ".join(one.name for one in result.equivalent),
        "evidence": ", ".join(f"{one.evidence:.0f}" for one in result.effects),
        "before": with_interval(held.before),
        "after": with_interval(held.after),
        "floor": with_interval(held.noise_floor),
        "ratio": f"{held.before.value / held.noise_floor.value:.2f}",
        "closed": "no excess" if share is None else percent(share),
        "latency_s": f"{result.base.latency_s:.3f}",
        "chi_squared": " -> ".join(f"{one:.1f}" for one in chi_squared(result)),
    }


def name_of(effect: NamedEffect) -> str:
    """Name and form; of a residual, what it follows."""
    kind = effect.added.effect
    form = kind.variable if isinstance(kind, Residual) else kind.form
    return f"{kind.name} ({form})"


def chi_squared(result: GapResult) -> list[float]:
    """Chi-squared a degree of freedom on the measured runs, before and after; noise leaves 1."""
    measured = measured_of(result.measured_scenes, result.calibration, CONFIG)
    pairs = ((result.calibration.base, ()), (result.base, result.added))
    return [float(np.mean(measured.rows(*pair) ** 2)) for pair in pairs]


def table(rows: Sequence[dict[str, str]]) -> list[str]:
    """Lines of the table in Markdown."""
    shown = [name for name in COLUMNS if any(row[name] for row in rows)]
    cells = [shown, ["---"] * len(shown), *([row[name] for name in shown] for row in rows)]
    return [f"| {' | '.join(line)} |" for line in cells]


def count_of_controls(rows: Sequence[dict[str, str]]) -> list[str]:
    """How often a control is given a name, and which."""
    verdicts = Counter(r["verdict"] for r in rows if r["kind"] == "control")
    judged = sum(verdicts.values()) - verdicts["not judged"]
    named = judged - verdicts["none"] - verdicts["unknown"]
    which = ", ".join(f"{name} {count}" for name, count in verdicts.most_common())
    return [f"Controls: {named} of {judged} evaluated are given a name ({which})."]


if __name__ == "__main__":
    main()
