"""Changes made by hand to the second half of a real recording, and how often they are named."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.commands.late_treads import ActuatorLag
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.gap.answer.result import GapResult
from odometry.gap.prepare.simulate import residuals
from odometry.recording.run import Run
from tests.studies.gap.gap_real_cases import LATE_S, Case, in_halves, late

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


def arm(run: Run, ahead_m: float = ARM_M) -> Run:
    """Positions of an antenna ahead of where the pose says."""
    yaw_rad = run.pose.columns["yaw"]
    return _with_pose(
        run,
        x=run.pose.columns["x"] + ahead_m * np.cos(yaw_rad),
        y=run.pose.columns["y"] + ahead_m * np.sin(yaw_rad),
    )


def turned(run: Run, by_rad: float = TURNED_RAD) -> Run:
    """The yaw of the poses turned."""
    return _with_pose(run, yaw=run.pose.columns["yaw"] + by_rad)


def large_wheel(run: Run, scale: float = SCALE) -> Run:
    """The left tread recorded too fast."""
    return _with_speeds(run, run.odometry.columns["v_left"] * scale, None)


def lagging(run: Run, lag_s: float = LAG_S) -> Run:
    """Recorded speeds are those that a drive with a lag would answer as it did."""
    decay = np.exp(-np.diff(run.odometry.stamps_s) / lag_s)
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


MADE: Mapping[str, Added] = {
    one.effect.name: one
    for one in (
        Added(TimeOffset(), np.array([LATE_S])),
        Added(LeverArm(), np.array([ARM_M, 0.0])),
        Added(WheelScale(), np.array([1 / SCALE, 1.0])),
        Added(HeadingOffset(), np.array([TURNED_RAD])),
        Added(ActuatorLag(), np.array([LAG_S])),
    )
}


def made_m(result: GapResult, expected: str) -> float:
    """By how much a change alone moves the ends of windows held out [m], root mean square.

    The gap may be that of the recording as it is.
    """
    base, change = result.calibration.base, (MADE[expected],)
    ends = [
        (residuals(base, change, scene) - residuals(base, (), scene))[:, -1, :2]
        for scene in result.holdout_scenes
    ]
    return float(np.sqrt((np.concatenate(ends) ** 2).sum(axis=1).mean()))


def count_of_changes(rows: Sequence[dict[str, str]]) -> list[str]:
    """How often each is named, where the gap is twice the floor and of all.

    And over all changes at twice the floor: by the gap, by the change alone, and by the gap of
    recordings whose halves agree without a change.
    """
    judged = [r for r in rows if r["kind"] == "changed" and r["verdict"] != "not judged"]
    as_is = {row["case"].removesuffix(" forward"): row for row in rows if row["kind"] == "control"}
    scores = {row["case"]: score_of(row, as_is.get(_recording(row), {})) for row in judged}
    lines = []
    for expected in dict.fromkeys(row["expected"] for row in judged):
        own = [row for row in judged if row["expected"] == expected]
        wide = [row for row in own if float(row["ratio"]) >= TWICE]
        lines.append(
            f"{expected}: {_count(scores, wide)} at {TWICE:g} times the floor; "
            f"{_count(scores, own)}"
        )
    alike = {name for name, row in as_is.items() if row["ratio"] and float(row["ratio"]) < ALIKE}
    wide = [r for r in judged if float(r["ratio"]) >= TWICE]
    alone = [r for r in judged if float(r["made"]) >= TWICE]
    told = [r for r in wide if _recording(r) in alike]
    return [
        *lines,
        f"all: {_count(scores, wide)} at {TWICE:g} times the floor; {_count(scores, alone)} where "
        f"the change alone is; {_count(scores, told)} of recordings whose halves differ by less "
        f"than {ALIKE:g} times the floor without a change",
    ]


def score_of(row: Mapping[str, str], as_is: Mapping[str, str]) -> str:
    """Of a change made by hand; beside what the recording is named without it, `as_is`, as well."""
    names = [one.split(" (")[0] for one in row["effects"].split(" + ")]
    is_of_both = row["verdict"] == as_is.get("verdict")
    if row["verdict"] == row["expected"] or (is_of_both and row["expected"] in names):
        return "right"
    if row["expected"] in row["equivalent"].split(", "):
        return "equivalent"
    return row["verdict"] if row["verdict"] in ("unknown", "none") else "wrong"


def _recording(row: Mapping[str, str]) -> str:
    return row["case"].split()[-1]


def _count(scores: Mapping[str, str], rows: Sequence[Mapping[str, str]]) -> str:
    own = [scores[row["case"]] for row in rows]
    kinds = ("right", "equivalent", "unknown", "none", "wrong")
    return ", ".join(f"{kind} {own.count(kind)}" for kind in kinds) + f" of {len(rows)}"
