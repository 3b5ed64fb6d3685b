"""Drives on which rivals are compared before anybody drives them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.effects.interface.base_model import Base
from odometry.gap.config import GapConfig
from odometry.models.inputs import Inputs
from odometry.recording.run import UNKNOWN
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.travel.motion import level_path

LASTING_S = 60.0
PERIOD_S = 0.05
REST_S = 1.0  # at the begin and the end: no delay is longer
TIGHT_M = 1.0  # on circles of this radius a robot looks all round in a few seconds
RADII_M = (TIGHT_M, 2.5, 6.0)
STEP_S = 4.0  # between steps of speed, and between changes of the sense of turns
SIDE_S = 12.0  # of circles with steps of speed
STEPS = (0.3, 1.0, 0.0, 0.6, -0.6, 1.0, 0.15, 0.8)  # of the speed


@dataclass(frozen=True)
class Drive:
    """A drive of a minute.

    Attributes
    ----------
    words : str
        What to drive, with its numbers.
    speeds_m_s : (N, 2)
        Of the treads.
    roll_rad, pitch_rad : (N,)
    all_round : bool
        Whether whoever drives it looks in all directions: not so where the words leave it open.
    """

    words: str
    speeds_m_s: FloatArray
    roll_rad: FloatArray
    pitch_rad: FloatArray
    all_round: bool = False


def drives_of(scenes: Sequence[DenseWindows], base: Base, config: GapConfig) -> tuple[Drive, ...]:
    """A handful at the speeds and on the slopes that the robot has driven, most varied first."""
    treads = np.concatenate([scene.inputs.tread_speeds_m_s for scene in scenes])
    fast = float(np.percentile(np.abs(treads), 95))
    width = _effective_width_m(base)
    time_s = PERIOD_S * np.arange(round(LASTING_S / PERIOD_S))
    turn = np.where(np.floor(time_s / STEP_S) % 2 == 0, 1.0, -1.0)
    side = np.where(np.floor(time_s / SIDE_S) % 2 == 0, 1.0, -1.0)
    driving = (time_s >= REST_S) & (time_s < LASTING_S - REST_S)
    level = np.zeros_like(time_s)

    def made(words: str, forward: FloatArray, difference: FloatArray) -> Drive:
        speeds = np.stack([forward - difference / 2, forward + difference / 2], axis=-1)
        scale = min(1.0, fast / max(float(np.abs(speeds).max()), 1e-9))
        return Drive(words, scale * speeds * driving[:, None], level, level)

    stepped = fast * np.array(STEPS)[(time_s // STEP_S).astype(np.int64) % len(STEPS)]
    curved = 0.4 * stepped * turn
    tight = stepped / (1 + width / (2 * TIGHT_M))
    words = f"circles of {TIGHT_M:g} m radius to both sides with steps of speed up to "
    circles = made(f"{words}{tight.max():.2g} m/s", tight, tight * width / TIGHT_M * side)
    found = [
        made(f"curves with steps of speed up to {fast:.2g} m/s", stepped, curved),
        replace(circles, all_round=True),
    ]
    for radius_m in RADII_M:
        inner = fast / (1 + width / (2 * radius_m))
        words = f"circles of {radius_m:g} m radius to both sides at {inner:.2g} m/s"
        circles = made(words, level + inner, inner * width / radius_m * turn)
        found.append(replace(circles, all_round=radius_m == TIGHT_M))
    found.append(made(f"straights with steps of speed up to {fast:.2g} m/s", stepped, level))
    spins = made(f"spins to both sides, treads at {fast:.2g} m/s", level, 2 * fast * turn)
    found.append(replace(spins, all_round=True))
    return (*found, *_on_slopes(scenes, found, config.least_tilt_rad))


def _on_slopes(
    scenes: Sequence[DenseWindows], level: Sequence[Drive], least_rad: float
) -> list[Drive]:
    """Spins and curves across the steepest terrain measured, where attitude was recorded."""
    tilts = [np.hypot(scene.inputs.roll_rad, scene.inputs.pitch_rad) for scene in scenes]
    steep_rad = float(np.percentile(np.concatenate(tilts), 95))
    if steep_rad < least_rad:
        return []
    found = []
    for one in (level[0], level[-1]):
        words = f"{one.words}, on a slope of {np.degrees(steep_rad):.0f} degrees"
        found.append(replace(one, words=words, pitch_rad=one.pitch_rad + steep_rad))
    return found


def scene_of(drive: Drive, base: Base, like: DenseWindows) -> DenseWindows:
    """The drive as windows of the same length and pose rate as measured ones.

    The slope faces one way: roll and pitch follow the heading of the base's own motion. Poses are
    those of this motion; whoever compares puts others in their place.
    """
    count = len(drive.speeds_m_s)
    time_s = np.asarray(PERIOD_S * np.arange(count), dtype=np.float64)
    inputs = Inputs(drive.speeds_m_s, time_s=time_s, terrain=_usual_terrain(like, count))
    steps_s = np.full(count, PERIOD_S)
    path = level_path(base.model.twist(base.values, inputs), steps_s, inputs)
    steep_rad, heading = drive.pitch_rad, path[:, 2]
    inputs = replace(
        inputs,
        roll_rad=-steep_rad * np.sin(heading),
        pitch_rad=steep_rad * np.cos(heading),
        heading_rad=heading,
        yaw_rate_rad_s=None if like.inputs.yaw_rate_rad_s is None else np.gradient(heading, time_s),
    )
    lengths = np.diff(like.windows, axis=1)
    spacing_s = float(np.median(np.diff(like.pose_s)[: lengths.max() + 1])) if len(like) else 0.1
    each = max(1, round(spacing_s / PERIOD_S))
    poses = np.arange(0, count, each)
    steps = like.windows.shape[1] - 1
    between = max(1, round(float(np.median(lengths))))
    firsts = np.arange(0, len(poses) - steps * between, steps * between)
    windows = firsts[:, None] + between * np.arange(steps + 1)
    travel_m = np.cumsum(np.abs(drive.speeds_m_s).mean(axis=1)) * PERIOD_S
    return replace(
        like,
        inputs=inputs,
        steps_s=steps_s,
        travel_m=travel_m,
        pose_s=time_s[poses],
        poses=path[poses],
        windows=windows,
    )


def _usual_terrain(like: DenseWindows, count: int) -> AnyArray | None:
    if like.inputs.terrain is None:
        return None
    names, counts = np.unique(like.inputs.terrain.astype(str), return_counts=True)
    known = np.where(np.isin(names, (UNKNOWN, "")), 0, counts)
    return np.full(count, names[int(np.argmax(known))], dtype=object)


def _effective_width_m(base: Base) -> float:
    """Of the treads, by what the base makes of a spin."""
    twist = base.model.twist(base.values, Inputs(np.array([[-1.0, 1.0]])))
    return float(2.0 / max(abs(twist[0, 2]), 1e-6))
