"""Drives in skid modes of robots of any size and pace, by formulas: 0.12 to 2.5 m wide.

Three terrains of one robot are calibrated, each on two drives. A case is a further drive over two
of them, in which something may go wrong at a random moment: in the record, or in the motion, which
no mode of the set describes then. Speeds, turns, rates and noise are those of
`tests/blind/any_robot.py`; its formulas know nothing of the program.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import lfilter

from tests.blind import any_robot
from tests.blind.any_robot import STEP_S
from tests.blind.modes.any_robot_faults import FAULTS

WAYS = ("joystick", "joystick", "lawn", "spins", "stops", "reverse", "circle")
ODOMETRY_HZ = (2, 5, 10, 20, 50, 100)
SOURCES = (*any_robot.SOURCES, None)  # of poses; None: there are none
MOST_ROWS = 8000  # of a drive
STANDS_S = 3.0  # at the start of each drive
OUTSIDE = ("unseen_terrain", "slope", "one_side_slips")
RECORD = (
    "gyro_bias",
    "gyro_scale",
    "gyro_spikes",
    "gyro_frozen",
    "poses_late",
    "treads_swapped",
    "double_speed",
    "wheel_scale",
    "dropouts",
    "gyro_in_degrees",
)


@dataclass(frozen=True)
class World:
    """A robot, its sensors, and the ICR parameters of each terrain; `other` is not calibrated."""

    robot: any_robot.Robot
    terrains: dict
    source: str | None
    odometry_hz: float
    gyro_noise_rad_s: float
    gyro_bias_rad_s: float
    tick_m: float
    lag_s: float
    wanders: float


@dataclass
class Drive:
    """Motion at steps of STEP_S, and what the terrain was."""

    treads: np.ndarray
    turn: np.ndarray
    place: np.ndarray
    yaw: np.ndarray
    labels: np.ndarray


@dataclass
class Record:
    """Tables of a run folder, by column, and from when on [s] they are at fault."""

    odometry: dict
    pose: dict | None
    onset_s: float
    moved: Drive

    def __post_init__(self):
        self.late = self.odometry["t"] >= self.onset_s
        self.gyro = self.odometry["gyro_z"]


def world_of(seed):
    rng = np.random.default_rng([seed, 20261129])
    robot = any_robot.draw(rng)
    # gains of neighbours are apart by an eighth to a third
    widths = np.cumprod(np.append(1.0, 1 + rng.uniform(0.12, 0.35, 3)))
    names = [str(name) for name in rng.permutation(["asphalt", "grass", "sand", "other"])]
    terrains = {}
    for name, width in zip(names, widths / widths.mean(), strict=True):
        left, right = width * rng.uniform(0.97, 1.03, 2)
        alphas = rng.uniform(0.94, 1.0, 2)
        terrains[name] = robot.truth | {
            "y_left": robot.truth["y_left"] * left,
            "y_right": robot.truth["y_right"] * right,
            "alpha_left": alphas[0],
            "alpha_right": alphas[1],
        }
    odometry_hz = rng.choice(ODOMETRY_HZ)
    return World(
        robot,
        terrains,
        SOURCES[rng.integers(len(SOURCES))],
        min(odometry_hz, MOST_ROWS / lasts_s(robot, 40.0)),
        10 ** rng.uniform(-3.5, -2.0),
        rng.uniform(0.001, 0.006),
        rng.choice([0.0, 1e-4, 5e-4, 2e-3]) * min(1.0, robot.fastest_m_s),
        rng.uniform(0.05, 0.3),
        rng.uniform(0.0, 0.02),
    )


def lasts_s(robot, turns_rad):
    """How long a drive lasts that turns about so far."""
    return float(np.clip(turns_rad / robot.sharpest_rad_s, 70.0, 400.0))


def write_calibration(world, seed, folder):
    """Two drives on each known terrain; returns their folders."""
    written = []
    known = sorted(set(world.terrains) - {"other"})
    for place, name in enumerate(known):
        for drive in range(2):
            rng = np.random.default_rng([seed, 20261129, 1, place, drive])
            robot = replace(world.robot, way="joystick", lasts_s=lasts_s(world.robot, 25.0))
            count = int(robot.lasts_s / STEP_S)
            moved = driven(world, asked(robot, rng), np.full(count, name), rng)
            written.append(folder / f"{name}_{drive}")
            write(world, moved, rng, written[-1], terrain=name)
    return written


def write_case(world, seed, kind, folder):
    """The further drive with a fault, or `clean`; returns its onset [s]."""
    rng = np.random.default_rng([seed, 20261129, 2])
    way = str(rng.choice(WAYS))
    robot = replace(world.robot, way=way, lasts_s=lasts_s(world.robot, 40.0))
    treads = asked(robot, rng)
    count = treads.shape[1]
    first, second = rng.permutation(sorted(set(world.terrains) - {"other"}))[:2]
    change, onset = (rng.uniform([0.25, 0.35], [0.75, 0.7]) * count).astype(int)
    labels = np.where(np.arange(count) < change, first, second)
    drawn = np.random.default_rng([seed, 20261129, 3, *kind.encode()])
    late = np.arange(count) >= onset
    if kind == "unseen_terrain":
        labels = np.where(late, "other", labels)
    if kind == "double_speed":
        ramp = np.clip((np.arange(count) - onset) * STEP_S, 0.0, 1.0)
        treads = treads * (1 + ramp)
    moved = driven(world, treads, labels, rng, outside=(kind, late, drawn))
    if kind == "one_side_slips":  # the robot moves as in no mode of the set, whatever it is on
        moved.labels = np.where(late, "other", labels)
    onset_s = onset * STEP_S
    write(world, moved, rng, folder, fault=(kind, onset_s, drawn))
    return onset_s


def asked(robot, rng):
    """Speed and turn (2, N) as shares a driver asks for; the robot stands at the start."""
    speed, turn = any_robot.asked_motion(robot, rng)
    begun = np.arange(len(speed)) * STEP_S > STANDS_S
    return np.stack([speed, turn]) * begun


def driven(world, motion, labels, rng, outside=("clean", None, None)):
    """The motion (2, N) that is asked for as on the middling terrain; the terrains change it."""
    names, rows = np.unique(labels, return_inverse=True)
    columns = {
        key: np.array([world.terrains[name][key] for name in names])[rows]
        for key in ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
    }
    usual = world.robot.truth
    treads = np.stack([motion[0] - motion[1] * usual[side] for side in ("y_left", "y_right")])
    keeps = 1 - STEP_S / 0.5
    wander = lfilter([1.0], [1.0, -keeps], rng.normal(size=treads.shape)) * np.sqrt(1 - keeps**2)
    gain = STEP_S / world.lag_s
    slips = np.stack([columns["alpha_left"], columns["alpha_right"]])
    kind, late, drawn = outside
    if kind == "one_side_slips":
        side = np.abs(treads[:, late]).mean(axis=1).argmax()  # one that stands cannot slip
        slips[side, late] *= 1 - drawn.uniform(0.2, 0.4)
    moved = lfilter([gain], [1.0, gain - 1.0], slips * treads * (1 + world.wanders * wander))
    width = columns["y_left"] - columns["y_right"]
    turn = (moved[1] - moved[0]) / width
    ahead = (moved[1] * columns["y_left"] - moved[0] * columns["y_right"]) / width
    slides = np.zeros(len(ahead), dtype=complex)
    yaw = np.cumsum(turn) * STEP_S + rng.uniform(-3, 3)
    if kind == "slope":  # slides down as it turns, and turns less across the slope
        downhill, share = drawn.uniform(-np.pi, np.pi), drawn.uniform(0.1, 0.3)
        turn = turn * (1 - late * share * np.abs(np.sin(yaw - downhill)))
        yaw = np.cumsum(turn) * STEP_S + yaw[0]
        slides = late * share * np.abs(moved).mean(axis=0) * np.exp(1j * downhill) / 2
    body = ahead - 1j * columns["x_icr"] * turn
    place = np.cumsum(body * np.exp(1j * (yaw - turn * STEP_S / 2)) + slides) * STEP_S
    return Drive(treads, turn, place, yaw, labels)


def write(world, moved, rng, folder, *, terrain=None, fault=("clean", 0.0, None)):
    """The run folder, with truth.csv; `fault` changes the record from its onset on."""
    folder.mkdir(parents=True)
    lines = [f"[robot]\ntrack_width = {world.robot.track_m:.4f}"]
    lines += [f'[run]\nterrain = "{terrain}"'] if terrain else []
    (folder / "run.toml").write_text("\n".join(lines) + "\n", "utf-8")
    every = max(round(1 / STEP_S / world.odometry_hz), 1)
    edges = np.arange(every, len(moved.yaw) - every, every)
    counted = np.cumsum(moved.treads, axis=1) * STEP_S
    if world.tick_m:
        counted = np.round(counted / world.tick_m) * world.tick_m
    left, right = np.diff(counted[:, edges], axis=1) / (every * STEP_S)
    rates = np.diff(np.cumsum(moved.turn)[edges]) / every
    rates += world.gyro_noise_rad_s * rng.normal(size=len(rates))
    rates += world.gyro_bias_rad_s * rng.normal()
    odometry = {"t": edges[:-1] * STEP_S, "v_left": left, "v_right": right, "gyro_z": rates}
    pose = _poses(world, moved, rng)
    kind, onset_s, drawn = fault
    record = Record(odometry, pose, onset_s, moved)
    if kind in FAULTS:
        FAULTS[kind](record, drawn)
    _write(folder / "odometry.csv", record.odometry)
    if record.pose is not None:
        _write(folder / "pose.csv", record.pose)
    rows = np.append(edges[:-1], len(moved.yaw) - 1)
    exact = {"t": rows * STEP_S, "x": moved.place.real[rows], "y": moved.place.imag[rows]}
    _write(folder / "truth.csv", exact | {"yaw": moved.yaw[rows], "terrain": moved.labels[rows]})


def _poses(world, moved, rng):
    if world.source is None:
        return None
    rate_hz, noise_m, noise_rad, wanders_m = any_robot.SOURCES[world.source]
    rows = np.arange(0, len(moved.yaw), int(1 / STEP_S / rate_hz))
    knots_s = np.arange(0.0, rows[-1] * STEP_S + 60.0, 30.0)
    columns = {"t": rows * STEP_S}
    for name, axis in (("x", moved.place.real), ("y", moved.place.imag)):
        wander = np.interp(rows * STEP_S, knots_s, rng.normal(size=len(knots_s)))
        columns[name] = axis[rows] + noise_m * rng.normal(size=len(rows)) + wanders_m * wander
    return columns | {"yaw": moved.yaw[rows] + noise_rad * rng.normal(size=len(rows))}


def _write(file, columns):
    lines = [",".join(columns)]
    for row in zip(*(column.tolist() for column in columns.values()), strict=True):
        cells = (c if isinstance(c, str) else "" if c != c else f"{c:.7f}" for c in row)  # noqa: PLR0124
        lines.append(",".join(cells))
    file.write_text("\n".join(lines) + "\n", "utf-8")
