"""Random drives over random terrains with a camera that labels, and what truly happened.

Nothing here knows how a switch decides: a robot drives forward in curves, turns on the spot,
reverses and comes back, over straight edges at any angle; a camera in front or behind labels the
ground some way ahead in the direction of travel, rightly or not; the odometer drifts. The truth is
where the middle of the robot crosses an edge.
"""

from dataclasses import dataclass

import numpy as np

STEP_S = 0.05
SPEED_M_S = 0.6
SPIN_RAD_S = 0.8
IMAGE_STEPS = 5
LOOK_M = 0.95
FOOTPRINT_M = (0.6, 0.6)
LARGEST_CURVATURE = 0.45  # of a way whose region lies in the image [1/m]


@dataclass(frozen=True)
class Land:
    """Terrains between parallel straight edges, across a direction."""

    terrains: tuple
    edges_m: np.ndarray
    direction_rad: float

    def along_m(self, points):
        """How far points (..., 2) lie along the direction."""
        return points @ np.array([np.cos(self.direction_rad), np.sin(self.direction_rad)])

    def at(self, points):
        """Index of the terrain at points (..., 2)."""
        return np.searchsorted(self.edges_m, self.along_m(points))


@dataclass(frozen=True)
class Look:
    """A label read at a step, and where: in the robot frame, by the robot's own motion model."""

    step: int
    label: str
    place_robot: np.ndarray
    distance_ahead_m: float
    true_label: str


@dataclass(frozen=True)
class Driven:
    """A drive of n steps.

    `poses` (n, 3) are true, `odometer` (n, 3) what integrated twists say of them, `travel_m` (n,)
    wheel travel, `terrains` (n,) the names under the robot's middle.
    """

    land: Land
    poses: np.ndarray
    odometer: np.ndarray
    travel_m: np.ndarray
    terrains: np.ndarray
    looks: tuple

    @property
    def crossings(self):
        """Steps at which the middle of the robot is on another terrain than before."""
        return 1 + np.flatnonzero(self.terrains[1:] != self.terrains[:-1])

    def edge_distance_m(self, step):
        """From the middle of the robot to the nearest edge."""
        return float(np.abs(self.land.along_m(self.poses[step, :2]) - self.land.edges_m).min())


def random_land(rng, names=("grass", "gravel", "sand"), reach_m=60.0):
    """Terrains 3 to 9 m wide, each unlike the one before; the first reaches back without end."""
    edges, terrains = [], [str(rng.choice(names))]
    while not edges or edges[-1] < reach_m:
        edges.append((edges[-1] if edges else 2.0) + rng.uniform(3.0, 9.0))
        terrains.append(str(rng.choice([name for name in names if name != terrains[-1]])))
    return Land(tuple(terrains), np.array(edges), rng.uniform(-0.5, 0.5))


def forward(rng):
    """A way ahead in gentle curves: rows of (speed, yaw rate)."""
    steps = int(rng.uniform(2.0, 7.0) / (SPEED_M_S * STEP_S))
    phase, swing = rng.uniform(0, 2 * np.pi), rng.uniform(0.0, 0.35)
    curvature = swing * np.sin(phase + 0.9 * SPEED_M_S * STEP_S * np.arange(steps))
    return np.stack([np.full(steps, SPEED_M_S), SPEED_M_S * curvature], axis=1)


def spin_and_back(rng):
    """Turn on the spot and back again."""
    steps = int(rng.uniform(0.5, 2 * np.pi) / (SPIN_RAD_S * STEP_S))
    there = np.tile([0.0, SPIN_RAD_S * rng.choice([-1, 1])], (steps, 1))
    return np.concatenate([there, -there])


def full_turn(rng):
    """Turn once round on the spot."""
    steps = round(2 * np.pi / (SPIN_RAD_S * STEP_S))
    rate = 2 * np.pi / (steps * STEP_S) * rng.choice([-1, 1])
    return np.tile([0.0, rate], (steps, 1))


