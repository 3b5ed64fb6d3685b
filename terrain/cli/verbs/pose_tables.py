"""Tables of poses from files of other programs: trajectories, or latitude and longitude."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import TrajectoryError
from odometry.fixes.degrees import FARTHEST_M
from odometry.fixes.fixes import Fixes
from odometry.fixes.local_metres import LocalMetres, Origin
from odometry.fixes.origin import stated_origin
from odometry.tables.table import Table

NO_YAW = "all of its rotations are the same: they are not measured, and yaw is left empty"


@dataclass(frozen=True)
class PoseTable:
    """Columns of a table, how they were read, what is to be said at once, and a new origin."""

    columns: dict[str, AnyArray]
    notes: tuple[str, ...] = ()
    said: tuple[str, ...] = ()
    origin: Origin | None = None


def read_pose_table(
    name: str,
    file: Path,
    settings: Mapping[str, Any],
    odometry: Table,
    *,
    times: Path | None = None,
    axes: str = "",
) -> PoseTable:
    """The table `name` (pose, truth) of its file; `times` and `axes` as of `read_trajectory`.

    Raises
    ------
    TrajectoryError
        If the file cannot be read, or its quaternions have another order; of positions without
        yaw as truth.
    """
    from odometry.fixes.fixes import read_fixes
    from odometry.io.trajectory_files import OPTICAL, format_of, read_trajectory
    from odometry.io.trajectory_poses import doubt_of_axes, pose_columns
    from terrain.other_odometry.other_headings import order_fault

    fixes = read_fixes(file, odometry)
    if fixes is None:
        trajectory = read_trajectory(file, times=times, axes=axes)
        if axes != OPTICAL and (fault := order_fault(trajectory, format_of(file))):
            raise TrajectoryError(f"{file}: {fault}")
        doubt = doubt_of_axes(trajectory)
        said = (f"Warning: {file}: {doubt}",) if doubt else ()
        columns = pose_columns(trajectory)
        if np.isfinite(columns["yaw"]).all():
            return PoseTable(columns, (), said)
        _refuse_truth(name, file)
        return PoseTable(columns, (NO_YAW,), said)
    _refuse_truth(name, file)
    return _local(file, fixes, stated_origin(settings.get("source")))


def _refuse_truth(name: str, file: Path) -> None:
    if name == "truth":
        raise TrajectoryError(f"{file}: positions have no yaw, which truth.csv needs; give --pose")


def _local(file: Path, fixes: Fixes, stated: list[float] | None) -> PoseTable:
    """Places in metres of the origin that run.toml states, else of the first one."""
    local = LocalMetres()
    if stated is not None:
        local.origin = stated[0], stated[1], stated[2] if len(stated) > 2 else 0.0
    x, y, yaw, z = local.columns(fixes.places).T
    farthest_m = float(np.hypot(x, y).max())
    if farthest_m > FARTHEST_M:
        raise TrajectoryError(
            f"{file}: its places lie {farthest_m / 1000:.0f} km from the origin that [source] of "
            "run.toml states; correct it, or leave it out"
        )
    if local.origin is None:
        raise TrajectoryError(f"{file}: it has no place")
    latitude, longitude, altitude_m = local.origin
    place = f"latitude {latitude:.9g}, longitude {longitude:.9g}, altitude {altitude_m:.6g} m"
    whose = "the first one" if stated is None else "the origin in run.toml"
    return PoseTable(
        {"t": fixes.stamps_s, "x": x, "y": y, "yaw": yaw, "z": z},
        (f"metres east and north of {whose}: {place}; yaw is not measured", *fixes.notes),
        tuple(f"Lost: {file}: {loss}" for loss in fixes.losses),
        local.origin if stated is None else None,
    )
