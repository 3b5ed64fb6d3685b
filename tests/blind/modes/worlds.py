"""Robots that drive in modes: three terrains, or three sets of slipping wheels, and one unseen.

A world is a robot with its modes, of which calibration runs are made, and drives through two modes
that it knows. Three worlds follow the papers' formulae, three stand on simulated contacts. Nothing
here depends on how modes are identified or followed.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.friction import Shear
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import contact_vehicle, read_contact_vehicle
from odometry.simulation.skid_experiments import GROUNDS, ground_traction, wheel_traction
from tests.blind.commands import RATE_HZ, Limits, draw_commands
from tests.blind.contact_cases import _draw_contacts as draw_contacts
from tests.blind.effects import draw_effect
from tests.blind.ground import Ground
from tests.blind.motion import Motion, drive
from tests.blind.robot import Body, draw_body, draw_icrs
from tests.blind.sensors import record

VEHICLES = Path(__file__).parents[3] / "data" / "vehicles"
CALIBRATION_S, DRIVEN_S = 60.0, 70.0
WIDTHS = (0.8, 1.0, 1.22, 1.5)  # of the ICRs on four terrains
SHARES = {"wet_leaves": 0.42, "packed_earth": 0.73}  # of traction sideways, unseen terrains
WHEELS = ((), ("front_left", "front_right"), ("front_right", "rear_right"))
STANDS_S = 1.0  # where a slope begins
LEVEL = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class World:
    """A robot and its modes.

    Attributes
    ----------
    key, kind : str
        Kind of mode set that fits: velocity (by yaw rate) or traction (by poses, too).
    body : Body
    known, unseen : tuple of str
        Names of the modes, and of terrains that no calibration has.
    limits : Limits
    gyro_sigma_rad_s, gyro_bias_rad_s : float
        Noise beyond that of `sensors`, and one standard deviation of the bias of a run.
    moves : function
        Motion of commands (N, 2), labels (N,), a start pose, a slope [rad] and its direction, and
        what else befalls the robot.
    """

    key: str
    kind: str
    body: Body
    known: tuple[str, ...]
    unseen: tuple[str, ...]
    limits: Limits
    gyro_sigma_rad_s: float
    gyro_bias_rad_s: float
    moves: Callable[..., Motion]


def calibration_runs(world, folder, seed=0):
    """Folders of a run in each mode, whose labels name it."""
    rng = np.random.default_rng([seed, *world.key.encode()])
    folders = []
    for name in world.known:
        for part in range(2):
            commands = draw_commands(rng, CALIBRATION_S, world.limits)
            labels = np.full(len(commands), name, dtype="U24")
            motion = world.moves(commands, labels, _start(rng))
            folders.append(written(world, motion, rng, folder / f"{name}_{part}"))
    return folders


def draw_drive(world, rng):
    """Commands, labels of two modes, and the row at which a fault begins."""
    commands = draw_commands(rng, DRIVEN_S, world.limits)
    first, second = rng.permutation(world.known)[:2]
    change = rng.uniform(0.25, 0.4) * len(commands)
    onset = round(rng.uniform(0.5, 0.65) * len(commands))
    labels = np.where(np.arange(len(commands)) < change, first, second).astype("U24")
    return commands, labels, onset


def on_a_slope(world, commands, labels, onset, rng):
    """The robot stands for a moment where the slope begins, and drives on."""
    stands = round(STANDS_S * RATE_HZ)
    commands = commands.copy()
    commands[onset - stands : onset] = 0.0
    ramp = np.linspace(0.0, 1.0, RATE_HZ)[:, None]
    commands[onset : onset + RATE_HZ] *= ramp[: len(commands) - onset]
    start = _start(rng)
    before = world.moves(commands[: onset + 1], labels[: onset + 1], start)
    slope = (np.deg2rad(rng.uniform(6.0, 10.0)), rng.uniform(-np.pi, np.pi))
    after = world.moves(commands[onset:], labels[onset:], before.poses[-1, [0, 1, 4]], slope=slope)
    return Motion(
        before.step_s,
        commands,
        np.concatenate([before.poses[:-1], after.poses]),
        np.concatenate([before.yaw_rates_rad_s[:-1], after.yaw_rates_rad_s]),
        labels,
    )


def moved(world, commands, labels, rng, **befalls):
    """Motion from a pose at random."""
    return world.moves(commands, labels, _start(rng), **befalls)


def written(world, motion, rng, folder):
    """The folder of a run: the sensors' record, a gyroscope of this world, the labels."""
    noise = rng.normal(0.0, world.gyro_sigma_rad_s, len(motion.yaw_rates_rad_s))
    rates = motion.yaw_rates_rad_s + noise + rng.normal(0.0, world.gyro_bias_rad_s)
    measured = Motion(motion.step_s, motion.commands_m_s, motion.poses, rates, motion.labels)
    return record(folder, measured, world.body, {}, rng=rng, noise=1.0)


