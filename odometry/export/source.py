"""What is exported: a parameter set, or a folder that `run` wrote."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite, radians
from pathlib import Path
from typing import Any

import numpy as np

from odometry.errors import ExportError, ParameterError
from odometry.export.drive_numbers import MotionErrors, Pace
from odometry.io.csv_table import read_csv_table
from odometry.io.formats import check_format
from odometry.io.structured import read_json
from odometry.outputs.manifest import check_finished
from odometry.outputs.written_tables import changes_of
from odometry.parameters import ParameterSet, read_parameters
from odometry.tables.table import Table
from odometry.trajectory import Trajectory

RESULT_FORMAT = 1  # of result.json
JUDGED_BY_WHEELS = ("odometer_without_gyroscope", "odometer")  # the first of these that there is


@dataclass(frozen=True)
class ExportSource:
    """What is exported, and how.

    Attributes
    ----------
    path : Path
    parameters : ParameterSet
        Of a result, what it learned; empty where it learned nothing.
    content : Mapping
        result.json; empty of a parameter set.
    terrain : str
        The one for a controller that knows one terrain; "" where none was chosen.
    track_width_m : float or None
        That someone says, else the robot's, else that of [vehicle].
    cell_m : float
        Side of the cells of a map.
    comment : str
        Lines that begin with #, for files that have comments.
    edited : tuple of str
        Which files of a result are not as they were written, a sentence each.
    """

    path: Path
    parameters: ParameterSet
    content: Mapping[str, Any] = field(default_factory=dict)
    terrain: str = ""
    track_width_m: float | None = None
    cell_m: float = 0.5
    comment: str = ""
    edited: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """The result folder; ExportError of a parameter set."""
        if not self.content:
            raise ExportError(f"{self.path} is a parameter set; expected a folder that `run` wrote")
        return self.path

    def table(self, name: str) -> Table:
        """A CSV table of the result folder."""
        return read_csv_table(self.folder / f"{name}.csv", ("t",), ("t",))

    def trajectory(self, name: str) -> Trajectory:
        """`odometer` or `estimate` of the result folder."""
        table = self.table(name)
        return Trajectory(table.stamps_s, table.stack("x", "y", "yaw"))

    @property
    def chosen_terrain(self) -> str:
        """The terrain whose numbers a controller of one terrain gets: that named, or the only one.

        Raises
        ------
        ParameterError
            If there is none, or there are several.
        """
        names = list(self.parameters.terrains)
        if self.terrain in names:
            return self.terrain
        if self.terrain or not names:
            known = f"it has {', '.join(names)}" if names else "it has no parameters of a terrain"
            unknown = f"there is no terrain {self.terrain!r}: " if self.terrain else ""
            raise ParameterError(f"{self.path}: {unknown}{known}")
        if len(names) > 1:
            raise ParameterError(
                f"{self.path}: a controller knows one terrain; choose with --terrain among "
                f"{', '.join(names)}"
            )
        return names[0]

    @property
    def motion_errors(self) -> MotionErrors | None:
        """Errors of the wheels' odometry on the run; None where there was no reference."""
        errors = self.content.get("errors", {})
        name = next((name for name in JUDGED_BY_WHEELS if name in errors), "")
        match errors.get(name):
            case {
                "translation_m_per_m": {"mean": float() as along},
                "rotation_deg_per_m": {"mean": float() as turn_deg},
            }:
                pass
            case _:
                return None
        horizon_m = float(self.content["horizon_m"])
        source = (
            f"from mean errors of {name} over {horizon_m:g} m of the run {self.content['run']}, "
            f"against {self.content.get('reference')}"
        )
        return MotionErrors.of_means(along, radians(turn_deg), horizon_m, source)

    @property
    def pace(self) -> Pace | None:
        """How fast the robot of a result drove."""
        if not self.content:
            return None
        odometer = self.trajectory("odometer")
        duration_s = float(odometer.stamps_s[-1] - odometer.stamps_s[0])
        turned = float(np.abs(np.diff(np.unwrap(odometer.poses[:, 2]))).sum())
        return Pace(float(self.content["wheel_travel_m"]) / duration_s, turned / duration_s)

    @property
    def origin(self) -> tuple[float, float, float] | None:
        """Latitude, longitude [deg] and height [m] of x = y = 0; None where it is not known."""
        match self.content.get("origin"):
            case [float() | int() as latitude, float() | int() as longitude, *height]:
                return float(latitude), float(longitude), float(height[0]) if height else 0.0
        return None


def read_export_source(
    path: Path,
    *,
    terrain: str = "",
    track_width_m: float | None = None,
    cell_m: float = 0.5,
    comment: str = "",
) -> ExportSource:
    """Read a parameter set, or a folder that `run` wrote.

    Raises
    ------
    ExportError
        If a folder has no result of `run`, or a table of it has lost rows.
    OdometryError
        As `read_parameters`, and if the folder is unfinished.
    """
    if not path.is_dir():
        parameters = read_parameters(path)
        width = _number(parameters.vehicle.get("track_width")) or None
        return ExportSource(path, parameters, {}, terrain, track_width_m or width, cell_m, comment)
    check_finished(path)
    file = path / "result.json"
    if not file.exists():
        raise ExportError(f"{path} has no result.json; expected a folder that `run` wrote")
    content = read_json(file, ExportError)
    if not _is_result(content):
        raise ExportError(f"{file}: it is not a result of `run`")
    check_format(file, content.get("format", RESULT_FORMAT), RESULT_FORMAT, ExportError)
    changes = changes_of(path)
    if changes.lost:
        raise ExportError(f"{'; '.join(changes.lost)}. `run` again")
    learned = path / "learned.toml"
    parameters = read_parameters(learned) if learned.exists() else ParameterSet()
    robot = content.get("robot", {})
    width = _number(robot.get("track_width")) if isinstance(robot, dict) else None
    chosen = (terrain, track_width_m or width, cell_m, comment)
    return ExportSource(path, parameters, content, *chosen, changes.edited)


def _is_result(content: Any) -> bool:
    """Whether result.json holds what is read here; what newer versions added may be absent."""
    match content:
        case {
            "errors": {**errors},
            "horizon_m": horizon_m,
            "wheel_travel_m": travel_m,
            "run": str(),
            "initial_terrain": str(),
            "switches": [*switches],
        }:
            well_formed = all(isinstance(each, dict) for each in (*errors.values(), *switches))
            stamps = [each.get("stamp_s") for each in switches if isinstance(each, dict)]
            numbers = all(isinstance(stamp_s, int | float) for stamp_s in stamps)
            travels = travel_m == 0 or _number(travel_m) is not None  # 0 of one that stands
            return well_formed and numbers and travels and _number(horizon_m) is not None
    return False


def _number(value: Any) -> float | None:
    """A number above zero, None for anything else."""
    if isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value):
        return float(value) if value > 0 else None
    return None
