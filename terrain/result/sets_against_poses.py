"""Whether poses agree with the parameters of the terrains that were in force."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.effects.tables import model_of
from odometry.errors import WindowError
from odometry.parameters import ParameterSet
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.motion import window_motion
from odometry.windows.windows import Windows, windows_of
from terrain.result.run_result import RunResult

HORIZON_M = 1.0  # of a window
FEWEST_WINDOWS = 5
LEAST_TURN_RAD = 0.05  # of a window, root mean square: less is no evidence on turns
TURNS, WAY = 0.25, 0.15  # relative: one terrain differs by less from day to day
CERTAIN = 4.0  # standard deviations


@dataclass(frozen=True)
class SetAgainstPoses:
    """How far the robot turned and went on one terrain, over what its parameters predict.

    Attributes
    ----------
    terrain : str
    windows : int
    turn, turn_sd, way, way_sd : float
        Ratios and their standard deviations; 1 where poses agree, NaN where they do not say.
    by : str
        "poses", or "gyroscope" of turns alone.
    """

    terrain: str
    windows: int
    turn: float
    turn_sd: float
    way: float
    way_sd: float
    by: str = "poses"

    @property
    def turns_otherwise(self) -> bool:
        """Whether the robot surely turned farther or less far than predicted."""
        return _differs(self.turn, self.turn_sd, TURNS)

    @property
    def goes_otherwise(self) -> bool:
        """Whether the robot surely went farther or less far than predicted."""
        return _differs(self.way, self.way_sd, WAY)


def _differs(ratio: float, sd: float, share: float) -> bool:
    """Whether a ratio is surely more than 1 + share, or less than one over it."""
    far = ratio > 1 + share or ratio * (1 + share) < 1
    return far and abs(ratio - 1) > CERTAIN * sd


def sentences(found: Sequence[SetAgainstPoses]) -> list[str]:
    """What poses and parameters surely differ in, in words; one sentence where all terrains do."""
    if len(found) > 1 and all(one.goes_otherwise for one in found):
        ways = [one.way for one in found]
        if max(ways) < (1 + WAY) * min(ways):
            return [
                f"by the poses the robot went {min(ways):.2f} to {max(ways):.2f} times as far as "
                f"the parameters say on all terrains ({', '.join(one.terrain for one in found)}): "
                "the tread speeds (wheel radius, tyres) or the scale of the positions are not "
                "those of the parameters"
            ]
    return [_sentence(one) for one in found if one.turns_otherwise or one.goes_otherwise]


def _sentence(one: SetAgainstPoses) -> str:
    parts = [f"turned {one.turn:.2f} +- {one.turn_sd:.2f} times"] * one.turns_otherwise
    parts += [f"went {one.way:.2f} +- {one.way_sd:.2f} times"] * one.goes_otherwise
    learn = "Compare with gap, or learn them with identify"
    if one.by == "gyroscope":
        learn = "Or the gyroscope has another scale. Learn them with identify"
    return (
        f"by the {one.by} the robot {' and '.join(parts)} as far on {one.terrain!r} as its "
        f"parameters say ({one.windows} windows of {HORIZON_M:g} m): they are of another robot, "
        f"terrain or weather, or it was not on this terrain. {learn}"
    )


def sets_against_poses(result: RunResult) -> list[SetAgainstPoses]:
    """Each terrain of the parameter set that was in force for long enough, against the poses.

    Of a robot whose yaw was measured; elsewhere nothing is compared.
    """
    pose = result.run.pose
    if pose is None or not np.isfinite(pose.stack("x", "y", "yaw")).all(axis=1).any():
        return []
    run = _with_terrains(result.run, result.replay.stamps_s, result.replay.terrains)
    try:
        windows = windows_of([run], WindowConfig(horizon_m=HORIZON_M))
    except WindowError:
        return []
    names = [name for name in result.parameters.terrains if name in windows.terrain]
    return [
        _compared(name, windows.where(windows.terrain == name), result.parameters, run)
        for name in names
        if np.count_nonzero(windows.terrain == name) >= FEWEST_WINDOWS
    ]


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
    predicted = window_motion(model, model.pack(table.values), windows)
    turn = turn_sd = float("nan")
    if float(np.sqrt(np.mean(predicted[:, 2] ** 2))) > LEAST_TURN_RAD:
        turn, turn_sd = _slope(predicted[:, 2], windows.measured[:, 2])
    way = (np.hypot(*of[:, :2].T) for of in (predicted, windows.measured))
    return SetAgainstPoses(name, len(windows), turn, turn_sd, *_slope(*way))


def _slope(predicted: FloatArray, measured: FloatArray) -> tuple[float, float]:
    """Slope through the origin and its standard deviation, by leaving out each window once."""
    products, squares = predicted * measured, predicted**2
    slopes = (products.sum() - products) / np.maximum(squares.sum() - squares, 1e-12)
    count = len(slopes)
    spread = float(np.sqrt((count - 1) / count * np.sum((slopes - slopes.mean()) ** 2)))
    return float(products.sum() / max(squares.sum(), 1e-12)), spread