def worlds():
    """All six, by key; each is the same in every call."""
    made = [
        _formula_world("formula_velocity", "velocity", 0.01, 0.004),
        _formula_world("formula_velocity_2", "velocity", 0.003, 0.01),
        _formula_world("formula_traction", "traction", 0.005, 0.004),
        _contact_world("husky_terrains", "velocity", "husky_like", 0.02, 0.004),
        _contact_world("own_terrains", "velocity", None, 0.005, 0.008),
        _contact_world("husky_wheels", "traction", "husky_like", 0.01, 0.004, wheels=True),
    ]
    return {world.key: world for world in made}


def _formula_world(key, kind, gyro_sigma_rad_s, gyro_bias_rad_s):
    """Terrains by ICRs (data/README.md), slopes by Martinez 2024."""
    rng = np.random.default_rng([5, *key.encode()])
    body = draw_body(rng)
    icrs = draw_icrs(rng, body)
    names = [str(name) for name in rng.permutation(["asphalt", "grass", "sand", "snow"])]
    grounds = {}
    for name, width in zip(names, WIDTHS, strict=True):
        left, right = width * rng.uniform(0.97, 1.03, 2)
        grounds[name] = {
            "y_left": icrs.y_left * left,
            "y_right": icrs.y_right * right,
            "x_icr": icrs.x_icr + body.length * rng.uniform(-0.1, 0.1),
            "alpha_left": icrs.alpha_left * rng.uniform(0.93, 1.0),
            "alpha_right": icrs.alpha_right * rng.uniform(0.93, 1.0),
        }
    unseen = names[rng.integers(4)]
    sliding = draw_effect("slope_sliding", rng, body, icrs)
    always = {"terrain": grounds, "actuator_lag": {"time_constant_s": rng.uniform(0.06, 0.15)}}

    def moves(commands, labels, start, slope=LEVEL, **befalls):
        rise = np.tan(slope[0])
        level = slope == LEVEL
        effects = always if level else always | {"slope_sliding": sliding}
        ground = Ground() if level else Ground((rise * np.cos(slope[1]), rise * np.sin(slope[1])))
        return drive(
            commands,
            body,
            icrs,
            effects | befalls,
            ground=ground,
            start=tuple(start),
            labels=labels,
        )

    limits = Limits(1.0, 1.2, 1.2, icrs.width)
    known = tuple(name for name in names if name != unseen)
    return World(
        key, kind, body, known, (unseen,), limits, gyro_sigma_rad_s, gyro_bias_rad_s, moves
    )


def _contact_world(key, kind, vehicle, gyro_sigma_rad_s, gyro_bias_rad_s, *, wheels=False):
    """Terrains by friction and its share sideways, or wheels that slip."""
    rng = np.random.default_rng([6, *key.encode()])
    body = draw_body(rng)
    if vehicle is None:
        vehicle = contact_vehicle(asdict(body), draw_contacts(rng, body)[0])
    else:
        vehicle = read_contact_vehicle(VEHICLES / f"{vehicle}.toml")
        body = Body(**{name: vehicle.robot[name] for name in asdict(body)})
    if wheels:
        pieces = {piece.name: piece for piece in (wheel_traction(vehicle, one) for one in WHEELS)}
        other = wheel_traction(vehicle, ("rear_left", "rear_right"))
        unseen = {other.name: other}
    else:
        pieces = {name: ground_traction(vehicle, name) for name in GROUNDS}
        unseen = {name: _other_ground(vehicle, name, share) for name, share in SHARES.items()}
    every = pieces | unseen

    def moves(commands, labels, start, slope=LEVEL):
        cuts = np.append(0, np.flatnonzero(labels[1:] != labels[:-1]) + 1)
        traction = [
            Traction(
                labels[cut],
                cut / RATE_HZ,
                every[labels[cut]].friction,
                every[labels[cut]].law,
                every[labels[cut]].lateral_share,
            )
            for cut in cuts
        ]
        found = simulate_contact(
            vehicle,
            commands,
            1 / RATE_HZ,
            ground=Plane(*slope),
            traction=traction,
            start_poses=tuple(start),
        )
        poses = found.poses_world[:, [0, 1, 3, 4, 5]]
        return Motion(1 / RATE_HZ, commands, poses, found.twists_body[:, 2], labels)

    width = body.track_width * 1.8
    limits = Limits(1.0, 1.1, 1.0, width)
    known = tuple(pieces)
    return World(
        key, kind, body, known, tuple(unseen), limits, gyro_sigma_rad_s, gyro_bias_rad_s, moves
    )


def _other_ground(vehicle, name, share):
    friction = np.full(vehicle.friction.shape, 0.5)
    return Traction(name, 0.0, friction, Shear.for_modulus(0.008, 0.5), share)


def _start(rng):
    return (*rng.uniform(-20.0, 20.0, size=2), rng.uniform(-np.pi, np.pi))