def reversal(rng):
    """Back the way it came, some of it."""
    way = forward(rng)[: int(rng.uniform(1.0, 5.0) / (SPEED_M_S * STEP_S))]
    return -way[::-1]


def random_drive(
    rng,
    *,
    manoeuvres=(forward, spin_and_back, full_turn, reversal),
    rear=False,
    legs=9,
    **labelling,
):
    """Drive legs of the given manoeuvres, each after a way ahead; turned about for a rear camera.

    A rear camera's robot does all its ways ahead in reverse.
    """
    land = random_land(rng)
    rows = [forward(rng)]
    for _ in range(legs):
        rows += [manoeuvres[rng.integers(len(manoeuvres))](rng), forward(rng)]
    twists = np.concatenate(rows)
    start_yaw = 0.0
    if rear:
        twists, start_yaw = twists * [-1.0, 1.0], np.pi
    poses = integrated(twists, np.array([0.0, 0.0, start_yaw]))
    believed = twists * rng.normal(1.0, 0.015, 2) + [0.0, rng.normal(0.0, 0.002)]
    odometer = integrated(believed, np.zeros(3))
    travel = np.concatenate([[0.0], np.cumsum(wheel_speed(twists))])[:-1] * STEP_S
    terrains = np.array(land.terrains)[land.at(poses[:, :2])]
    looks = tuple(_looks(rng, land, poses, twists, believed=believed, rear=rear, **labelling))
    return Driven(land, poses, odometer, travel, terrains, looks)


def wheel_speed(twists):
    """Mean of |v_left| and |v_right| of treads 0.8 m apart in effect."""
    half = 0.4 * twists[:, 1]
    return (np.abs(twists[:, 0] - half) + np.abs(twists[:, 0] + half)) / 2


def integrated(twists, start):
    """Poses (n, 3) at the beginning of each row of (speed, yaw rate)."""
    yaw = start[2] + np.concatenate([[0.0], np.cumsum(twists[:-1, 1] * STEP_S)])
    middle = yaw + twists[:, 1] * STEP_S / 2
    steps = STEP_S * twists[:, :1] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    places = start[:2] + np.concatenate([np.zeros((1, 2)), np.cumsum(steps[:-1], axis=0)])
    return np.column_stack([places, yaw])


def _looks(rng, land, poses, twists, *, believed, rear, accuracy=1.0, held_m=0.0, unknown=0.0):
    """Labels of the ground ahead: wrong ones in stretches of about `held_m`, some `unknown`."""
    names = sorted(set(land.terrains))
    wrong_until_m, wrong_label, done_m = -1.0, "", 0.0
    for step in range(0, len(poses), IMAGE_STEPS):
        speed, rate = twists[step]
        done_m += abs(speed) * STEP_S * IMAGE_STEPS
        if speed == 0 or (speed < 0) != rear or abs(rate / speed) > LARGEST_CURVATURE:
            continue
        ahead = _ahead(*believed[step])
        truth = land.terrains[int(land.at(_carried(poses[step], ahead)))]
        label = truth
        if done_m < wrong_until_m:
            label = wrong_label
        elif rng.random() > accuracy ** (1.0 if held_m == 0 else 0.15 / held_m):
            label = str(rng.choice([name for name in names if name != truth]))
            wrong_label, wrong_until_m = label, done_m + rng.exponential(held_m or 1e-9)
        if rng.random() < unknown:
            label = "unknown"
        yield Look(step, label, ahead, LOOK_M, truth)


def _ahead(speed, rate):
    """The robot's middle after LOOK_M of way at a constant twist, in the robot frame now."""
    angle = rate * LOOK_M / abs(speed)
    chord = LOOK_M * np.sinc(angle / 2 / np.pi)
    return (
        np.sign(speed) * chord * np.array([np.cos(angle / 2), np.sign(speed) * np.sin(angle / 2)])
    )


def _carried(pose, point):
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    x = pose[0] + cosine * point[0] - sine * point[1]
    return np.array([x, pose[1] + sine * point[0] + cosine * point[1]])
