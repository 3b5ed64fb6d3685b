"""Changes made by hand to the second half of a real recording, and how often they are named."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from odometry.run import Run
from tests.studies.gap_real_cases import LATE_S, Case, in_halves, late

ARM_M = 0.3
SCALE = 1.05
TURNED_RAD = 0.06
LAG_S = 0.3
TWICE = 2.0  # the noise floor: a smaller gap need not be named
ALIKE = 1.5  # times the floor: halves that differ by more without any change hide it


def changed(runs: Mapping[str, Run]) -> list[Case]:
    """Each recording calibrated on its first half and measured on its second, which is changed."""
    cases = []
    for name, run in runs.items():
        first, second = in_halves(run)
        for word, (expected, change) in CHANGES.items():
            cases.append(Case("changed", f"{word} {name}", expected, [first], [change(second)]))
    return cases


def arm(run: Run) -> Run:
    """Positions of an antenna ARM_M ahead of where the pose says."""
    yaw_rad = run.pose.columns["yaw"]
    return _with_pose(
        run,
        x=run.pose.columns["x"] + ARM_M * np.cos(yaw_rad),
        y=run.pose.columns["y"] + ARM_M * np.sin(yaw_rad),
    )


def turned(run: Run) -> Run:
    """The yaw of the poses turned by TURNED_RAD."""
    return _with_pose(run, yaw=run.pose.columns["yaw"] + TURNED_RAD)


def large_wheel(run: Run) -> Run:
    """The left tread recorded too fast."""
    return _with_speeds(run, run.odometry.columns["v_left"] * SCALE, None)


def lagging(run: Run) -> Run:
    """Recorded speeds are those that a drive with a lag of LAG_S would answer as it did."""
    decay = np.exp(-np.diff(run.odometry.stamps_s) / LAG_S)
    commanded = []
    for name in ("v_left", "v_right"):
        speeds = run.odometry.columns[name]
        ahead = (speeds[1:] - decay * speeds[:-1]) / (1 - decay)
        commanded.append(np.append(ahead, speeds[-1]))
    return _with_speeds(run, *commanded)


def _with_pose(run: Run, **columns) -> Run:
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


def _with_speeds(run: Run, left, right) -> Run:
    columns = dict(run.odometry.columns)
    for name, values in (("v_left", left), ("v_right", right)):
        columns[name] = columns[name] if values is None else values
    return replace(run, odometry=replace(run.odometry, columns=columns))


CHANGES: Mapping[str, tuple[str, Callable[[Run], Run]]] = {
    f"late by {LATE_S} s": ("time_offset", late),
    f"arm of {ARM_M} m": ("lever_arm", arm),
    f"left wheel by {SCALE}": ("wheel_scale", large_wheel),
    f"heading by {TURNED_RAD} rad": ("heading_offset", turned),
    f"lag of {LAG_S} s": ("actuator_lag", lagging),
}


def count_of_changes(rows: Sequence[dict[str, str]]) -> list[str]:
    """How often each is named, where the gap is twice the floor and of all.

    And over all changes at twice the floor, of recordings whose halves agree without a change.
    """
    judged = [r for r in rows if r["kind"] == "changed" and r["verdict"] != "not judged"]
    lines = []
    for expected in dict.fromkeys(row["expected"] for row in judged):
        own = [row for row in judged if row["expected"] == expected]
        wide = [row for row in own if float(row["ratio"]) >= TWICE]
        lines.append(f"{expected}: {_scores(wide)} at {TWICE:g} times the floor; {_scores(own)}")
    own = {r["case"].removesuffix(" forward"): r["ratio"] for r in rows if r["kind"] == "control"}
    alike = {name for name, ratio in own.items() if ratio and float(ratio) < ALIKE}
    wide = [r for r in judged if float(r["ratio"]) >= TWICE]
    told = [r for r in wide if r["case"].split()[-1] in alike]
    return [
        *lines,
        f"all: {_scores(wide)} at {TWICE:g} times the floor; {_scores(told)} of recordings whose "
        f"halves differ by less than {ALIKE:g} times the floor without a change",
    ]


def score_of(row: Mapping[str, str]) -> str:
    """Of a change made by hand."""
    if row["verdict"] == row["expected"]:
        return "right"
    if row["expected"] in row["equivalent"].split(", "):
        return "equivalent"
    return row["verdict"] if row["verdict"] in ("unknown", "none") else "wrong"


def _scores(rows: Sequence[Mapping[str, str]]) -> str:
    scores = [score_of(row) for row in rows]
    kinds = ("right", "equivalent", "unknown", "none", "wrong")
    return ", ".join(f"{kind} {scores.count(kind)}" for kind in kinds) + f" of {len(rows)}"
