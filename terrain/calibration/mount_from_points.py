"""The mount from marked points of the terrain: least reprojection error in the image."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from odometry.arrays import FloatArray, IntArray
from odometry.geometry import se3
from odometry.geometry.se3 import mount_of_optical, optical_of_mount
from odometry.io.csv_columns import opened_csv
from terrain.calibration.mount_fit import NAMES, MountFit, too_wide
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError

COLUMNS = ("u", "v", "x", "y")

FARTHEST_M = 5.0  # no skid-steer robot carries its camera as far from its centre
FEWEST = 4  # three leave up to four mounts
MARK_PX = 0.5  # a mark is no better than this, whatever few points say
UNSEEN_PX = 1e4  # error of a point that a mount puts behind the camera
ODD_PX, ODD_FACTOR = 5.0, 3.0  # a point without which the others agree so much better
SURE = 0.975


@dataclass(frozen=True, eq=False)
class MarkedPoints:
    """Pixels and the points of the terrain that they show.

    Attributes
    ----------
    pixels : (N, 2)
        u, v of the image as recorded; (0, 0) is the centre of the top left pixel.
    ground_m : (N, 2)
        x forward, y left of the robot's centre.
    lines : (N,)
        Of the file, header = 1.
    """

    pixels: FloatArray
    ground_m: FloatArray
    lines: IntArray


def read_marked_points(file: Path) -> MarkedPoints:
    """Read a CSV file with the columns u, v [px], x, y [m], in any order.

    Raises
    ------
    CalibrationError
        Naming file, row and column.
    """
    rows: list[list[float]] = []
    lines: list[int] = []
    with opened_csv(file, CalibrationError) as (header, blocks):
        missing = [name for name in COLUMNS if name not in header]
        if missing:
            raise CalibrationError(
                f"{file}: the column {missing[0]!r} is missing; expected u,v,x,y, the header has "
                f"{', '.join(header)}"
            )
        for block_lines, cells in blocks:
            columns = [cells[header.index(name)] for name in COLUMNS]
            for line, *texts in zip(block_lines, *columns, strict=True):
                named = zip(texts, COLUMNS, strict=True)
                rows.append([_number(text, file, line, name) for text, name in named])
                lines.append(line)
    values = np.array(rows, dtype=np.float64).reshape(-1, 4)
    return MarkedPoints(values[:, :2], values[:, 2:], np.array(lines, dtype=np.int64))


def _number(text: str, file: Path, line: int, name: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not abs(value) <= 1e6:
        raise CalibrationError(
            f"{file}: row {line}, column {name!r}: {text!r}, expected a finite number"
        )
    return value


def mount_from_points(lens: Lens, points: MarkedPoints) -> MountFit:
    """Find place and attitude of the camera that show marked points where they were marked.

    Parameters
    ----------
    lens : Lens
    points : MarkedPoints
        At least four, not on a line; the terrain is a plane.

    Returns
    -------
    MountFit

    Raises
    ------
    CalibrationError
        If there are too few points, they lie on a line, one is outside of the image, or they do
        determine the mount.
    """
    _check(lens, points)
    mount = _best(lens, points.pixels, points.ground_m)
    residuals, jacobian = _linearised(mount, lens, points)
    half_interval = _half_interval(residuals, jacobian)
    errors_px = np.linalg.norm(residuals.reshape(-1, 2), axis=1)
    odd, vague = _odd_one(lens, points, errors_px), too_wide(half_interval)
    if not odd:
        _check_metres(mount)
    if vague.any() and odd:
        raise CalibrationError(f"the points contradict each other: {odd}")
    if vague.any():
        names = ", ".join(name for name, one in zip(NAMES, vague, strict=True) if one)
        raise CalibrationError(
            f"{len(points.lines)} points do not determine {names} of the mount; mark more, far "
            "apart: near and far, left and right"
        )
    return MountFit(mount, half_interval, errors_px, contradiction=odd)


def _check(lens: Lens, points: MarkedPoints) -> None:
    if len(points.lines) < FEWEST:
        raise CalibrationError(
            f"{len(points.lines)} marked points, expected at least {FEWEST}: three leave several "
            "mounts; six or more show a wrong one among them"
        )
    outside = (points.pixels < -0.5) | (points.pixels > np.array(lens.image_size) - 0.5)
    if outside.any():
        first = int(outside.any(axis=1).argmax())
        raise CalibrationError(
            "row {}: the pixel ({:g}, {:g}) is outside of the image of {} x {}".format(
                points.lines[first], *points.pixels[first], *lens.image_size
            )
        )
    spread = np.linalg.svd(points.ground_m - points.ground_m.mean(axis=0), compute_uv=False)
    if spread[1] < 0.02 * spread[0] or spread[0] == 0:
        raise CalibrationError(
            "the marked points lie on a line, which leaves the mount open; mark points to the left "
            "and to the right of it"
        )


def _check_metres(mount: FloatArray) -> None:
    """Raise CalibrationError where x and y of the points put the camera where no robot has it."""
    farthest = float(np.abs(mount[:3]).max())
    if farthest <= FARTHEST_M:
        return
    unit = "mm" if farthest > 30 * FARTHEST_M else "cm"
    raise CalibrationError(
        f"the points put the camera {mount[2]:.3g} m above the terrain, {mount[0]:.3g} m ahead of "
        f"the robot's centre and {mount[1]:.3g} m to its left: are x and y in {unit}? Expected "
        "metres from the robot's centre"
    )


def _best(lens: Lens, pixels: FloatArray, ground_m: FloatArray) -> FloatArray:
    """The mount of the least error, from both poses that a plane leaves (IPPE)."""
    rays = lens.rays(pixels)
    if np.isnan(rays).any():
        raise CalibrationError("a marked pixel is one that the lens model cannot undo")
    flat = np.column_stack([ground_m, np.zeros(len(ground_m))])
    _, turns, shifts, _ = cv2.solvePnPGeneric(
        flat, rays.reshape(-1, 1, 2), np.eye(3), None, flags=cv2.SOLVEPNP_IPPE
    )
    found = []
    for turn, shift in zip(turns, shifts, strict=True):
        rotation = np.asarray(cv2.Rodrigues(turn)[0], dtype=np.float64)
        optical_from_robot = se3.pose(np.asarray(shift, dtype=np.float64).ravel(), rotation)
        start = np.array(mount_of_optical(se3.inverse(optical_from_robot)))
        start[2] = max(start[2], 0.02)
        fit = least_squares(_residuals, start, args=(lens, pixels, ground_m), x_scale="jac")
        if fit.x[2] > 0 and np.isfinite(fit.cost):
            angles = se3.roll_pitch_yaw(se3.rotation_from_roll_pitch_yaw(fit.x[3:]))
            found.append((float(fit.cost), np.concatenate([fit.x[:3], angles])))
    if not found:
        raise CalibrationError(
            "no camera above the terrain shows the points so; is y to the left, v downwards, and "
            "x, y in metres from the robot's centre?"
        )
    return min(found, key=lambda pair: pair[0])[1]


def _residuals(
    mount: FloatArray, lens: Lens, pixels: FloatArray, ground_m: FloatArray
) -> FloatArray:
    """Errors (2 N,) in the image as recorded [px]."""
    optical = se3.inverse(optical_of_mount(mount))
    seen = ground_m @ optical[:3, :2].T + optical[:3, 3]
    depth = np.where(seen[:, 2] > 1e-3, seen[:, 2], np.nan)
    errors = lens.pixels(seen[:, :2] / depth[:, None]) - pixels
    return np.asarray(np.nan_to_num(errors, nan=UNSEEN_PX).ravel())


def _linearised(
    mount: FloatArray, lens: Lens, points: MarkedPoints
) -> tuple[FloatArray, FloatArray]:
    """Residuals (2 N,) and their derivative (2 N, 6) by central differences."""
    step = 1e-6
    columns = [
        (
            _residuals(mount + step * axis, lens, points.pixels, points.ground_m)
            - _residuals(mount - step * axis, lens, points.pixels, points.ground_m)
        )
        / (2 * step)
        for axis in np.eye(6)
    ]
    return _residuals(mount, lens, points.pixels, points.ground_m), np.stack(columns, axis=1)


def _half_interval(residuals: FloatArray, jacobian: FloatArray) -> FloatArray:
    freedom = len(residuals) - 6
    variance = max(float(residuals @ residuals) / freedom, MARK_PX**2)
    with np.errstate(all="ignore"):
        covariance = np.linalg.pinv(jacobian.T @ jacobian, rcond=1e-14) * variance
    rank = np.linalg.matrix_rank(jacobian / np.maximum(np.linalg.norm(jacobian, axis=0), 1e-12))
    if rank < 6:
        return np.full(6, np.inf)
    return np.asarray(student.ppf(SURE, freedom) * np.sqrt(np.diag(covariance)))


def _odd_one(lens: Lens, points: MarkedPoints, errors_px: FloatArray) -> str:
    """Name the one point without which the others agree, if there is one."""
    count = len(points.lines)
    if count < FEWEST + 2 or errors_px.max() < ODD_PX / 2:
        return ""
    rms_px = np.sqrt(np.mean(errors_px**2))
    found = []
    for left_out in range(count):
        kept = np.arange(count) != left_out
        others = MarkedPoints(points.pixels[kept], points.ground_m[kept], points.lines[kept])
        try:
            mount = _best(lens, others.pixels, others.ground_m)
        except CalibrationError:
            continue
        all_errors = _residuals(mount, lens, points.pixels, points.ground_m).reshape(-1, 2)
        lengths = np.linalg.norm(all_errors, axis=1)
        without_px = float(np.sqrt(np.mean(lengths[kept] ** 2)))
        if lengths[left_out] > ODD_PX and ODD_FACTOR * without_px < rms_px:
            found.append((without_px, points.lines[left_out], lengths[left_out]))
    if not found:
        return ""
    without_px, line, off_px = min(found)
    return (
        f"row {line} is {off_px:.1f} px away from where the others put it, and they agree to "
        f"{without_px:.2g} px without it: check that row"
    )
