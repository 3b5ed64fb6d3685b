"""Where the camera of a run sits: as stated, from transforms, marked points, or the run itself."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import FloatArray
from odometry.geometry import se3
from odometry.geometry.se3 import mount_of_optical
from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from terrain.calibration.lens_sources import LensSource
from terrain.calibration.mount_fit import MountFit
from terrain.calibration.mount_from_motion import mount_from_motion
from terrain.calibration.mount_from_points import (
    MarkedPoints,
    mount_from_points,
    read_marked_points,
)
from terrain.calibration.tracks import Tracks, tracker_of
from terrain.camera.camera import Camera
from terrain.camera.camera_values import finite_array
from terrain.camera_files.lens_models import Lens
from terrain.camera_files.transforms import ROBOT, mount_in, read_transforms
from terrain.errors import CalibrationError, CameraError


@dataclass(frozen=True, eq=False)
class MountSource:
    """A camera on the robot, and the source of its mount.

    Attributes
    ----------
    camera : Camera
    where : str
        In words.
    fit : MountFit or None
        With its intervals, where it was fitted.
    tracks : Tracks or None
        Features of the images, where the mount comes from the run.
    points : MarkedPoints or None
        Where the mount comes from them.
    """

    camera: Camera
    where: str
    fit: MountFit | None = None
    tracks: Tracks | None = None
    points: MarkedPoints | None = None


def mount_of_run(run: Run, lens: LensSource) -> MountSource | None:
    """The mount of [camera] in run.toml, None where it has none that goes with the lens.

    A `ground_to_image` belongs to the lens of the same table.

    Raises
    ------
    CameraError
        If it is not as the format says.
    """
    table, where = run.settings.get("camera"), f"{run.folder / 'run.toml'}"
    if not isinstance(table, dict) or not {"mount", "ground_to_image"} & table.keys():
        return None
    if "ground_to_image" in table and not lens.is_own:
        return None
    return MountSource(Camera.from_table(table | lens.lens.to_table(), where), where)


def mount_as_stated(lens: Lens, mount: ArrayLike, where: str = "--mount") -> MountSource:
    """A mount (6,) that somebody measured.

    Raises
    ------
    CameraError
        If it is no mount.
    """
    return MountSource(_mounted(lens, mount), where)


def mount_of_transforms(
    lens: LensSource, file: Path, frame: str | None = None, robot: str = ROBOT
) -> MountSource:
    """The mount from a file of transforms; the frame is by default named as the camera is.

    Raises
    ------
    CameraError
        If the file does not hold it.
    """
    transforms = read_transforms(file)
    name = frame or (lens.file.name if lens.file is not None else "")
    if not name:
        frames = sorted({child for _, child in transforms})
        raise CalibrationError(f"{file}: which frame is the camera's? Give --frame: {frames}")
    try:
        mount = mount_in(transforms, name, robot)
    except CameraError as error:
        raise CameraError(f"{file}: {error}") from error
    return MountSource(_mounted(lens.lens, mount), f"frame {name} of {file}")


def mount_of_imu(lens: LensSource, imu: ArrayLike) -> MountSource:
    """The mount from T_cam_imu of a Kalibr file and the place of the IMU in the robot frame (6,).

    Raises
    ------
    CameraError
        If the file has no T_cam_imu.
    """
    if lens.file is None or lens.file.camera_from_imu is None:
        raise CalibrationError(f"{lens.where}: no T_cam_imu")
    place = finite_array("--imu", imu, (6,))
    robot_from_imu = se3.pose(place[:3], se3.rotation_from_roll_pitch_yaw(place[3:]))
    optical = robot_from_imu @ se3.inverse(lens.file.camera_from_imu)
    return MountSource(_mounted(lens.lens, mount_of_optical(optical)), f"T_cam_imu of {lens.where}")


def mount_of_points(lens: Lens, file: Path) -> MountSource:
    """The mount from marked points of the terrain.

    Raises
    ------
    CalibrationError
        If the points do not determine it.
    """
    points = read_marked_points(file)
    try:
        fit = mount_from_points(lens, points)
    except CalibrationError as error:
        raise CalibrationError(f"{file}: {error}") from error
    return MountSource(_mounted(lens, fit.mount), str(file), fit, points=points)


def mount_of_motion(
    run: Run,
    odometer: Trajectory,
    lens: Lens,
    known: FloatArray | None = None,
    *,
    show_progress: bool = False,
) -> MountSource:
    """The mount from a run and its odometer; x and y are those of the mount known, or zero.

    Raises
    ------
    CalibrationError
        If the run does not determine it.
    """
    if run.images is None:
        raise CalibrationError(f"{run.folder}: no images.csv: a mount cannot be determined from it")
    tracker = tracker_of(run, lens, odometer, show_progress=show_progress)
    fit, tracks = mount_from_motion(tracker.track(), lens, known, tracker.track)
    return MountSource(_mounted(lens, fit.mount), f"the motion of {run.folder}", fit, tracks)


def with_height(source: MountSource) -> MountSource:
    """The same mount, whose height nobody stated.

    Raises
    ------
    CalibrationError
        If the run does not determine the height: what run.toml says may be what is wrong.
    """
    if source.fit is not None and np.isnan(source.fit.half_interval[2]):
        raise CalibrationError(
            "the run does not determine the height of the camera: give a mount that was measured "
            "with --mount, or drive farther"
        )
    return source


def _mounted(lens: Lens, mount: ArrayLike) -> Camera:
    values = np.asarray(mount, dtype=np.float64)
    return Camera.from_mount(lens.image_size, lens.matrix, lens.distortion, values)
