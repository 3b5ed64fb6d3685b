"""One recording: its robot, its tables, its frames in time order; and names of several runs."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.io.run_folder import read_settings, read_tables
from odometry.recording.frames import Frame, merged_frames
from odometry.recording.sensors import (
    Sensors,
    YawRate,
    gyroscope_of,
    preferred_yaw_rate,
    sensors_of,
)
from odometry.tables.table import Table

UNKNOWN = "unknown"  # the reserved terrain name: nothing is known of this terrain
UNNAMED_TERRAIN = "ground"  # of a run that does not name its terrain; the name in parameter sets
SAME_WIDTH = 0.1  # share by which track widths of one robot may differ


@dataclass(frozen=True)
class Robot:
    """The table `[robot]` of run.toml, in metres and kilograms.

    Examples
    --------
    >>> import odometry
    >>> odometry.Robot(track_width=0.4, name="my robot").length is None
    True
    """

    track_width: float
    name: str = ""
    length: float | None = None
    width: float | None = None
    wheel_radius: float | None = None
    mass: float | None = None

    def may_have_width(self, track_width_m: float) -> bool:
        """Whether a stated track width may be of this robot; NaN states none."""
        return not abs(self.track_width / track_width_m - 1) > SAME_WIDTH


@dataclass(frozen=True)
class Run:
    """A recording, as a run folder holds it.

    Attributes
    ----------
    folder : Path
    robot : Robot
    settings : Mapping
        run.toml as read, unknown tables included.
    odometry : Table
        t, v_left, v_right and what else was recorded.
    pose, velocity, images, truth, imu : Table or None
        None where the folder has no such file. `truth` is for scoring alone.
    cut_s : float
        How much of the recording a span cut off before the first row of the odometry.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> run.robot.track_width, len(run.odometry), run.velocity is None
    (0.4, 1085, True)
    >>> f"{run.wheel_travel_m[-1]:.1f} m of wheel travel"
    '35.7 m of wheel travel'
    """

    folder: Path
    robot: Robot
    settings: Mapping[str, Any]
    odometry: Table
    pose: Table | None = None
    velocity: Table | None = None
    images: Table | None = None
    truth: Table | None = None
    imu: Table | None = None
    cut_s: float = 0.0

    @classmethod
    def read(cls, folder: str | Path) -> "Run":
        """Read and check a run folder; images are not opened.

        Raises
        ------
        RunFolderError
            Naming the file, row and column that does not have the documented format.
        """
        folder = Path(folder)
        settings = read_settings(folder)
        robot = _robot(settings, folder / "run.toml")
        _check_terrain(settings, folder / "run.toml")
        sensors_of(settings, str(folder / "run.toml"))
        tables: dict[str, Any] = read_tables(folder)
        return cls(folder, robot, settings, **tables)

    @property
    def name(self) -> str:
        """The name of the folder."""
        return self.folder.resolve().name

    @property
    def began_s(self) -> float:
        """The stamp from which run time counts: the first of the recording's odometry."""
        return float(self.odometry.stamps_s[0]) - self.cut_s

    @property
    def terrain(self) -> str | None:
        """The terrain of the whole run, without spaces around it, where run.toml names one."""
        name: str = self.settings.get("run", {}).get("terrain") or ""
        return name.strip() or None

    @property
    def sensors(self) -> Sensors:
        """Where the sensors are mounted: `[sensors]` of run.toml."""
        return sensors_of(self.settings, str(self.folder / "run.toml"))

    @property
    def yaw_rate(self) -> YawRate | None:
        """Measured yaw rates: imu.csv's where it has them, else odometry.csv's, else None."""
        return preferred_yaw_rate(self.imu, self.odometry, self.sensors)

    @property
    def wheel_travel_m(self) -> FloatArray:
        """Wheel travel (N,) at each row of odometry: the integral of (|v_left| + |v_right|) / 2."""
        speeds = np.abs(self.odometry["v_left"]) + np.abs(self.odometry["v_right"])
        travel_m = np.zeros(len(speeds))
        np.cumsum(speeds[:-1] / 2 * np.diff(self.odometry.stamps_s), out=travel_m[1:])
        return travel_m

    def frames(self) -> Iterator[Frame]:
        """All data of the run in time order, see `odometry.recording.frames.merged_frames`."""
        return merged_frames(
            self.odometry,
            self.pose,
            self.velocity,
            self.images,
            gyroscope=gyroscope_of(self.yaw_rate),
            folder=self.folder,
        )


def _check_terrain(settings: Mapping[str, Any], file: Path) -> None:
    table = settings.get("run", {})
    if not isinstance(table, Mapping):
        raise RunFolderError(f"{file}: run = {table!r}, expected a table [run]")
    name = table.get("terrain", "")
    if not isinstance(name, str):
        raise RunFolderError(f"{file}: [run] terrain = {name!r}, expected a name")


def _robot(settings: Mapping[str, Any], file: Path) -> Robot:
    table = settings.get("robot")
    if not isinstance(table, Mapping) or "track_width" not in table:
        there = f", and it has {', '.join(map(str, table))}" if isinstance(table, Mapping) else ""
        raise RunFolderError(f"{file}: [robot] with track_width [m] is required{there}")
    known: dict[str, Any] = {}
    for field in fields(Robot):
        if field.name not in table:
            continue
        value = table[field.name]
        if field.name == "name":
            known["name"] = str(value)
        elif (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or not 1e-3 <= value <= 1e6
        ):
            raise RunFolderError(
                f"{file}: [robot] {field.name} = {value!r}, expected a positive number, "
                "0.001 to 1e6"
            )
        else:
            known[field.name] = float(value)
    return Robot(**known)


def run_names(runs: Sequence[Run]) -> list[str]:
    """Names of the folders; where those of different folders are the same, their paths."""
    folders = {run.folder for run in runs}
    names = [folder.resolve().name for folder in folders]
    return [run.name if names.count(run.name) == 1 else str(run.folder) for run in runs]


def robot_labels(robots: Sequence[Robot]) -> dict[tuple[str, float], str]:
    """A short name for every robot: the part before a bracket where that distinguishes them."""
    keys = list(dict.fromkeys((robot.name, robot.track_width) for robot in robots))
    full = {(name, width): name or f"robot {width:g} m wide" for name, width in keys}
    short = {key: name.split(" (")[0] for key, name in full.items()}
    longest = {key: f"{name}, track width {key[1]:g} m" for key, name in full.items()}
    choices = (short, full, longest)
    return next(labels for labels in choices if len(set(labels.values())) == len(keys))


def with_stamps(run: Run, name: str, stamps_s: FloatArray) -> Run:
    """The run with other stamps (N,) in one of its tables."""
    table = getattr(run, name)
    return with_table(run, name, replace(table, columns={**table.columns, "t": stamps_s}))


def with_table(run: Run, name: str, table: Table) -> Run:
    """The run with another table in place of one."""
    changed: dict[str, Any] = {name: table}
    return replace(run, **changed)
