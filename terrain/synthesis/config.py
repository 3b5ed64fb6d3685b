"""What a synthetic run is made of, every default works; cameras and vehicles from TOML files."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import radians
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.io.structured import read_toml
from odometry.simulation.commands import WeavingDriver
from terrain.camera.camera import Camera
from terrain.errors import SynthesisError

LIMITS = {  # a run of a day, in steps that are worth it
    "zone_length_m": (0.01, 1000.0),
    "odometry_rate_hz": (0.1, 1000.0),
    "pose_rate_hz": (0.001, 1000.0),
    "image_rate_hz": (0.001, 1000.0),
    "metres_per_pixel": (1e-5, 1.0),
    "patch_size_px": (1, 4096),
    "patches_per_terrain": (1, 100_000),
}
# y_left, y_right, x_icr in track widths
_KNOWN_ICRS = {
    "gravel": (0.725, -0.65, -0.2),
    "brick": (0.9, -0.975, -0.05),
    "grass": (1.225, -1.15, 0.125),
}


def default_camera() -> Camera:
    """Camera on a mast that points 40 degrees down, as in data/cameras/mast.toml."""
    return Camera.from_mount(
        (640, 480),
        [[460.0, 0.0, 319.5], [0.0, 460.0, 239.5], [0.0, 0.0, 1.0]],
        [-0.12, 0.05, 0.0005, -0.0003, 0.0],
        [0.15, 0.0, 1.2, 0.0, radians(40.0), 0.0],
    )


def default_robot() -> dict[str, Any]:
    """Robot of the size of a Pioneer 3-AT, as in data/vehicles/pioneer_like.toml."""
    return {"name": "pioneer_like", "track_width": 0.4, "length": 0.5, "width": 0.5}


@dataclass(frozen=True)
class SynthesisConfig:
    """Everything that decides the bytes of a synthetic run, the photographs aside.

    Attributes
    ----------
    seed : int
        Seed of all randomness.
    zones : tuple of str
        Terrains along the way, in order.
    zone_length_m : float
        Length of each zone along the way.
    icrs_m : mapping of terrain to (y_left, y_right, x_icr), or None
        True ICRs on each terrain; None takes the defaults (see `true_icrs_m`).
    robot : mapping
        The `[robot]` table: track_width, length, width [m], name.
    camera : Camera
        Camera of the run and of the patches.
    driver : WeavingDriver
        Drives; its phases are drawn from the seed.
    odometry_rate_hz, pose_rate_hz, image_rate_hz : float
        The first must be a multiple of the others.
    metres_per_pixel : float
        Scale at which the photographs are laid on the terrain, and that of the patches.
    patch_size_px, patches_per_terrain : int
        Edge and least number of the labelled patches.
    jpeg_quality : int
        Of the run's images, 1 to 100.
    edge_wave_m : float
        Amplitude of the waves in the edges between zones.
    sigma_position_m, sigma_yaw_rad : float
        Noise of the measured pose.
    sigma_tread_m_s, sigma_gyro_rad_s : float
        Noise of the recorded tread speeds and yaw rate.
    icr_wander_m : (float, float, float)
        Standard deviations of a slow disturbance (Ornstein-Uhlenbeck) of y_left, y_right, x_icr.
    icr_wander_time_s : float
        Time constant of that disturbance.
    has_imu : bool
        Whether there is an imu.csv with vibration by terrain and speed, and a column `terrain` in
        odometry.csv, so that `identify-feel` can be tried.
    sigma_parameters_m : (float, float, float)
        How far parameters.toml is from the truth, as after an identification run.

    Examples
    --------
    >>> import terrain
    >>> terrain.SynthesisConfig(seed=7, zones=("grass", "brick")).zone_length_m
    11.5
    """

    seed: int = 0
    zones: tuple[str, ...] = ("gravel", "grass", "gravel")
    zone_length_m: float = 11.5
    icrs_m: Mapping[str, tuple[float, float, float]] | None = None
    robot: Mapping[str, Any] = field(default_factory=default_robot)
    camera: Camera = field(default_factory=default_camera)
    driver: WeavingDriver = field(default_factory=WeavingDriver)
    odometry_rate_hz: float = 20.0
    pose_rate_hz: float = 10.0
    image_rate_hz: float = 4.0
    metres_per_pixel: float = 0.003
    patch_size_px: int = 96
    patches_per_terrain: int = 32
    jpeg_quality: int = 85
    edge_wave_m: float = 0.06
    sigma_position_m: float = 0.02
    sigma_yaw_rad: float = radians(0.5)
    sigma_tread_m_s: float = 0.002
    sigma_gyro_rad_s: float = 0.003
    icr_wander_m: tuple[float, float, float] = (0.003, 0.003, 0.001)
    icr_wander_time_s: float = 8.0
    sigma_parameters_m: tuple[float, float, float] = (0.02, 0.02, 0.01)
    has_imu: bool = False

    def __post_init__(self) -> None:
        if not self.zones:
            raise SynthesisError("there must be at least one zone")
        for name, (low, high) in LIMITS.items():
            if not low <= getattr(self, name) <= high:
                raise SynthesisError(
                    f"{name} must be above zero: {low:g} to {high:g}, found {getattr(self, name)}"
                )
        if not 1 <= self.jpeg_quality <= 100:
            raise SynthesisError(f"jpeg_quality must be in 1 to 100, found {self.jpeg_quality}")
        missing = [name for name in ("track_width", "length", "width") if name not in self.robot]
        if missing:
            raise SynthesisError(f"[robot] needs {', '.join(missing)}; found {sorted(self.robot)}")
        for name in ("track_width", "length", "width"):
            value = self.robot[name]
            if not isinstance(value, int | float) or not 0.01 <= value <= 100:
                raise SynthesisError(f"[robot] {name} = {value!r}, expected 0.01 to 100 m")
        self.samples_between("pose_rate_hz")
        self.samples_between("image_rate_hz")

    def samples_between(self, name: str) -> int:
        """Odometry samples from one sample to the next of the named slower rate."""
        rate = getattr(self, name)
        ratio = self.odometry_rate_hz / rate if rate > 0 else 0.0
        if ratio < 1 or abs(ratio - round(ratio)) > 1e-9:
            raise SynthesisError(
                f"odometry_rate_hz = {self.odometry_rate_hz:g} must be a whole multiple of "
                f"{name} = {rate:g}"
            )
        return round(ratio)

    def true_icrs_m(self, terrains: tuple[str, ...]) -> dict[str, FloatArray]:
        """Return the true (y_left, y_right, x_icr) on each terrain, before any disturbance.

        Terrains without a value of their own are spread evenly between the ICRs of gravel and
        grass, in the order given.
        """
        if self.icrs_m is not None:
            missing = [name for name in terrains if name not in self.icrs_m]
            if missing:
                raise SynthesisError(f"icrs_m lacks {missing[0]!r}; it has {sorted(self.icrs_m)}")
            return {name: np.array(self.icrs_m[name], dtype=np.float64) for name in terrains}
        spread = np.linspace(_KNOWN_ICRS["gravel"], _KNOWN_ICRS["grass"], max(len(terrains), 2))
        track_width = float(self.robot["track_width"])
        return {
            name: track_width * np.array(_KNOWN_ICRS.get(name, tuple(spread[i])))
            for i, name in enumerate(terrains)
        }


def read_camera(file: Path) -> Camera:
    """Camera of the `[camera]` table of a TOML file.

    Raises
    ------
    SynthesisError
        If the file cannot be read or has no such table.
    CameraError
        If the table is not as the format says.
    """
    return Camera.from_table(_read_table(file, "camera"), where=str(file))


def read_robot(file: Path) -> dict[str, Any]:
    """Read the `[robot]` table of a TOML file.

    Raises
    ------
    SynthesisError
        If the file cannot be read or has no such table.
    """
    return _read_table(file, "robot")


def _read_table(file: Path, name: str) -> dict[str, Any]:
    content = read_toml(file, SynthesisError)
    table = content.get(name)
    if not isinstance(table, dict):
        raise SynthesisError(f"{file}: the table [{name}] is missing; found: {sorted(content)}")
    return table
