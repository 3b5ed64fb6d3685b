"""Cases for `gap` of robots of any size and pace: 0.12 to 2.5 m wide, 0.02 to 6 m/s.

Robots are those of `tests/blind/any_robot.py`; a sixth of the cases hides nothing, a third an
effect of the catalogue, half of them something without a name (`tests/blind/any_robot_effects.py`).
A kind and a seed give their bytes. Odometry comes at 2 to 100 Hz (means over each period, or
commands that hold for it), poses at 1 to 100 Hz; more than half of the robots have a gyroscope.
"""

from dataclasses import asdict, replace

import numpy as np

from odometry.io.run_folder import write_run_folder
from tests.blind import any_robot
from tests.blind.any_robot_effects import BY_COMMANDS, CLEAN, NAMED, UNNAMED, kind_named
from tests.blind.cases import Case
from tests.blind.ground import Ground, draw_ground
from tests.blind.hidden.courses import wander
from tests.blind.hidden.draw import parts_alone
from tests.blind.hidden.kind import Hidden
from tests.blind.hidden.mixed import both
from tests.blind.hidden.motion import move
from tests.blind.hidden.recorded import seen
from tests.blind.hidden.scene import RUNS, STEP_S, Drive, Scene, Sensors
from tests.blind.hidden.size import size_of_floor
from tests.blind.robot import Body, Icrs

WAYS = ("joystick", "joystick", "lawn", "stops", "reverse")  # that determine a model
ROWS = (1, 2, 5, 10, 20, 50)  # steps of a row of odometry
SIZES_OF_FLOOR = (2.0, 12.0)
SIZES_OF_PAIRS = (2.0, 30.0)
ATTEMPTS = 60
ATTEMPTS_OF_PAIRS = 240
UNMEASURED_RAD = 1e-9  # of a reference without yaw
NEED_YAW = ("sensor_heading", "gyroscope_scale", "gyroscope_bias")


def kind_of(seed):
    """What is hidden in the case of a seed, where no kind is asked for."""
    rng = np.random.default_rng([seed, 1])
    names = (CLEAN, NAMED, UNNAMED)[rng.choice(3, p=[1 / 6, 1 / 3, 1 / 2])]
    return str(rng.choice(names))


def pair_of(seed):
    """Two kinds at once for a seed: one with a name, and any other."""
    rng = np.random.default_rng([seed, 3])
    named = str(rng.choice(NAMED))
    others = [name for name in (NAMED, UNNAMED)[rng.integers(2)] if name != named]
    return f"{named}+{rng.choice(others)}"


def make_case(name, seed, folder):
    """Write the three run folders of a case; what is hidden shows at 2 to 12 times the noise.

    Of two kinds (`pair_of`) each shows at 2 to 30 times by itself.
    """
    kind, rng = kind_named(name), np.random.default_rng([seed, 2])
    by_commands = not set(name.split("+")).isdisjoint(BY_COMMANDS)
    least, most = SIZES_OF_PAIRS if "+" in name else SIZES_OF_FLOOR
    attempts = ATTEMPTS_OF_PAIRS if "+" in name else ATTEMPTS
    for attempt in range(attempts):
        if attempt % 6 == 0:
            robot = any_robot.draw(rng)
            scene = _scene(rng, robot, name)
        hide = kind.draw(rng, scene)
        drives = [_drive(rng, robot, scene, run, by_commands=by_commands) for run in RUNS]
        hidden = [hide(rng, drive.clock) if kind.true else Hidden() for drive in drives]
        alone = parts_alone(scene, move(scene, drives[1], hidden[1]))
        sizes = [size_of_floor(motion, scene) for motion in alone]
        if not kind.true or least <= min(sizes) <= max(sizes) <= most:
            break
    else:
        raise ValueError(f"{name} {seed}: no effect of the wanted size in {attempts} draws")
    hidden[0], slips = Hidden(), rng.uniform(0, 0.02)
    for run, drive, one in zip(RUNS, drives, hidden, strict=True):
        motion = move(scene, drive, both(_slips(rng, drive, slips), one))
        _record(folder / run, motion, scene, rng, by_commands=by_commands)
    gyroscope = bool(scene.sensors.gyroscope)
    return Case(
        *(name, seed, 1.0),
        **{run: folder / run for run in RUNS},
        effects=tuple(part[0] for part in kind.true),
        truth={"hidden": hidden[1].truth, "robot": _in_numbers(robot, scene.sensors, max(sizes))},
        parts=kind.true,
        acceptable_families=(*kind.acceptable, *(() if gyroscope else kind.without_gyroscope)),
        course=kind.course,
        gyroscope=gyroscope,
    )


def _body(rng, robot):
    track = robot.track_m
    length, radius = track * rng.uniform(1.0, 1.6), track * rng.uniform(0.15, 0.3)
    return Body("any", track, length, 1.2 * track, radius, 80 * track**2.5)


