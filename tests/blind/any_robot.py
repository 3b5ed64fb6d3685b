"""Clean recordings of robots of any size and pace, by formulas: 0.12 to 2.5 m wide, 0.02 to 6 m/s.

Nothing is at fault in them. Slip factors, noise, rates and ways of driving are drawn at random: a
small robot beside a receiver that scatters by a metre, a slow one whose gyroscope has a bias as
large as its turns, encoders of few ticks, odometry at 2 Hz.
"""

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

STEP_S = 0.005  # of the motion
WAYS = ("spins", "straight", "stops", "joystick", "joystick", "lawn", "circle", "reverse")
ODOMETRY_HZ = (2, 5, 10, 20, 50, 100, 200)
# Rate [Hz], noise of positions [m] and of yaw [rad] (NaN: not measured), of positions that wander.
SOURCES = {
    "lidar": (10, 0.01, 0.003, 0.0),
    "gnss": (1, 0.8, np.nan, 0.5),
    "mocap": (100, 0.001, 0.001, 0.0),
    "slam": (5, 0.02, 0.005, 0.0),
    "slow slam": (1, 0.02, 0.005, 0.0),
    "rtk": (5, 0.015, np.nan, 0.0),
}


@dataclass(frozen=True)
class Robot:
    """A robot, how it is driven, and its parameters of the model `icr`."""

    track_m: float
    fastest_m_s: float
    sharpest_rad_s: float
    way: str
    lasts_s: float
    source: str
    truth: dict


def draw(rng):
    track_m = np.exp(rng.uniform(np.log(0.12), np.log(2.5)))
    fastest_m_s = np.exp(rng.uniform(np.log(0.08), np.log(6.0))) * np.clip(track_m, 0.3, 1.0)
    wider = track_m / 2 * rng.uniform(1.1, 2.6)
    left, right = rng.uniform(0.93, 1.07, 2) * wider
    alphas = rng.uniform(0.9, 1.0, 2)
    x_icr = rng.uniform(-0.15, 0.15) * track_m
    return Robot(
        track_m,
        fastest_m_s,
        min(rng.uniform(0.3, 1.6) * fastest_m_s / track_m, 3.5),
        str(rng.choice(WAYS)),
        np.exp(rng.uniform(np.log(40.0), np.log(600.0))),
        str(rng.choice(list(SOURCES))),
        {"y_left": left, "y_right": -right, "x_icr": x_icr}
        | {"alpha_left": alphas[0], "alpha_right": alphas[1]},
    )


def write_clean_run(folder, seed, drive=0):
    """Write a run folder with the truth beside it; returns the robot. A seed gives its bytes.

    Further drives are of the same robot, with commands, rates and noise of their own.
    """
    rng = np.random.default_rng([seed, 20261128])
    robot = draw(rng)
    if drive:
        rng = np.random.default_rng([seed, 20261128, drive])
    truth = robot.truth
    speed, turn = asked_motion(robot, rng)
    treads = np.stack([speed - turn * truth["y_left"], speed - turn * truth["y_right"]])
    treads /= np.array([[truth["alpha_left"]], [truth["alpha_right"]]])
    moved = _slipping(treads, truth, rng)
    turn = (moved[1] - moved[0]) / (truth["y_left"] - truth["y_right"])
    ahead = (moved[1] * truth["y_left"] - moved[0] * truth["y_right"]) / (
        truth["y_left"] - truth["y_right"]
    )
    yaw = np.cumsum(turn) * STEP_S + rng.uniform(-3, 3)
    midway = yaw - turn * STEP_S / 2
    velocity = (ahead - 1j * truth["x_icr"] * turn) * np.exp(1j * midway)
    place = np.cumsum(velocity) * STEP_S
    folder.mkdir(parents=True)
    (folder / "run.toml").write_text(f"[robot]\ntrack_width = {robot.track_m:.4f}\n", "utf-8")
    _write_odometry(folder, robot, treads, turn, rng)
    _write_poses(folder, robot, place, yaw, rng)
    return robot


