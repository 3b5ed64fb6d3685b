"""A robot, its sensors and its three drives; each seed has another robot, rates and noises."""

from dataclasses import dataclass

import numpy as np

from tests.blind.commands import RATE_HZ, Limits, draw_commands
from tests.blind.ground import Ground, draw_ground
from tests.blind.hidden.kind import Clock
from tests.blind.robot import Body, Icrs, draw_body, draw_icrs

STEP_S = 0.01
TERRAINS = ("asphalt", "concrete", "grass", "gravel", "sand", "snow")
RUNS = ("calibration", "measured", "holdout")


@dataclass(frozen=True)
class Sensors:
    """Rates and noises.

    Attributes
    ----------
    odometry_rows : int
        Rows of 50 Hz commands that one recorded row holds for: 50, 25 or 10 Hz.
    pose_period_s, sigma_position_m, sigma_yaw_rad : float
        Of the reference.
    sigma_tread_m_s, sigma_gyroscope_rad_s, sigma_attitude_rad : float
        Of each row.
    gyroscope : str
        The file that it is recorded in: odometry, imu (at 100 Hz) or "" (none).
    """

    odometry_rows: int
    pose_period_s: float
    sigma_position_m: float
    sigma_yaw_rad: float
    sigma_tread_m_s: float
    sigma_gyroscope_rad_s: float
    sigma_attitude_rad: float
    gyroscope: str


@dataclass(frozen=True, eq=False)
class Drive:
    """What is asked of the robot in one run, and where.

    Attributes
    ----------
    asked_m_s : (N, 2) array
        Tread speeds of each step of the simulation.
    ground : Ground
    start : (x, y, yaw)
    labels : (N,) array of str or None
    """

    asked_m_s: np.ndarray
    ground: Ground
    start: tuple[float, float, float]
    labels: np.ndarray | None

    @property
    def clock(self):
        return Clock(STEP_S, np.arange(len(self.asked_m_s)) * STEP_S)


@dataclass(frozen=True, eq=False)
class Scene:
    """What stays the same in all runs of a case.

    Attributes
    ----------
    icrs : dict of Icrs
        By terrain; one of the name "" where terrains are not labelled.
    """

    body: Body
    icrs: dict[str, Icrs]
    sensors: Sensors
    speed_m_s: float
    ground: Ground

    @property
    def base(self):
        return next(iter(self.icrs.values()))


def draw_scene(rng, kind):
    body = draw_body(rng)
    base = draw_icrs(rng, body)
    names = [str(name) for name in rng.permutation(TERRAINS)[: kind.labels]]
    icrs = {name: _on_another(rng, body, base) if row else base for row, name in enumerate(names)}
    speed = rng.uniform(0.25, 0.4) if kind.style == "crawl" else rng.uniform(0.7, 1.5)
    ground = draw_ground(rng) if kind.sloped else Ground()
    return Scene(body, icrs or {"": base}, _draw_sensors(rng, kind), float(speed), ground)


def draw_drive(rng, scene, run):
    """The calibration is slow and level; the other runs are faster, each of its own length."""
    width = scene.base.width
    if run == "calibration":
        limits, duration, ground = Limits(0.5, 1.2, 1.0, width), rng.uniform(90, 130), Ground()
    else:
        limits = Limits(scene.speed_m_s, rng.uniform(0.8, 1.5), 1.5, width)
        duration, ground = rng.uniform(80, 180), scene.ground
    commands = draw_commands(rng, duration, limits)[:: scene.sensors.odometry_rows]
    held = scene.sensors.odometry_rows * round(1 / (RATE_HZ * STEP_S))
    asked = np.repeat(commands, held, axis=0)
    start = (*map(float, rng.uniform(-50.0, 50.0, 2)), float(rng.uniform(-np.pi, np.pi)))
    return Drive(asked, ground, start, _labels(rng, scene, len(asked)))


def _on_another(rng, body, base):
    """ICRs on another terrain."""
    wider = rng.choice([rng.uniform(0.75, 0.88), rng.uniform(1.15, 1.7)])
    return Icrs(
        y_left=float(base.y_left * wider * rng.uniform(0.93, 1.07)),
        y_right=float(base.y_right * wider * rng.uniform(0.93, 1.07)),
        x_icr=float(base.x_icr + body.length * rng.uniform(-0.15, 0.15)),
        alpha_left=float(base.alpha_left * rng.uniform(0.9, 1.0)),
        alpha_right=float(base.alpha_right * rng.uniform(0.9, 1.0)),
    )


def _draw_sensors(rng, kind):
    files = ("odometry", "imu") if kind.gyroscope == "always" else ("odometry", "imu", "", "")
    return Sensors(
        odometry_rows=int(rng.choice([1, 1, 2, 5])),
        pose_period_s=float(rng.choice([0.05, 0.1, 0.1, 0.2])),
        sigma_position_m=float(rng.choice([0.005, 0.01, 0.02])),
        sigma_yaw_rad=float(np.deg2rad(rng.uniform(0.1, 0.4))),
        sigma_tread_m_s=float(rng.uniform(0.001, 0.006)),
        sigma_gyroscope_rad_s=float(rng.uniform(0.001, 0.005)),
        sigma_attitude_rad=float(np.deg2rad(rng.uniform(0.05, 0.2))),
        gyroscope=str(rng.choice(files)),
    )


def _labels(rng, scene, count):
    """Names of the terrain along a run, in stretches of 8 to 30 s in a drawn order."""
    names = list(scene.icrs)
    if names == [""]:
        return None
    result, row, last = np.empty(count, dtype="U16"), 0, None
    while row < count:
        last = rng.choice([name for name in names if name != last or len(names) == 1])
        length = round(rng.uniform(8.0, 30.0) / STEP_S)
        result[row : row + length] = last
        row += length
    return result