def _scene(rng, robot, name):
    """Positions are a tenth as noisy as two seconds of the fastest way are long, or less."""
    kind, body = kind_named(name), _body(rng, robot)
    good = [
        (rate_hz, sigma_m, sigma_rad)
        for rate_hz, sigma_m, sigma_rad, wanders_m in any_robot.SOURCES.values()
        if not wanders_m and sigma_m < 0.2 * robot.fastest_m_s
        if set(name.split("+")).isdisjoint(NEED_YAW) or np.isfinite(sigma_rad)
    ]
    rate_hz, sigma_m, sigma_rad = good[rng.integers(len(good))]
    sensors = Sensors(
        odometry_rows=int(rng.choice(ROWS)),
        pose_period_s=1 / rate_hz,
        sigma_position_m=sigma_m,
        sigma_yaw_rad=UNMEASURED_RAD if np.isnan(sigma_rad) else sigma_rad,
        sigma_tread_m_s=robot.fastest_m_s * 10 ** rng.uniform(-3.5, -2.0),
        sigma_gyroscope_rad_s=10 ** rng.uniform(-3.5, -1.7),
        sigma_attitude_rad=0.002,
        gyroscope="odometry" if kind.gyroscope == "always" or rng.random() < 0.6 else "",
    )
    ground = draw_ground(rng) if kind.sloped else Ground()
    while ground.waves:
        ground = draw_ground(rng)
    icrs = Icrs(**{name: float(value) for name, value in robot.truth.items()})
    return Scene(body, {"": icrs}, sensors, robot.fastest_m_s, ground)


def _in_numbers(robot, sensors, size):
    odometry_hz = 1 / (sensors.odometry_rows * STEP_S)
    numbers = {"track_m": robot.track_m, "fastest_m_s": robot.fastest_m_s, "size": size}
    return numbers | {"odometry_hz": odometry_hz, "pose_hz": 1 / sensors.pose_period_s}


def _drive(rng, robot, scene, run, *, by_commands):
    asked = replace(robot, way=str(rng.choice(WAYS)), lasts_s=rng.uniform(90.0, 220.0))
    speed, turn = any_robot.asked_motion(asked, rng)
    base, every = scene.base, round(STEP_S / any_robot.STEP_S)
    treads = np.column_stack([speed - turn * base.y_left, speed - turn * base.y_right])[::every]
    treads = treads / [base.alpha_left, base.alpha_right]
    if by_commands:
        rows = scene.sensors.odometry_rows
        treads = np.repeat(treads[::rows], rows, axis=0)[: len(treads)]
    ground = Ground() if run == "calibration" else scene.ground
    return Drive(treads, ground, (0.0, 0.0, float(rng.uniform(-3, 3))), None)


def _slips(rng, drive, share):
    """Slip factors of both treads that wander within half a second by up to two per cent."""
    clock = drive.clock
    factors = 1 + share * np.column_stack([wander(rng, clock, 0.25) for _ in range(2)])
    return Hidden(treads=lambda v: v * factors)


def _record(folder, motion, scene, rng, *, by_commands):
    sensors = scene.sensors
    edges = np.arange(0, len(motion.poses), sensors.odometry_rows)
    reported = motion.reported_m_s
    reported = reported[edges[:-1]] if by_commands else _means(reported, edges)
    sigmas = 0.0 if by_commands else sensors.sigma_tread_m_s
    reported = reported + sigmas * rng.standard_normal(reported.shape)
    odometry = {"t": edges[:-1] * STEP_S, "v_left": reported[:, 0], "v_right": reported[:, 1]}
    if not scene.ground.level:
        attitude = motion.poses[edges[:-1], 2:4]
        noisy = attitude + sensors.sigma_attitude_rad * rng.standard_normal(attitude.shape)
        odometry |= {"roll": noisy[:, 0], "pitch": noisy[:, 1]}
    if sensors.gyroscope:
        rates = _means(motion.hidden.gyroscope(motion.yaw_rates_rad_s)[:, None], edges)[:, 0]
        noise = sensors.sigma_gyroscope_rad_s * rng.standard_normal(len(rates))
        odometry["gyro_z"] = rates + noise + 0.005 * rng.normal()
    stamps_s, poses = seen(motion, scene, rng.uniform(0, sensors.pose_period_s))
    scatter = [*[sensors.sigma_position_m] * 2, sensors.sigma_yaw_rad]
    x, y, yaw = (poses + scatter * rng.standard_normal(poses.shape)).T
    unmeasured = sensors.sigma_yaw_rad == UNMEASURED_RAD
    yaw = np.where(unmeasured, np.nan, np.angle(np.exp(1j * yaw)))
    pose = {"t": stamps_s, "x": x, "y": y, "yaw": yaw}
    write_run_folder(folder, {"robot": asdict(scene.body)}, {"odometry": odometry, "pose": pose})


def _means(values, edges):
    """Means (N - 1, C) of values between edges (N,)."""
    summed = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    return np.diff(summed[edges], axis=0) / np.diff(edges)[:, None]
