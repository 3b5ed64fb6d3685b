"""Synthetic run folders, integrated by a plain loop with no code of the packages."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Run
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig

TRACK_WIDTH = 0.5
LENGTH = 0.9
ICRS = {
    "y_left": 0.45,
    "y_right": -0.36,
    "x_icr": 0.06,
    "alpha_left": 0.97,
    "alpha_right": 0.93,
}
SLOPE = {
    **ICRS,
    "lambda_1": 1.4,
    "lambda_2": 3.0,
    "v_max": 1.2,
    "half_width": 0.25,
    "half_length": 0.35,
}
INERTIA = {
    "zeta_0": 0.05,
    "zeta_1": 5e-4,
    "epsilon_0": 0.03,
    "epsilon_1": 8e-4,
    "eta_0": 1.6,
    "eta_1": 1e-3,
    "eta_2": 2e-5,
    "h": 0.67,
    "mass": 50.0,
    "x_cm": 0.02,
    "y_cm": 0.01,
    "track_width": 0.5,
}
START = (1.0, -2.0, 0.7)
POSITION_SIGMA_M = 0.01
YAW_SIGMA_RAD = math.radians(0.3)
STATED = {"position_sigma_m": POSITION_SIGMA_M, "yaw_sigma_rad": YAW_SIGMA_RAD}


def icr_twist(values):
    """Twist of one sample by data/README.md."""

    def twist_of(v_left, v_right, *_):
        left, right = values["alpha_left"] * v_left, values["alpha_right"] * v_right
        width = values["y_left"] - values["y_right"]
        omega = (right - left) / width
        v_x = (right * values["y_left"] - left * values["y_right"]) / width
        return v_x, -values["x_icr"] * omega, omega

    return twist_of


def slope_twist(values):
    """Twist of one sample by Martinez 2024 eq. 4-11, in the paper's own frame (X right)."""

    def twist_of(v_left, v_right, roll, pitch):
        alpha = math.asin(math.cos(pitch) * math.sin(roll))
        phi = math.asin(-math.sin(pitch) / math.cos(alpha))
        left, right = values["alpha_left"] * v_left, values["alpha_right"] * v_right  # eq. 11
        sign = (right > left) - (right < left)  # eq. 8
        drift = sign * max(values["v_max"] - abs(right + left) / 2, 0.0)
        x_l = -values["y_left"] + drift * values["lambda_1"] * phi  # eq. 5
        x_r = -values["y_right"] + drift * values["lambda_1"] * phi  # eq. 6
        y = values["x_icr"] + drift * values["lambda_1"] * alpha  # eq. 7
        if (right > left and -phi > abs(alpha)) or (right < left and phi > abs(alpha)):
            x_l += (1 - abs(alpha / phi)) * drift * values["lambda_2"] * phi  # eq. 9
        if (right > left and phi > abs(alpha)) or (right < left and -phi > abs(alpha)):
            x_r += (1 - abs(alpha / phi)) * drift * values["lambda_2"] * phi  # eq. 10
        x_l, x_r = min(x_l, -values["half_width"]), max(x_r, values["half_width"])
        y = max(min(y, values["half_length"]), -values["half_length"])
        omega = (right - left) / (x_r - x_l)  # eq. 4
        lateral = y * omega
        longitudinal = (x_r * left - x_l * right) / (x_r - x_l)
        return longitudinal, -lateral, omega

    return twist_of


def in_order(rows):
    """Twists or attitudes that are known before the drive, one for each row of odometry."""
    rows = iter(np.asarray(rows).tolist())
    return lambda *_: tuple(next(rows))


def plane(tilt_rad):
    """Roll and pitch on a plane that falls towards +x of the world, by the yaw."""

    def attitude_of(_, yaw):
        pitch = math.atan(math.tan(tilt_rad) * math.cos(yaw))
        return math.asin(math.sin(tilt_rad) * math.sin(yaw)), pitch

    return attitude_of


def level(*_):
    return 0.0, 0.0


def step(pose, twist, roll, pitch, step_s):
    """The pose after a turn about the momentary centre, in the tilted plane of the body."""
    (x, y, yaw), (v_x, v_y, omega) = pose, twist
    angle = omega * step_s
    cosine, sine = math.cos(angle), math.sin(angle)
    if abs(angle) < 1e-9:
        along, across = v_x * step_s, v_y * step_s
    else:
        centre_x, centre_y = -v_y / omega, v_x / omega
        along = centre_x - (cosine * centre_x - sine * centre_y)
        across = centre_y - (sine * centre_x + cosine * centre_y)
    cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    cr, sr = math.cos(roll), math.sin(roll)
    ahead = (cy * cp, sy * cp)  # the first two rows of Rz(yaw) Ry(pitch) Rx(roll)
    left = (cy * sp * sr - sy * cr, sy * sp * sr + cy * cr)
    heading = [cosine * a + sine * b for a, b in zip(ahead, left, strict=True)]
    return (
        x + ahead[0] * along + left[0] * across,
        y + ahead[1] * along + left[1] * across,
        math.atan2(heading[1], heading[0]),
    )


