"""Courses for the study of switching: simulated drives with labels in place of images.

The robot, its ICRs, the noise of its sensors and its camera are those of `synthesise`. A driver
weaves along the way, and turns on the spot and reverses now and then; with a rear camera the robot
does all of it backwards. The labels are those of the ground at the middle of each region, wrong
with a given probability, alone or in stretches.
"""

from dataclasses import dataclass, field, replace
from math import pi, radians
from pathlib import Path

import numpy as np

from odometry.io.run_folder import write_run_folder
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.recording.run_terrains import Footing
from odometry.simulation.commands import WeavingDriver
from odometry.simulation.drive import Drive, simulate
from odometry.simulation.ground import GroundMap, footprint_points, to_world
from odometry.simulation.noise import ornstein_uhlenbeck
from terrain.camera.camera import Camera
from terrain.config import Config
from terrain.image_labels.image_label import ImageLabel
from terrain.region.region import NoRegion, predict_region
from terrain.sources.watcher import TerrainWatcher
from terrain.synthesis.config import SynthesisConfig
from terrain.synthesis.records import identified_parameters, motion_tables, run_settings

MOST_S = 900.0
SPIN_M_S, REVERSE_M_S, REST_S = 0.5, 0.5, 0.5
AHEAD_S, SPIN_S, REVERSE_LASTS_S = (4.0, 10.0), (2.0, 8.0), (2.0, 7.0)
SPINS = {"left": np.array([-SPIN_M_S, SPIN_M_S]), "right": np.array([SPIN_M_S, -SPIN_M_S])}


@dataclass(frozen=True)
class ManoeuvreDriver:
    """Weaves ahead and, by a timetable of (end_s, kind), turns on the spot or goes back."""

    weaving: WeavingDriver
    timetable: tuple[tuple[float, str], ...] = ()
    backwards: bool = False

    def tread_speeds_m_s(self, time_s, pose_world):
        """Tread speeds (left, right) [m/s] at a time and true pose (x, y, yaw)."""
        kind = next((kind for end_s, kind in self.timetable if time_s < end_s), "ahead")
        if kind in SPINS:
            return SPINS[kind]
        if kind == "rest":
            return np.zeros(2)
        if kind == "back":
            left = right = -REVERSE_M_S
        else:
            facing = np.asarray(pose_world) + np.array([0.0, 0.0, pi * self.backwards])
            left, right = self.weaving.tread_speeds_m_s(time_s, facing)
        return np.array([-right, -left] if self.backwards else [left, right])


def timetable(rng):
    """Ways ahead, with a turn on the spot or a way back after each."""
    rows, time_s = [], 0.0
    while time_s < MOST_S:
        kind = str(rng.choice(["left", "right", "back"]))
        lasts_s = rng.uniform(*(REVERSE_LASTS_S if kind == "back" else SPIN_S))
        steps = [(rng.uniform(*AHEAD_S), "ahead"), (REST_S, "rest"), (lasts_s, kind)]
        for step_s, name in [*steps, (REST_S, "rest")]:
            time_s += step_s
            rows.append((time_s, name))
    return tuple(rows)


def rear_camera():
    """The camera of `synthesise`, on the rear of the robot and looking back."""
    mount = [-0.15, 0.0, 1.2, 0.0, radians(40.0), pi]
    front = SynthesisConfig().camera
    return Camera.from_mount(front.image_size, front.matrix, front.distortion, mount)


@dataclass(frozen=True)
class Course:
    """A recorded drive, what truly happened, and the ground under it."""

    run: Run
    config: SynthesisConfig
    ground: GroundMap
    parameters: ParameterSet
    drive: Drive

    def true_terrain(self, stamp_s, place_robot):
        """The terrain at a place of the robot frame at a stamp."""
        row = int(np.searchsorted(self.drive.stamps_s, stamp_s - 1e-9))
        place = to_world(self.drive.poses_world[row], np.asarray(place_robot))
        return self.ground.terrains[int(self.ground.strip_at(place))]

    def edge_distance_m(self, stamp_s):
        """From the middle of the robot to the nearest edge, along the way."""
        x, y = (np.interp(stamp_s, self.drive.stamps_s, of) for of in self.drive.poses_world.T[:2])
        return float(np.abs(x - self.ground.edge_offset_m(y) - self.ground.edges_m).min())


