"""The file formats of trajectories by name, and which way their axes point."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA
from odometry.io.euroc import read_euroc, write_euroc
from odometry.io.files import opened_lines
from odometry.io.kitti import read_kitti, write_kitti
from odometry.io.tum import read_spatial_tum, write_spatial_tum
from odometry.trajectory import SpatialTrajectory

ROBOT, OPTICAL = (
    "robot",
    "optical",
)  # x forward, z up; or x right, y down, z along the viewing direction
AXES = (ROBOT, OPTICAL)


@dataclass(frozen=True)
class TrajectoryFormat:
    """How one format is read and written.

    Attributes
    ----------
    about : str
    numbers : int
        Of a row, by which the format of a file is recognised.
    axes : str
        Of its files unless the caller states others.
    read : callable
        Of the file and the file of its stamps, None where there is none.
    write : callable
        Into a folder, by the trajectory's name; the files that it wrote.
    separator : str or None
        Between numbers; white space where None.
    more : bool
        Whether a row may have further numbers.
    """

    about: str
    numbers: int
    axes: str
    read: Callable[[Path, Path | None], SpatialTrajectory]
    write: Callable[[Path, str, SpatialTrajectory], tuple[Path, ...]]
    separator: str | None = None
    more: bool = False

    def has(self, row: str) -> bool:
        """Whether a row of text has as many numbers as this format."""
        count = len(row.split(self.separator))
        return count == self.numbers or (self.more and count > self.numbers)


def read_trajectory(
    file: str | Path, *, named: str = "", times: str | Path | None = None, axes: str = ""
) -> SpatialTrajectory:
    """Read a trajectory of any known format in robot axes: x forward, y left, z up.

    Parameters
    ----------
    file : path
    named : {"", "tum", "kitti", "euroc"}
        The format; "" takes the one that the first row has.
    times : path, optional
        Stamps of a KITTI file.
    axes : {"", "robot", "optical"}
        Of body and fixed frame in the file; "" takes those of the format: optical of KITTI,
        robot of the others.

    Raises
    ------
    TrajectoryError
        If the file has no known format, is not as its format says, or a KITTI file comes without
        stamps.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> import numpy as np
    >>> import odometry
    >>> still = odometry.SpatialTrajectory(np.array([0.0]), np.eye(4)[None])
    >>> with TemporaryDirectory() as folder:
    ...     (file,) = odometry.write_trajectory(Path(folder), "estimate", still, "euroc")
    ...     print(len(odometry.read_trajectory(file)))  # the format follows from its first row
    1
    """
    file = Path(file)
    chosen = FORMATS[named or format_of(file)]
    trajectory = chosen.read(file, None if times is None else Path(times))
    return from_optical(trajectory) if (axes or chosen.axes) == OPTICAL else trajectory


def write_trajectory(
    folder: Path, name: str, trajectory: SpatialTrajectory, named: str
) -> tuple[Path, ...]:
    """Write a trajectory of robot axes in the axes of a format; the files are returned.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> import numpy as np
    >>> import odometry
    >>> still = odometry.SpatialTrajectory(np.array([0.0]), np.eye(4)[None])
    >>> with TemporaryDirectory() as folder:
    ...     files = odometry.write_trajectory(Path(folder), "estimate", still, "kitti")
    ...     print([file.name for file in files])
    ['estimate_kitti.txt', 'estimate_times.txt']
    """
    chosen = FORMATS[named]
    turned = to_optical(trajectory) if chosen.axes == OPTICAL else trajectory
    return chosen.write(folder, name, turned)


def format_of(file: Path) -> str:
    """The format that the first row of a file has, by its separator and its count of numbers.

    Raises
    ------
    TrajectoryError
        If it is none of them, or the file cannot be read.
    """
    with opened_lines(file, TrajectoryError) as lines:
        row = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    if not row.strip():
        raise TrajectoryError(f"{file}: there is no pose in it")
    found = next((name for name, one in FORMATS.items() if one.has(row)), None)
    if found is None:
        known = "; ".join(f"{name}: {one.about}" for name, one in FORMATS.items())
        raise TrajectoryError(
            f"{file}: the first row {row.strip()[:60]!r} is of no known format; expected {known}; "
            "or, as --pose of `import`, CSV whose header names latitude, longitude and a stamp, "
            "`.pos` of RTKLIB, or NMEA with GGA"
        )
    return found


def from_optical(trajectory: SpatialTrajectory) -> SpatialTrajectory:
    """Poses whose body and fixed frame have optical axes, in robot axes: C^T T C."""
    turn = se3.pose(np.zeros(3), OPTICAL_FROM_CAMERA)
    return SpatialTrajectory(trajectory.stamps_s, turn.T @ trajectory.poses @ turn)


def to_optical(trajectory: SpatialTrajectory) -> SpatialTrajectory:
    """The inverse of `from_optical`: C T C^T."""
    turn = se3.pose(np.zeros(3), OPTICAL_FROM_CAMERA)
    return SpatialTrajectory(trajectory.stamps_s, turn @ trajectory.poses @ turn.T)


def _read_kitti(file: Path, times: Path | None) -> SpatialTrajectory:
    if times is None:
        raise TrajectoryError(
            f"{file}: KITTI poses have no stamps; the file of their times is needed as well, one "
            "number of seconds a line (times.txt)"
        )
    return read_kitti(file, times)


def _write_tum(folder: Path, name: str, trajectory: SpatialTrajectory) -> tuple[Path, ...]:
    file = folder / f"{name}.tum"
    write_spatial_tum(file, trajectory)
    return (file,)


def _write_kitti(folder: Path, name: str, trajectory: SpatialTrajectory) -> tuple[Path, ...]:
    file, times = folder / f"{name}_kitti.txt", folder / f"{name}_times.txt"
    write_kitti(file, times, trajectory)
    return file, times


def _write_euroc(folder: Path, name: str, trajectory: SpatialTrajectory) -> tuple[Path, ...]:
    file = folder / f"{name}_euroc.csv"
    write_euroc(file, trajectory)
    return (file,)


FORMATS = {
    "tum": TrajectoryFormat(
        "8 numbers (stamp x y z qx qy qz qw)",
        8,
        ROBOT,
        lambda file, _: read_spatial_tum(file),
        _write_tum,
    ),
    "kitti": TrajectoryFormat(
        "12 numbers a pose in optical axes, stamps in a second file",
        12,
        OPTICAL,
        _read_kitti,
        _write_kitti,
    ),
    "euroc": TrajectoryFormat(
        "8 numbers and more with commas (nanoseconds, position, quaternion w first)",
        8,
        ROBOT,
        lambda file, _: read_euroc(file),
        _write_euroc,
        separator=",",
        more=True,
    ),
}