def walk(odometry, pose_s, twist_of, attitude_of=level):
    """Poses at their stamps, and the attitude at each row (t, v_left, v_right, ...) of odometry.

    Speeds and attitude hold until the next row; the poses cut the steps between rows.
    """
    rows = {row[0]: row for row in np.asarray(odometry).tolist()}
    wanted = set(map(float, pose_s))
    stamps = sorted({*rows, *wanted})
    pose, poses, attitudes, now = START, [], [], None
    for i, stamp in enumerate(stamps):
        if stamp in rows:
            attitude = attitude_of(stamp, pose[2])
            attitudes.append(attitude)
            now = twist_of(*rows[stamp][1:3], *attitude, *rows[stamp][3:])
        if stamp in wanted:
            poses.append(pose)
        if i + 1 < len(stamps):
            pose = step(pose, now, *attitude, stamps[i + 1] - stamp)
    return np.array(poses), np.array(attitudes)


def commands(rng, count, *, rate_hz=10.0, held=15, low=-0.9, high=1.1):
    """Rows t, v_left, v_right: new speeds every `held` rows."""
    changes = rng.uniform(low, high, (-(-count // held), 2))
    speeds = np.repeat(changes, held, axis=0)[:count]
    return np.column_stack([np.arange(count) / rate_hz, speeds])


def write(
    folder,
    odometry,
    pose_s,
    twist_of,
    *,
    attitude_of=level,
    terrain=None,
    terrain_column=None,
    window=None,
    track_width=TRACK_WIDTH,
):
    """Write a run folder whose poses have no noise."""
    poses, attitudes = walk(odometry, pose_s, twist_of, attitude_of)
    folder.mkdir(parents=True, exist_ok=True)
    ground = f'[run]\nterrain = "{terrain}"\n' if terrain else ""
    (folder / "run.toml").write_text(
        f"[robot]\ntrack_width = {track_width}\nlength = {LENGTH}\nmass = 50.0\n{ground}"
    )
    names = ["t", "v_left", "v_right", "accel_x", "accel_y"][: odometry.shape[1]]
    columns = [*odometry.T, *attitudes.T]
    names += ["roll", "pitch"]
    if terrain_column is not None:
        names.append("terrain")
        columns.append(terrain_column)
    _write_csv(folder / "odometry.csv", names, columns)
    names, columns = ["t", "x", "y", "yaw"], [pose_s, *poses.T]
    if window is not None:
        names.append("window")
        columns.append(window)
    _write_csv(folder / "pose.csv", names, columns)
    return folder


def _write_csv(file, names, columns):
    rows = [",".join(map(_cell, row)) for row in zip(*columns, strict=True)]
    file.write_text("\n".join([",".join(names), *rows]) + "\n")


def _cell(value):
    if isinstance(value, str):
        return value
    return "" if math.isnan(value) else repr(float(value))


def noisy(run, rng, position_m=POSITION_SIGMA_M, yaw_rad=YAW_SIGMA_RAD):
    """The run with noise on every pose."""
    columns = dict(run.pose.columns)
    for name, sigma in (("x", position_m), ("y", position_m), ("yaw", yaw_rad)):
        columns[name] = columns[name] + sigma * rng.standard_normal(len(run.pose))
    return replace(run, pose=Table(run.pose.file, columns, run.pose.lines))


def between(first, second):
    """The second pose in the frame of the first, by plain trigonometry."""
    dx, dy = second[0] - first[0], second[1] - first[1]
    cosine, sine = math.cos(first[2]), math.sin(first[2])
    turn = math.remainder(second[2] - first[2], 2 * math.pi)
    return np.array([cosine * dx + sine * dy, -sine * dx + cosine * dy, turn])


@pytest.fixture(scope="session")
def synthetic():
    """The functions and numbers above."""
    return SimpleNamespace(
        between=between,
        commands=commands,
        drive_under_inertia=drive_under_inertia,
        icr_twist=icr_twist,
        icrs=ICRS,
        in_order=in_order,
        inertia=INERTIA,
        level=level,
        noisy=noisy,
        plane=plane,
        slope=SLOPE,
        slope_twist=slope_twist,
        stated=STATED,
        step=step,
        track_width=TRACK_WIDTH,
        walk=walk,
        write=write,
    )


@pytest.fixture(scope="session")
def winding(tmp_path_factory):
    """Two minutes of varied turns on level ground, poses at 2.5 Hz off the odometry's stamps."""
    rng = np.random.default_rng(1)
    odometry = commands(rng, 1200)
    pose_s = np.arange(0.03, odometry[-1, 0], 0.4)
    folder = tmp_path_factory.mktemp("runs") / "winding"
    return Run.read(write(folder, odometry, pose_s, icr_twist(ICRS), terrain="gravel"))


def drive_under_inertia(folder, held):
    """Ninety seconds of fast turns under inertia, new speeds every `held` tenths of a second."""
    model = MODELS["icr_inertia"]
    odometry = commands(np.random.default_rng(4), 900, held=held, low=-1.5, high=1.5)
    twist_of = in_order(model.twist(model.pack(INERTIA), Inputs(odometry[:, 1:])))
    return Run.read(write(folder, odometry, np.arange(0, 89.5, 0.3), twist_of))


@pytest.fixture(scope="session")
def inertial(tmp_path_factory):
    """Few different speeds: many values of H give every sample the same sign."""
    return drive_under_inertia(tmp_path_factory.mktemp("runs") / "inertial", 15)


@pytest.fixture(scope="session")
def stated():
    """Settings that state the noise which `noisy` adds."""
    return WindowConfig(**STATED)