def make_course(folder: Path, seed: int, zones, *, manoeuvres=False, rear=False) -> Course:
    """Drive over zones of 6 to 12 m; a run folder without images is written."""
    rng = np.random.default_rng([seed, len(zones), manoeuvres, rear])
    config = SynthesisConfig(seed=seed, zones=tuple(zones))
    if rear:
        config = replace(config, camera=rear_camera())
    ends_m = np.cumsum(rng.uniform(6.0, 12.0, len(zones)))
    phases = tuple(rng.uniform(0.0, 2 * pi, 2).tolist())
    ground = GroundMap(ends_m[:-1], config.zones, config.edge_wave_m, phases)
    icrs = config.true_icrs_m(tuple(dict.fromkeys(zones)))
    weaving = replace(config.driver, phases_rad=tuple(rng.uniform(0.0, 2 * pi, 3).tolist()))
    step_s, wander_m = 1 / config.odometry_rate_hz, np.array(config.icr_wander_m)
    drive = simulate(
        ManoeuvreDriver(weaving, timetable(rng) if manoeuvres else (), rear),
        ground,
        np.array([icrs[name] for name in zones]),
        footprint_m=(config.robot["length"], config.robot["width"]),
        step_s=step_s,
        disturbances_m=ornstein_uhlenbeck(
            int(MOST_S / step_s), step_s, wander_m, config.icr_wander_time_s, rng
        ),
        start_pose=(0.0, 0.0, pi * rear),
        end_x_m=float(ends_m[-1]),
    )
    tables = motion_tables(config, drive, rng)
    stamps_s = drive.stamps_s[:: config.samples_between("image_rate_hz")]
    files = np.array([f"{k}.jpg" for k in range(len(stamps_s))])
    tables["images"] = {"t": stamps_s, "file": files}
    write_run_folder(folder, run_settings(config, ground, icrs, "none"), tables)
    for file in files:
        (folder / file).touch()
    return Course(Run.read(folder), config, ground, identified_parameters(config, icrs, rng), drive)


class LabellingWatcher(TerrainWatcher):
    """A watcher that is given what lies in the middle of each region, rightly or not."""

    def __init__(self, course: Course, config: Config, *, accuracy, held_m=0.0, seed=0):
        super().__init__(
            course.run.robot,
            course.config.camera,
            None,
            course.ground.terrains[0],
            region=config.region,
            switch=config.switch,
        )
        self._course, self._accuracy, self._held_m = course, accuracy, held_m
        self._ahead = config.region
        self._rng = np.random.default_rng(seed)
        self._wrong, self._wrong_until_m, self._looked_m = "", -1.0, 0.0

    def look(self, frame, estimate, _pose=None):
        """A label of the region that the camera sees; see `predict_region`."""
        name = frame.image.name
        commanded = replace(estimate, tread_speeds_m_s=frame.tread_speeds_m_s)
        speed_m_s = float(np.abs(frame.tread_speeds_m_s).mean())
        robot, camera = self._course.run.robot, self._course.config.camera
        region = predict_region(robot, camera, commanded.twist, speed_m_s, self._ahead)
        if isinstance(region, NoRegion):
            return ImageLabel(frame.stamp_s, name, reason=region.reason)
        true = self._course.true_terrain(frame.stamp_s, region.place)
        label = self._label(true, self._travel_m)
        return ImageLabel(frame.stamp_s, name, label, self._accuracy, region)

    def _label(self, true, travel_m):
        """Wrong at any label, or in stretches of about `held_m` that are as much of the way."""
        since_m, self._looked_m = travel_m - self._looked_m, travel_m
        if travel_m < self._wrong_until_m:
            return self._wrong
        error = 1 - self._accuracy
        if self._held_m:
            error *= since_m / (self._held_m + since_m) / self._accuracy
        if self._rng.random() >= error:
            return true
        names = [name for name in dict.fromkeys(self._course.ground.terrains) if name != true]
        self._wrong = str(self._rng.choice(names))
        self._wrong_until_m = travel_m + self._held_m * self._rng.exponential()
        return self._wrong


@dataclass(frozen=True)
class TrueFooting:
    """The true shares of terrains under the footprint at every frame."""

    course: Course
    initial: str = field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "initial", self.course.ground.terrains[0])

    def terrain(self, frame, estimate):  # noqa: ARG002 - the protocol's
        """What the robot stands on."""
        drive, ground, robot = self.course.drive, self.course.ground, self.course.config.robot
        row = min(int(np.searchsorted(drive.stamps_s, frame.stamp_s)), len(drive.stamps_s) - 1)
        points = footprint_points(robot["length"], robot["width"])
        strips = ground.strip_shares(to_world(drive.poses_world[row], points))
        shares: dict[str, float] = {}
        for name, share in zip(ground.terrains, strips.tolist(), strict=True):
            if share > 0:
                shares[name] = shares.get(name, 0.0) + share
        return Footing(max(shares, key=lambda name: shares[name]), shares)
