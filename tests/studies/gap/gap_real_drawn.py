"""Real recordings in thirds, changed by hand in directions and by sizes that a seed draws.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.gap.gap_real_drawn [--seed 1] [--out FOLDER]
        [--only WORD ...]

As `gap_real_strong`, of other parts and other changes: poses late or early, an arm in any
direction, either wheel recorded too fast or too slow, a heading to either side, a lag. Each alone
makes 2.2 to 4 times the noise floor, where that is no more than is likely. Pairs are two thirds of
each recording and drives on grass, by one another; each as it is as well.
"""

import argparse
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise, permutations
from pathlib import Path

import numpy as np

from odometry.comparison.split import parts_by_terrain
from odometry.effects.commands.late_treads import ActuatorLag
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.errors import OdometryError
from odometry.gap.prepare.prepared import prepared
from odometry.gap.prepare.statistic import floor_there
from odometry.models.icr import Icr
from odometry.recording.run import Run
from tests.studies.gap.gap_real import CONFIG
from tests.studies.gap.gap_real_cases import Case, late, recordings, renamed
from tests.studies.gap.gap_real_changes import lagging, turned
from tests.studies.gap.gap_real_strong import count, moved_m

TIMES = (2.2, 4.0)  # the noise floor
GRASS = "warthog_grass"
SMALL = 0.1  # of the most: the strength of which the motion is measured, nearly linear up to there


@dataclass(frozen=True)
class Change:
    """A change by its strength: what the program calls it, and what it does to a run."""

    expected: str
    words: str
    most: float
    of: Callable[[float], Added]
    made: Callable[[Run, float], Run]


def main() -> None:
    """Run the cases, and count how often a change has its name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("gap_real_drawn"))
    parser.add_argument("--only", nargs="*", default=[""], help="words in the name of cases")
    arguments = parser.parse_args()
    runs = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    count(cases(runs, arguments.seed), arguments.only, arguments.out)


def cases(runs: Mapping[str, Run], seed: int) -> Iterator[Case]:
    """Pairs in an order that the seed draws, each as it is and changed."""
    every = list(pairs(runs))
    for number in np.random.default_rng(seed).permutation(len(every)):
        yield from cases_of(*every[number], np.random.default_rng([seed, number]))


def cases_of(name: str, known: Run, measured: Run, rng: np.random.Generator) -> Iterator[Case]:
    """One pair as it is, and changed where a change is not too strong to be likely."""
    changes = [draw(rng) for draw in DRAWS]
    times = rng.uniform(*TIMES, len(changes))
    try:
        ready = prepared([measured], [known], [], (Icr(), None), CONFIG)
    except OdometryError:
        return
    held, base = ready.scenes[1], ready.known.base
    floor_m = floor_there(ready.floor(), ready.known, held, ready.config).value
    yield Case("drawn", f"as it is {name}", "none", [known], [measured])
    for change, of_floor in zip(changes, times, strict=True):
        small = SMALL * change.most
        strength = small * of_floor * floor_m / moved_m(base, held, change.of(small))
        if strength <= change.most:
            title = f"{change.expected} {change.words} {strength:.3g} {name}"
            changed = change.made(measured, strength)
            yield Case("drawn", title, change.expected, [known], [changed])


def pairs(runs: Mapping[str, Run]) -> Iterator[tuple[str, Run, Run]]:
    """A name, the run that calibrates and the run that is measured."""
    for name, run in runs.items():
        thirds = in_thirds(run)
        for one, other in ((0, 2), (2, 0), (0, 1)):
            yield f"{name} third {one + 1} to {other + 1}", thirds[one], thirds[other]
    for one_name, other_name in permutations([n for n in runs if n.startswith(GRASS)], 2):
        yield f"{one_name} to {other_name}", runs[one_name], runs[other_name]


def in_thirds(run: Run) -> list[Run]:
    """Three runs of one, each with a third of the wheel travel."""
    (whole,) = parts_by_terrain(run, run.name).values()
    travel_m = run.wheel_travel_m
    ends = np.searchsorted(travel_m, travel_m[-1] * np.arange(4) / 3)
    ends[-1] = whole.stop
    return [
        renamed(replace(whole, start=int(start), stop=int(stop)).cut(), f"third_{number}")
        for number, (start, stop) in enumerate(pairwise(ends), 1)
    ]


def _stamps(rng: np.random.Generator) -> Change:
    sign = _sign(rng)
    return Change(
        "time_offset",
        "late by" if sign > 0 else "early by",
        0.6,
        lambda size: Added(TimeOffset(), np.array([sign * size])),
        lambda run, size: late(run, sign * size),
    )


def _arm(rng: np.random.Generator) -> Change:
    angle_rad = float(rng.uniform(-np.pi, np.pi))
    ahead, left = float(np.cos(angle_rad)), float(np.sin(angle_rad))
    return Change(
        "lever_arm",
        f"at {np.degrees(angle_rad):.0f} degrees by",
        1.0,
        lambda size: Added(LeverArm(), size * np.array([ahead, left])),
        lambda run, size: _with_arm(run, size * ahead, size * left),
    )


def _wheel(rng: np.random.Generator) -> Change:
    side, sign = int(rng.integers(2)), _sign(rng)
    tread = ("v_left", "v_right")[side]

    def factors(size: float) -> np.ndarray:
        return np.array([1 / (1 + sign * size) if side == of else 1.0 for of in range(2)])

    return Change(
        "wheel_scale",
        f"{tread} {'faster' if sign > 0 else 'slower'} by",
        0.25,
        lambda size: Added(WheelScale(), factors(size)),
        lambda run, size: _with_tread(run, tread, 1 + sign * size),
    )


def _heading(rng: np.random.Generator) -> Change:
    sign = _sign(rng)
    return Change(
        "heading_offset",
        "left by" if sign > 0 else "right by",
        0.35,
        lambda size: Added(HeadingOffset(), np.array([sign * size])),
        lambda run, size: turned(run, sign * size),
    )


def _lag(rng: np.random.Generator) -> Change:  # noqa: ARG001 - a lag has one direction
    return Change(
        "actuator_lag",
        "of",
        1.0,
        lambda size: Added(ActuatorLag(), np.array([size])),
        lagging,
    )


DRAWS = (_stamps, _arm, _wheel, _heading, _lag)


def _sign(rng: np.random.Generator) -> int:
    return 1 if rng.random() < 0.5 else -1


def _with_arm(run: Run, ahead_m: float, left_m: float) -> Run:
    pose = run.pose
    if pose is None:
        raise ValueError(f"{run.name} has no pose")
    cosine, sine = np.cos(pose.columns["yaw"]), np.sin(pose.columns["yaw"])
    x = pose.columns["x"] + ahead_m * cosine - left_m * sine
    y = pose.columns["y"] + ahead_m * sine + left_m * cosine
    return replace(run, pose=replace(pose, columns={**pose.columns, "x": x, "y": y}))


def _with_tread(run: Run, tread: str, factor: float) -> Run:
    columns = {**run.odometry.columns, tread: factor * run.odometry.columns[tread]}
    return replace(run, odometry=replace(run.odometry, columns=columns))


if __name__ == "__main__":
    main()
