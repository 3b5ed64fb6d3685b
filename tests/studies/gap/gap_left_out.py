"""The gap workflow with the true name left out of the catalogue: which other names it gives.

    python -m tests.studies.gap.gap_left_out [--first-seed 80] [--seeds 3] [--kinds KIND ...]
        [--out gap_left_out] [--jobs 2] [--whole]

A case whose effect is in the catalogue is answered without the name of the effect and those that
the equations make the same: `unknown` and `none` are right and any other name is wrong. With
`--whole` it is answered with the whole catalogue, too. Every row of left_out.csv is one answer,
with what two gates of `odometry.gap.name.verdict` were given, so that their thresholds can be
compared on many cases.
"""

import argparse
import csv
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

from joblib import Parallel, delayed

from odometry.effects.catalogue import EFFECTS
from odometry.gap.name import accepted_effects, candidates, search
from tests.blind.cases import Case, make_case
from tests.studies.gap.gap_cases import NOISES, answer, judged, read
from tests.studies.gap.gap_names import COURSES, MEANING

KINDS = (  # of one effect that the catalogue has
    *("slope_sliding", "inertia", "curvature", "wheel_scale", "terrain", "traction_loss"),
    *("lateral_skid", "time_offset", "actuator_lag", "lever_arm", "heading_offset"),
    *("deadband", "deflation", "late_commands", "fast_pose_clock", "top_speed"),
    *("acceleration_limit", "slip_by_speed", "slip_by_acceleration", "slip_backward", "grip_lost"),
    *("one_side_deflates", "other_terrain", "changed_terrain", "stretched_map", "turning_map"),
    *("drifting_yaw", "smoothed_poses", "swaying_antenna", "hard_iron"),
)
SAME = {  # names that the equations make the same at some values, in runs like these
    "wheel_scale": ("terrain", "terrain_changed", "traction_loss", "tread_slip"),
    "traction_loss": ("wheel_scale", "tread_slip"),
    "lateral_skid": ("terrain", "terrain_changed", "lever_arm"),
    "lever_arm": ("terrain", "terrain_changed", "lateral_skid"),
    "terrain": ("lateral_skid", "lever_arm", "wheel_scale"),
    "time_offset": ("command_delay", "actuator_lag"),
    "command_delay": ("time_offset", "actuator_lag"),
    "actuator_lag": ("command_delay", "time_offset"),
    "heading_offset": ("reference_fault",),
    "reference_fault": ("heading_offset", "time_offset"),
    "slip_by_acceleration": ("command_delay", "actuator_lag", "time_offset"),
}
COLUMNS = (
    *("kind", "seed", "hidden", "gyroscope", "verdict", "form", "score", "equivalent", "closed"),
    *("main_part", "beaten"),
)


def main() -> None:
    """Answer the cases that are not answered yet and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first-seed", type=int, default=80)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=list(KINDS))
    parser.add_argument("--out", type=Path, default=Path("gap_left_out"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--whole", action="store_true", help="and with the whole catalogue")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    file = arguments.out / "left_out.csv"
    rows = read(file)
    known = {(row["kind"], int(row["seed"])) for row in rows}
    seeds = range(arguments.first_seed, arguments.first_seed + arguments.seeds)
    wanted = [(k, seed) for seed in seeds for k in arguments.kinds if (k, seed) not in known]
    with file.open("a", newline="", encoding="utf-8") as stream:
        sheet = csv.DictWriter(stream, COLUMNS)
        if not rows:
            sheet.writeheader()
        studied = Parallel(n_jobs=arguments.jobs, return_as="generator")
        for pair in studied(delayed(study)(kind, seed, arguments.whole) for kind, seed in wanted):
            rows += pair
            sheet.writerows(pair)
            stream.flush()
            for row in pair:
                print(*row.values(), sep="  ", flush=True)
    print("\n".join([*table_of(rows), "", *curve_of(rows, "main_part"), *curve_of(rows, "beaten")]))


def study(kind: str, seed: int, whole: bool) -> list[dict[str, str]]:
    """One case, answered without the name of its effect, and first with it if `whole`."""
    with tempfile.TemporaryDirectory() as folder:
        case = make_case(kind, seed, Path(folder), noise=NOISES[seed % len(NOISES)])
        true = names_of(case)
        asked = ((), true) if whole else (true,)
        return [answered(case, hidden, Path(folder) / "gap") for hidden in asked]


def names_of(case: Case) -> tuple[str, ...]:
    """What the program calls the effect of a case."""
    plain = [family for family in case.parts[0] if not family.endswith(COURSES)]
    return tuple(name for family in plain for name in MEANING[family])


def answered(case: Case, hidden: Sequence[str], out: Path) -> dict[str, str]:
    """The answer without names and those that are the same, as a row."""
    same = (other for name in (*hidden, case.kind) for other in SAME.get(name, ()))
    names = {*hidden, *same} if hidden else set()
    left = tuple(effect for effect in EFFECTS if effect.name not in names)
    with patch.object(candidates, "EFFECTS", left), gates() as given:
        row = judged(case, answer(case, out))
    if hidden and row["score"] not in ("unknown", "none"):
        row["score"] = "wrong"
    asked = {"kind": case.kind, "seed": f"{case.seed}", "hidden": "+".join(hidden), **given}
    return {name: str((row | asked)[name]) for name in COLUMNS}


@contextmanager
def gates() -> Iterator[dict[str, str]]:
    """What two gates are given: shares of what names close, "" where a gate was not asked."""
    given = {"main_part": "", "beaten": ""}
    main_part, unbeaten = accepted_effects.is_the_main_part, search.is_unbeaten

    def noted_part(of_names, of_all, config):  # type: ignore[no-untyped-def]
        given["main_part"] = f"{of_names / of_all:.4f}"
        return main_part(of_names, of_all, config)

    def noted_beaten(gain, refused, of_refused, margin):  # type: ignore[no-untyped-def]
        given["beaten"] = given["beaten"] or f"{(of_refused - gain) / gain:.4f}"
        return unbeaten(gain, refused, of_refused, margin)

    with (
        patch.object(accepted_effects, "is_the_main_part", noted_part),
        patch.object(search, "is_unbeaten", noted_beaten),
    ):
        yield given


def table_of(rows: Sequence[dict[str, str]]) -> list[str]:
    """Lines of Markdown: each hidden name and what was answered without it."""
    lines = ["| left out | cases | answers |", "|---|---|---|"]
    for name in dict.fromkeys(row["hidden"] for row in rows if row["hidden"]):
        of_name = [row for row in rows if row["hidden"] == name]
        answers = Counter(row["verdict"] for row in of_name).most_common()
        words = ", ".join(f"{verdict} {count}" for verdict, count in answers)
        lines.append(f"| {name} | {len(of_name)} | {words} |")
    return lines


def curve_of(rows: Sequence[dict[str, str]], gate: str) -> list[str]:
    """Names in cases where they are right, and where they are wrong, by what a gate was given."""
    right = [float(r[gate]) for r in rows if r[gate] and not r["hidden"]]
    wrong = [float(r[gate]) for r in rows if r[gate] and r["hidden"]]
    lines = [f"| {gate} | whole catalogue, at most | name left out, at most |", "|---|---|---|"]
    for limit in (-0.1, 0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0):
        under = [sum(value <= limit for value in of) for of in (right, wrong)]
        lines.append(f"| {limit} | {under[0]} of {len(right)} | {under[1]} of {len(wrong)} |")
    return lines


if __name__ == "__main__":
    main()
