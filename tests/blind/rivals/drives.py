"""Drives of one sort, that leave rivals apart from nothing, and drives that a program proposes."""

from dataclasses import dataclass

import numpy as np

from tests.blind.commands import ACCELERATION_M_S2, RATE_HZ, followed
from tests.blind.ground import Ground
from tests.blind.hidden.scene import STEP_S, Drive

SHAPES = (
    *("spin", "spins", "circle", "circles", "stepped circles", "straight", "shuttle", "steps"),
    *("curves", "slope"),
)
STEPS_OF_SPEED = (1.0, 0.4, 0.0, 0.7, -0.6, 0.0)  # each held for STEP_HELD_S
STEP_HELD_S = 3.0
SIDE_HELD_S = 10.0
WAVE_S = 30.0


@dataclass(frozen=True)
class Proposal:
    """A drive in plain words.

    Attributes
    ----------
    shape : str
        spin, circle (to one side); spins, circles (to both, by turns); straight (forward at one
        speed); shuttle (forward and backward at one speed, by turns); steps, curves, stepped
        circles (straights, bends or circles with steps of speed, also backward); slope
        (straights with quarter turns between).
    speed_m_s : float
        Of the middle; of each tread in a spin.
    radius_m : float
        Of a circle; negative to the right. A spin is to the left unless `radius_m` is negative.
    duration_s : float
    slope_rad : float
        Of the plane that any shape is driven on; uphill is along x.
    heading_rad : float or None
        At the start; None is any.
    """

    shape: str
    speed_m_s: float
    radius_m: float = 0.0
    duration_s: float = 60.0
    slope_rad: float = 0.0
    heading_rad: float | None = None


def handful(width_m):
    """Drives of which one distinguishes most rivals."""
    return (
        Proposal("spin", 0.4, 1.0, 20.0),
        Proposal("spin", 0.4, -1.0, 20.0),
        *(Proposal("circle", 0.5, r * width_m, 20.0) for r in (1.0, -1.0)),
        *(Proposal("circle", 0.9, r * width_m, 20.0) for r in (2.0, -2.0, 4.0)),
        Proposal("straight", 0.4, duration_s=20.0),
        Proposal("steps", 0.9, duration_s=20.0),
        Proposal("slope", 0.8, duration_s=20.0, slope_rad=0.1),
    )


def drive_of(rng, scene, proposal):
    """The proposed drive of a scene's robot, from rest, with no tread faster in its change."""
    if proposal.shape not in SHAPES:
        raise ValueError(f"shape = {proposal.shape!r}, expected one of {', '.join(SHAPES)}")
    wanted = _wanted(proposal, scene.base.width)
    heading = rng.uniform(-np.pi, np.pi) if proposal.heading_rad is None else proposal.heading_rad
    place = rng.uniform(-20.0, 20.0, 2)
    ground = Ground((float(np.tan(proposal.slope_rad)), 0.0)) if proposal.slope_rad else Ground()
    asked = as_held(_from_rest(wanted), scene)
    return Drive(asked, ground, (*map(float, place), float(heading)), None)


def as_held(asked, scene):
    """Speeds that change where odometry has a row, as those of the calibration do."""
    held = scene.sensors.odometry_rows * round(1 / (RATE_HZ * STEP_S))
    return np.repeat(asked[::held], held, axis=0)[: len(asked)]


def _wanted(p, width):
    """Speed of each tread (N, 2) [m/s] that is asked for at each step."""
    times_s = np.arange(round(p.duration_s / STEP_S) + 1) * STEP_S
    speed, omega = np.full(len(times_s), p.speed_m_s), np.zeros(len(times_s))
    sides = np.where(times_s // SIDE_HELD_S % 2 == 0, 1.0, -1.0)
    steps = np.array(STEPS_OF_SPEED)[(times_s // STEP_HELD_S).astype(int) % len(STEPS_OF_SPEED)]
    if p.shape in ("spin", "spins"):
        side = sides if p.shape == "spins" else (-1.0 if p.radius_m < 0 else 1.0)
        speed, omega = 0 * speed, omega + side * 2 * p.speed_m_s / width
    elif p.shape in ("circle", "circles"):
        omega = omega + (sides if p.shape == "circles" else 1.0) * p.speed_m_s / p.radius_m
    elif p.shape == "shuttle":
        speed = speed * sides
    elif p.shape in ("steps", "curves", "stepped circles"):
        speed = speed * steps
        bends = {"steps": 0.0, "curves": 1 / (3 * width)}
        omega = speed * sides * (bends[p.shape] if p.shape in bends else 1 / p.radius_m)
    elif p.shape == "slope":
        turning = (times_s % 8.0) > 6.0
        omega = np.where(turning, np.pi / 2 / 2.0, 0.0)
        speed = np.where(turning, 0.3 * speed, speed)
    return np.column_stack([speed - omega * width / 2, speed + omega * width / 2])


def waves(proposal):
    """A drive whose speeds change so slowly that a lag looks like a delay: (N, 2) [m/s]."""
    times_s = np.arange(round(proposal.duration_s / STEP_S) + 1) * STEP_S
    phase = 2 * np.pi * times_s / WAVE_S
    speed = proposal.speed_m_s * (0.5 - 0.5 * np.cos(phase))
    half = 0.3 * proposal.speed_m_s * np.sin(phase / 2) * np.sin(phase)
    return np.column_stack([speed - half, speed + half])


def _from_rest(wanted):
    most = ACCELERATION_M_S2 * STEP_S
    return np.column_stack([followed(side, most, 0.0) for side in wanted.T])
