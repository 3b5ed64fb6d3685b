"""Read the calibration of one camera, whichever program wrote the file; chains of Kalibr too."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from odometry.io.structured import read_toml
from terrain.camera.camera_values import finite_array
from terrain.camera_files.lens_models import Calibration, Lens, lens_of
from terrain.camera_files.transforms import rigid
from terrain.camera_files.values import matrix, numbers, read_values
from terrain.errors import CameraError

if TYPE_CHECKING:
    from odometry.arrays import FloatArray


def is_kalibr(values: Mapping[str, Any]) -> bool:
    """Whether a file holds cameras as Kalibr describes them."""
    return bool(_cameras(values))


def read_kalibr(values: Mapping[str, Any], name: str | None = None) -> Calibration:
    """One camera of a camchain.

    Parameters
    ----------
    values : Mapping
        The file.
    name : str, optional
        `cam0`, ...; may be left out where there is one.

    Raises
    ------
    CameraError
        If there is no such camera, several and no name, or one that is no pinhole.
    """
    cameras = _cameras(values)
    if name is None and len(cameras) > 1:
        raise CameraError(f"several cameras: {', '.join(cameras)}; name one")
    chosen = name or next(iter(cameras))
    if chosen not in cameras:
        raise CameraError(f"no camera {chosen!r}; found: {', '.join(cameras)}")
    camera = cameras[chosen]
    model = str(camera.get("camera_model", "pinhole"))
    if model != "pinhole":
        raise CameraError(
            f"{chosen}: camera_model {model!r}, which [camera] cannot express; calibrate with "
            "Kalibr's pinhole-radtan or pinhole-equi"
        )
    fx, fy, cx, cy = matrix(camera["intrinsics"], f"{chosen}: intrinsics", (1, 4))[0]
    width, height = matrix(camera.get("resolution"), f"{chosen}: resolution", (1, 2))[0]
    if not (np.isfinite([width, height]).all() and width == int(width) and height == int(height)):
        raise CameraError(f"{chosen}: resolution is {width:g} x {height:g}, expected whole numbers")
    lens, notes = lens_of(
        str(camera.get("distortion_model", "none")),
        (int(width), int(height)),
        np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]),
        numbers(camera.get("distortion_coeffs", []), f"{chosen}: distortion_coeffs"),
    )
    pose = camera.get("T_cam_imu")
    from_imu = None if pose is None else rigid(matrix(pose, "T_cam_imu", (4, 4)), "T_cam_imu")
    return Calibration(chosen, lens, camera_from_imu=from_imu, notes=notes)


def _cameras(values: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    return {
        str(name): entry
        for name, entry in values.items()
        if isinstance(entry, Mapping) and "intrinsics" in entry
    }


# spellings of ROS 1 and 2, of OpenCV's samples and of what people write, without case and _
MATRIX = ("cameramatrix", "k", "intrinsicmatrix", "mtx", "matrix")
DISTORTION = ("distortioncoefficients", "distcoeffs", "distortion", "dist", "d")
WIDTH, HEIGHT, SIZE = ("imagewidth", "width"), ("imageheight", "height"), ("imagesize",)
FISHEYE_FLAG = ("fisheyemodel",)
FISHEYE_COUNT = 4  # of coefficients; cv2.calibrateCamera writes five or more
WHICH_FOUR = (
    "four distortion coefficients, and no distortion_model: cv2.fisheye.calibrate gives four (k1 "
    "to k4), and an ordinary lens may have four (k1, k2, p1, p2). Add the line distortion_model: "
    "equidistant (fisheye) or distortion_model: plumb_bob to the file"
)


def read_calibration(
    file: Path, *, name: str | None = None, image_size: tuple[int, int] | None = None
) -> Calibration:
    """Read a camera from a ROS camera_info, Kalibr camchain or OpenCV file, or a `[camera]` table.

    Parameters
    ----------
    file : Path
        YAML, XML, JSON, or TOML with the table `[camera]`.
    name : str, optional
        Which camera of a file with several.
    image_size : (int, int), optional
        Width and height for a file that does not say them.

    Raises
    ------
    CameraError
        Naming the file, and what it lacks or `[camera]` cannot express.
    """
    if file.suffix.lower() == ".toml":
        return _of_table(file)
    values = read_values(file)
    try:
        if is_kalibr(values):
            return read_kalibr(values, name)
        return _plain(values, image_size)
    except CameraError as error:
        raise CameraError(f"{file}: {error}") from error


def _plain(values: Mapping[str, Any], image_size: tuple[int, int] | None) -> Calibration:
    """Of one camera: ROS camera_info, or what cv2.FileStorage wrote."""
    entries = {str(key).lower().replace("_", ""): value for key, value in values.items()}
    intrinsics = _first(entries, MATRIX)
    if intrinsics is None:
        raise CameraError(
            f"no camera_matrix (or K); found: {', '.join(map(str, values))[:200] or 'nothing'}"
        )
    _refuse_binning(entries)
    coefficients = _first(entries, DISTORTION)
    distortion = numbers(coefficients, "distortion") if coefficients else np.empty(0)
    model = str(entries.get("distortionmodel", ""))
    if str(_first(entries, FISHEYE_FLAG) or "0") not in ("0", "false"):
        model = "fisheye"
    if not model and distortion.size == FISHEYE_COUNT and distortion.any():
        raise CameraError(WHICH_FOUR)
    size = _size(entries) or image_size
    if size is None:
        raise CameraError(
            "the size of the image is not stated, and there is no image to read it from"
        )
    lens, notes = lens_of(model, size, matrix(intrinsics, "camera_matrix", (3, 3)), distortion)
    return Calibration(str(entries.get("cameraname", "")), lens, notes=notes)


def _refuse_binning(entries: Mapping[str, Any]) -> None:
    """A camera_info of binned or cropped images has the matrix of the whole ones."""
    for key in ("binningx", "binningy"):
        if str(entries.get(key, 0)) not in ("0", "1"):
            raise CameraError(
                f"{key[:-1]}_{key[-1]} = {entries[key]}: its matrix is that of images without "
                "binning; give a calibration of the images as recorded"
            )


def _first(entries: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    return next((entries[name] for name in names if name in entries), None)


def _size(entries: Mapping[str, Any]) -> tuple[int, int] | None:
    pair = _first(entries, SIZE)
    if pair is None:
        pair = [_first(entries, WIDTH), _first(entries, HEIGHT)]
        if None in pair:
            return None
    size: FloatArray = numbers(pair, "image size")
    if size.size != 2 or not np.isfinite(size).all():
        raise CameraError(f"image size is {size.tolist()}, expected width and height")
    if (size != np.floor(size)).any():
        raise CameraError(f"image size is {size.tolist()}, expected whole numbers")
    return int(size[0]), int(size[1])


def _of_table(file: Path) -> Calibration:
    table = read_toml(file, CameraError).get("camera")
    if not isinstance(table, dict) or not {"image_size", "matrix"} <= table.keys():
        raise CameraError(f"{file}: no table [camera] with image_size and matrix")
    try:
        lens = Lens.of(table["image_size"], table["matrix"], table.get("distortion", []))
        mount = finite_array("mount", table["mount"], (6,)) if "mount" in table else None
    except (CameraError, TypeError, ValueError) as error:
        raise CameraError(f"{file}: [camera] {error}") from error
    return Calibration("", lens, mount=mount)
