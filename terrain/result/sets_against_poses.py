"""Whether poses agree with the parameters of the terrains that were in force."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.effects.tables import model_of
from odometry.errors import WindowError
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.motion_ratios import (
    FEWEST_WINDOWS,
    HORIZON_M,
    WAY,
    MotionRatios,
    motion_ratios,
)
from odometry.windows.travel.windows import Windows, windows_of
from terrain.result.run_result import RunResult


@dataclass(frozen=True)
class SetAgainstPoses:
    """How far the robot turned and went on one terrain, over what its parameters predict.

    Attributes
    ----------
    terrain : str
    windows : int
    ratios : MotionRatios
        NaN where poses, or the gyroscope, do not say.
    by : str
        "poses", or "gyroscope" of turns alone.
    """

    terrain: str
    windows: int
    ratios: MotionRatios
    by: str = "poses"


def sentences(found: Sequence[SetAgainstPoses]) -> list[str]:
    """What poses and parameters surely differ in, in words; one sentence where all terrains do."""
    if len(found) > 1 and all(one.ratios.goes_otherwise for one in found):
        ways = [one.ratios.way for one in found]
        if max(ways) < (1 + WAY) * min(ways):
            return [
                f"by the poses the robot went {min(ways):.2f} to {max(ways):.2f} times as far as "
                f"the parameters say on all terrains ({', '.join(one.terrain for one in found)}): "
                "the tread speeds (wheel radius, tyres) or the scale of the positions are not "
                "those of the parameters"
            ]
    return [_sentence(one) for one in found if one.ratios.words]


def _sentence(one: SetAgainstPoses) -> str:
    learn = "Compare with gap, or learn them with identify"
    if one.by == "gyroscope":
        learn = "Or the gyroscope has another scale. Learn them with identify"
    return (
        f"by the {one.by} the robot {one.ratios.words} as far on {one.terrain!r} as its "
        f"parameters say ({one.windows} windows of {HORIZON_M:g} m): they are of another robot, "
        f"terrain or weather, or it was not on this terrain. {learn}"
    )


def sets_against_poses(result: RunResult) -> list[SetAgainstPoses]:
    """Each terrain of the parameter set that was in force for long enough, against the poses.

    Of a robot whose yaw was measured; elsewhere nothing is compared.
    """
    windows = windows_in_force(result)
    if windows is None:
        return []
    return [
        _compared(name, windows.where(windows.terrain == name), result.parameters, result.run)
        for name in result.parameters.terrains
        if np.count_nonzero(windows.terrain == name) >= FEWEST_WINDOWS
    ]


def windows_in_force(result: RunResult) -> Windows | None:
    """Windows of HORIZON_M between poses, each of one terrain in force; None without any."""
    pose = result.run.pose
    if pose is None or not np.isfinite(pose.stack("x", "y", "yaw")).all(axis=1).any():
        return None
    run = _with_terrains(result.run, result.replay.stamps_s, result.replay.terrains)
    try:
        return windows_of([run], WindowConfig(horizon_m=HORIZON_M))
    except WindowError:
        return None


def _with_terrains(run: Run, stamps_s: FloatArray, terrains: Sequence[str]) -> Run:
    """A run whose rows of odometry.csv carry the terrain that was in force."""
    rows = np.searchsorted(stamps_s, run.odometry.stamps_s, side="right") - 1
    names: AnyArray = np.array(terrains, dtype=object)[np.maximum(rows, 0)]
    columns = {**run.odometry.columns, "terrain": names}
    return replace(run, odometry=replace(run.odometry, columns=columns))


def _compared(name: str, windows: Windows, parameters: ParameterSet, run: Run) -> SetAgainstPoses:
    """What was measured over what one terrain's parameters predict, in its windows (K)."""
    table = parameters.terrains[name]
    model = model_of(table, run.robot, f"terrain {name!r}")
    return SetAgainstPoses(
        name, len(windows), motion_ratios(model, model.pack(table.values), windows)
    )
