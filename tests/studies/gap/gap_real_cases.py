"""Cases of the gap study on real recordings: which runs calibrate, measure and evaluate."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from odometry.comparison.split import halves, parts_by_terrain
from odometry.identification.identify import identify
from odometry.recording.run import Run

LATE_S = 0.15
TILE = "husky_tile_20231212_1616_s00"
STEEP = "warthog_grass_20240729_1446"
FLAT, LONG = "warthog_grass_20240729_1404", "warthog_grass_20240808_1556"
ASPHALT = "warthog_asphalt_20240920_0813"
SLOW_ASPHALT = "warthog_asphalt_slow_20240808_1146_"
GRAVEL, ICE = "warthog_gravel_20240806_1137_", "warthog_ice_20240730_1630_"
SAND, MARMOTTE = "warthog_sand_20240925_1413_", "marmotte_boreal_20240125_1215_"


@dataclass(frozen=True)
class Case:
    """Runs, and what is expected of them."""

    kind: str
    name: str
    expected: str
    calibration: Sequence[Run]
    measured: Sequence[Run]
    holdout: Sequence[Run] = ()
    given: Mapping[str, float] | None = None


def recordings(folder: Path) -> dict[str, Run]:
    """Runs with a pose by name, each with its ground as INDEX.csv names it."""
    found = {}
    with (folder / "INDEX.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            run = Run.read(folder / row["run"])
            ground = row["terrain"].split(" (")[0]
            if run.pose is not None:
                found[row["run"]] = replace(
                    run, settings={**run.settings, "run": {"terrain": ground}}
                )
    return found


def real(runs: Mapping[str, Run]) -> list[Case]:
    """Nothing was done to the data."""
    first, third, fourth = in_parts(runs[TILE])
    (identified,) = identify([first], "icr", fixed={"x_icr": 0.0}).terrains.values()
    no_offset = dict(identified.fit.values)
    steep, flat, long = ([runs[name]] for name in (STEEP, FLAT, LONG))
    known, measured, held = ([runs[f"{MARMOTTE}{name}"]] for name in ("s00", "s02", "s04"))
    skid, slope = "lateral_skid, x_shift about -0.146 m", "slope_sliding or none"
    return [
        Case("real", "husky_tile_x_icr_0", skid, [first], [third], [fourth], no_offset),
        Case("real", "warthog_grass_slope", slope, long, steep),
        Case("real", "warthog_grass_slope_to_flat", slope, long, steep, flat),
        Case("real", "marmotte", "curvature or none", known, measured, held),
    ]


def withheld(runs: Mapping[str, Run]) -> list[Case]:
    """A ground, 0.15 s, or the attitude, kept from the base model."""
    tile, asphalt = in_parts(runs[TILE]), in_parts(runs[ASPHALT])
    marmotte = tuple(runs[f"{MARMOTTE}{name}"] for name in ("s00", "s02", "s04"))
    grass = (runs[LONG], runs[STEEP], runs[FLAT])
    grounds = {
        "ice": ([f"{ICE}s00"], [f"{ICE}s02", f"{ICE}s04"]),
        "asphalt_slow": ([f"{SLOW_ASPHALT}s00"], [f"{SLOW_ASPHALT}s02"]),
        "gravel": ([f"{GRAVEL}s02"], [f"{GRAVEL}s00"]),
        "sand": ([f"{SAND}s00", f"{SAND}s01"], [f"{SAND}s02"]),
    }
    cases = []
    for ground, (here, there) in grounds.items():
        measured, held = ([runs[name] for name in names] for names in (here, there))
        joined = ([grass[1], *measured], [grass[2], *held])
        cases.append(Case("withheld", f"terrain_{ground}", "terrain", [grass[0]], *joined))
    recorded = {
        "warthog_grass": grass,
        "marmotte": marmotte,
        "husky_tile": tile,
        "warthog_asphalt": asphalt,
    }
    for name, (known, third, fourth) in recorded.items():
        shifted = f"time_offset, {LATE_S} s"
        cases += [
            Case("withheld", f"delay_{name}", shifted, [known], [late(third)], [late(fourth)]),
            Case("withheld", f"no_delay_{name}", "none", [known], [third], [fourth]),
        ]
    flat = [without_attitude(run) for run in (*grass[:2], *marmotte)]
    unseen = "unknown or none"
    return [
        *cases,
        Case("withheld", "attitude_warthog_grass", unseen, flat[:1], flat[1:2]),
        Case("withheld", "attitude_marmotte", unseen, flat[2:3], flat[3:4], flat[4:]),
    ]


def controls(runs: Mapping[str, Run]) -> list[Case]:
    """Each recording by halves, both ways round."""
    cases = []
    for name, run in runs.items():
        first, second = in_halves(run)
        cases.append(Case("control", f"{name} forward", "none", [first], [second]))
        cases.append(Case("control", f"{name} backward", "none", [second], [first]))
    return cases


def in_halves(run: Run) -> tuple[Run, Run]:
    """Two runs of one, each with half of the wheel travel."""
    (whole,) = parts_by_terrain(run, run.name).values()
    first, second = (half.cut() for half in halves(whole))
    return renamed(first, "first"), renamed(second, "second")


def in_parts(run: Run) -> tuple[Run, Run, Run]:
    """The first half, and both halves of the second."""
    first, second = in_halves(run)
    return first, *in_halves(second)


def renamed(run: Run, part: str) -> Run:
    """The same run in a folder of its own: no run may be given twice."""
    return replace(run, folder=run.folder.with_name(f"{run.folder.name}_{part}"))


def late(run: Run, late_s: float = LATE_S) -> Run:
    """Stamps of the poses later."""
    if run.pose is None:
        raise ValueError(f"{run.name} has no pose")
    columns = {**run.pose.columns, "t": run.pose.stamps_s + late_s}
    return replace(run, pose=replace(run.pose, columns=columns))


def without_attitude(run: Run) -> Run:
    """Roll and pitch as if they had never been recorded."""
    columns = {n: c for n, c in run.odometry.columns.items() if n not in ("roll", "pitch")}
    return replace(run, odometry=replace(run.odometry, columns=columns))
