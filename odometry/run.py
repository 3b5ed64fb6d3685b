"""One recording: its robot, its tables, and its frames in time order."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.io.run_folder import read_settings, read_tables
from odometry.sensors import Sensors, YawRate, preferred_yaw_rate, sensors_of
from odometry.table import Table

UNKNOWN = "unknown"  # the reserved terrain name: nothing is known of this ground
UNNAMED_TERRAIN = "ground"  # of a run where nobody names the terrain


@dataclass(frozen=True)
class Robot:
    """What `[robot]` of run.toml says, in metres and kilograms."""

    track_width: float
    name: str = ""
    length: float | None = None
    width: float | None = None
    wheel_radius: float | None = None
    mass: float | None = None


@dataclass(frozen=True)
class Frame:
    """All that a run says at one stamp.

    Attributes
    ----------
    stamp_s : float
    tread_speeds_m_s : (2,)
        (left, right), in force from this stamp to the next; NaN before the first row of
        odometry and after its last has run out.
    odometry_row : int
        Row of `Run.odometry` in force, -1 before the first.
    pose : (3,) or None
        Measured x, y, yaw in the reference frame at this stamp.
    image : Path or None
        The image taken at this stamp; it is opened by whoever needs it.
    in_gap : bool
        Whether the speeds that led to this frame are not known: odometry.csv has a gap there.
    """

    stamp_s: float
    tread_speeds_m_s: FloatArray
    odometry_row: int
    pose: FloatArray | None
    image: Path | None
    in_gap: bool = False


@dataclass(frozen=True)
class Run:
    """A recording, as a run folder holds it.

    Attributes
    ----------
    folder : Path
    robot : Robot
    settings : Mapping
        run.toml as it stands, unknown tables included.
    odometry : Table
        t, v_left, v_right and what else was recorded.
    pose, velocity, images, truth, imu : Table or None
        None where the folder has no such file. `truth` is for scoring alone.
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

    @classmethod
    def read(cls, folder: str | Path) -> "Run":
        """Read and check a run folder; images are not opened.

        Raises
        ------
        RunFolderError
            Naming the file, row and column that is not as the format says.
        """
        folder = Path(folder)
        settings = read_settings(folder)
        robot = _robot(settings, folder / "run.toml")
        _check_terrain(settings, folder / "run.toml")
        sensors_of(settings, str(folder / "run.toml"))
        return cls(folder, robot, settings, **read_tables(folder))

    @property
    def name(self) -> str:
        """The name of the folder."""
        return self.folder.resolve().name

    @property
    def terrain(self) -> str | None:
        """The ground of the whole run, where run.toml names one."""
        name: str | None = self.settings.get("run", {}).get("terrain")
        return name

    @property
    def sensors(self) -> Sensors:
        """Where the sensors sit, as `[sensors]` of run.toml says."""
        return sensors_of(self.settings, str(self.folder / "run.toml"))

    @property
    def yaw_rate(self) -> YawRate | None:
        """Measured yaw rates: imu.csv's where it has them, else odometry.csv's, else None."""
        return preferred_yaw_rate(self.imu, self.odometry, self.sensors)

    @property
    def wheel_travel_m(self) -> FloatArray:
        """Wheel travel (N,) at each row of odometry: the integral of (|v_left| + |v_right|) / 2."""
        speeds = np.abs(self.odometry.stack("v_left", "v_right")).mean(axis=1)
        return np.concatenate([[0.0], np.cumsum(speeds[:-1] * np.diff(self.odometry.stamps_s))])

    def frames(self) -> Iterator[Frame]:
        """Merge the stamps of odometry, pose and images in time order.

        Equal stamps make one frame. A tread speed holds until the next stamp; the last one
        holds for the median odometry period, whose end is a frame of its own where other
        stamps lie beyond.
        """
        odometry_s = self.odometry.stamps_s
        speeds = self.odometry.stack("v_left", "v_right")
        period_s = float(np.median(np.diff(odometry_s))) if len(odometry_s) > 1 else 0.0
        pose_s, poses = _stamps_and_values(self.pose, ("x", "y", "yaw"))
        image_s = self.images.stamps_s if self.images is not None else np.empty(0)
        end_s = odometry_s[-1] + period_s
        stamps_s = np.unique(np.concatenate([odometry_s, pose_s, image_s]))
        if stamps_s[-1] > end_s:
            stamps_s = np.unique(np.append(stamps_s, end_s))
        odometry_row = np.searchsorted(odometry_s, stamps_s, side="right") - 1
        pose_row, image_row = _row_at(pose_s, stamps_s), _row_at(image_s, stamps_s)
        unknown = np.full(2, math.nan)
        for i, stamp_s in enumerate(stamps_s):
            row = int(odometry_row[i])
            runs = row >= 0 and stamp_s < end_s
            image = None
            if self.images is not None and image_row[i] >= 0:
                image = self.folder / str(self.images["file"][image_row[i]])
            yield Frame(
                stamp_s=float(stamp_s),
                tread_speeds_m_s=speeds[row] if runs else unknown,
                odometry_row=row,
                pose=poses[pose_row[i]] if pose_row[i] >= 0 else None,
                image=image,
            )


def _stamps_and_values(
    table: Table | None, names: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    if table is None:
        return np.empty(0), np.empty((0, len(names)))
    return table.stamps_s, table.stack(*names)


def _row_at(table_s: FloatArray, stamps_s: FloatArray) -> FloatArray:
    """Row of a table at exactly each stamp, -1 where it has none."""
    rows = np.full(len(stamps_s), -1)
    rows[np.searchsorted(stamps_s, table_s)] = np.arange(len(table_s))
    return rows


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
        raise RunFolderError(f"{file}: [robot] with track_width [m] is required")
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