def asked_motion(robot, rng):
    """Forward speed and turn rate (N,) that a driver asks for, through a lag of the drives."""
    count = int(robot.lasts_s / STEP_S)
    asked, begin = np.zeros((2, count)), 0
    while begin < count:
        after = begin + int(rng.uniform(1.5, 12.0) / STEP_S)
        asked[:, begin:after] = np.array(_share(robot.way, rng))[:, None]
        begin = after
    gain = STEP_S / rng.uniform(0.1, 1.0)
    speed, turn = lfilter([gain], [1.0, gain - 1.0], asked)
    return speed * robot.fastest_m_s, turn * robot.sharpest_rad_s


def _share(way, rng):
    """Shares of the fastest speed and of the sharpest turn."""
    side, some = rng.choice([-1.0, 1.0]), rng.uniform(0.3, 1.0)
    return {
        "spins": (0.0, side * some) if rng.random() < 0.7 else (some, 0.0),
        "straight": (some, 0.03 * rng.normal()),
        "stops": (0.0, 0.0) if rng.random() < 0.6 else (some, rng.uniform(-0.5, 0.5)),
        "joystick": (rng.uniform(-0.4, 1.0), 0.4 * rng.normal()),
        "lawn": (some, 0.0) if rng.random() < 0.6 else (0.3, 0.7 * side),
        "circle": (0.6, 0.5),
        "reverse": (-some, 0.4 * rng.normal()),
    }[way]


def _slipping(treads, truth, rng):
    """What the treads (2, N) move, by slip factors that wander by up to two per cent."""
    keeps = 1 - STEP_S / 0.5
    wander = lfilter([1.0], [1.0, -keeps], rng.normal(size=treads.shape)) * np.sqrt(1 - keeps**2)
    alphas = np.array([[truth["alpha_left"]], [truth["alpha_right"]]])
    return alphas * treads * (1 + rng.uniform(0, 0.02) * wander)


def _write_odometry(folder, robot, treads, turn, rng):
    """Means over each period, of ticks that are counted; a gyroscope with noise and a bias."""
    every = int(1 / STEP_S / rng.choice(ODOMETRY_HZ))
    edges = np.arange(every, treads.shape[1] - every, every)
    tick_m = rng.choice([0.0, 1e-4, 5e-4, 2e-3]) * min(1.0, robot.fastest_m_s)
    counted = np.cumsum(treads, axis=1) * STEP_S
    if tick_m:
        counted = np.round(counted / tick_m) * tick_m
    columns = {"t": edges[:-1] * STEP_S}
    for name, way_m in zip(("v_left", "v_right"), counted, strict=True):
        columns[name] = np.diff(way_m[edges]) / (every * STEP_S)
    if rng.random() < 0.75:
        rates = np.diff(np.cumsum(turn)[edges]) / every
        noise = 10 ** rng.uniform(-3.5, -1.7) * rng.normal(size=len(rates))
        columns["gyro_z"] = rates + noise + 0.01 * rng.normal()
    _write(folder / "odometry.csv", columns)


def _write_poses(folder, robot, place, yaw, rng):
    rate_hz, noise_m, noise_rad, wanders_m = SOURCES[robot.source]
    every = int(1 / STEP_S / rate_hz)
    rows = np.arange(int(rng.uniform(0, every)), len(yaw), every)
    knots_s = np.arange(0.0, robot.lasts_s + 60.0, 30.0)
    measured = []
    for axis in (place.real, place.imag):
        wander = np.interp(rows * STEP_S, knots_s, rng.normal(size=len(knots_s)))
        measured.append(axis[rows] + noise_m * rng.normal(size=len(rows)) + wanders_m * wander)
    turned = yaw[rows] + noise_rad * rng.normal(size=len(rows))
    stamps_s = rows * STEP_S + (rng.uniform(-0.002, 0.002, len(rows)) if rng.random() < 0.3 else 0)
    columns = {"t": stamps_s, "x": measured[0], "y": measured[1]}
    _write(folder / "pose.csv", columns | {"yaw": (turned + np.pi) % (2 * np.pi) - np.pi})
    exact = {"t": rows * STEP_S, "x": place.real[rows], "y": place.imag[rows], "yaw": yaw[rows]}
    _write(folder / "truth.csv", exact)


def _write(file, columns):
    rows = np.column_stack(list(columns.values())).tolist()
    lines = [",".join("" if cell != cell else f"{cell:.6f}" for cell in row) for row in rows]  # noqa: PLR0124
    file.write_text("\n".join([",".join(columns), *lines]) + "\n", "utf-8")
