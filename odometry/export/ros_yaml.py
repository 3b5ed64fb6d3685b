"""Parameters of ROS 2 nodes as YAML, each number with its interval as a comment.

Three sections: `diff_drive_controller` (ros2_controllers), `ekf_filter_node` (robot_localization,
whose process noise is the growth of variance in a second), and `slip_by_terrain`, which no node of
ROS reads: for simulators that take slip by terrain.
"""

from collections.abc import Iterable, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.export.drive_numbers import DriveNumbers, MotionErrors, Pace, Stated
from odometry.io.formats import format_line

FORMAT = 1
NOT_MEASURED = 1e6  # variance by which drivers of ROS say that a component is not measured
# Of robot_localization's own example, for what windows of motion do not determine.
EXAMPLE_NOISE = (
    *(0.05, 0.05, 0.06, 0.03, 0.03, 0.06, 0.025, 0.025, 0.04),
    *(0.01, 0.01, 0.02, 0.01, 0.01, 0.015),
)
MEASURED = (0, 1, 5)  # x, y and yaw, of x y z, roll pitch yaw, their rates and accelerations


def ros_yaml(
    drive: DriveNumbers,
    terrains: Sequence[DriveNumbers],
    *,
    errors: MotionErrors | None = None,
    pace: Pace | None = None,
    wheel_radius_m: float | None = None,
    comment: str = "",
) -> str:
    """The text of the file.

    Parameters
    ----------
    drive : DriveNumbers
        Of the terrain whose numbers the controller gets: it knows one.
    terrains : sequence of DriveNumbers
        All, for simulators.
    errors : MotionErrors, optional
        Without them the covariances are left out, and the file says so.
    pace : Pace, optional
        At which the covariances hold; needed with `errors`.
    wheel_radius_m : float, optional
    comment : str
        Whole lines that begin with #, below the first.
    """
    lines = [
        f"{format_line('ROS parameters', FORMAT)}{comment}# Intervals are of 95 %.",
        *_controller(drive, errors, pace, wheel_radius_m),
        *_filter(errors, pace),
        *_slip(terrains),
    ]
    return "\n".join(lines) + "\n"


def _controller(
    drive: DriveNumbers, errors: MotionErrors | None, pace: Pace | None, radius_m: float | None
) -> Iterable[str]:
    yield "diff_drive_controller:"
    yield "  ros__parameters:"
    yield f"    # Terrain: {printable(drive.terrain)} (model {drive.model})"
    for name in drive.effects:
        yield f"    # Left out: the effect {printable(name)}"
    yield f"    wheel_separation: {_number(drive.track_width_m)}"
    if radius_m is not None:
        yield f"    wheel_radius: {_number(radius_m)}"
    yield f"    wheel_separation_multiplier: {_with_interval(drive.separation)}"
    yield f"    left_wheel_radius_multiplier: {_with_interval(drive.left)}"
    yield f"    right_wheel_radius_multiplier: {_with_interval(drive.right)}"
    yield from _left_over(drive.x_icr_m, drive.y_middle_m)
    if errors is None or pace is None:
        yield "    # twist_covariance_diagonal is left out: the error of the motion is not known."
        yield "    # Export a folder that `run` wrote with poses, or use `identify --ros`."
        return
    left_over_m = (drive.y_middle_m.value, drive.x_icr_m.value)
    v_x, v_y, omega = errors.twist_variances(pace, left_over_m).tolist()
    diagonal = (v_x, v_y, NOT_MEASURED, NOT_MEASURED, NOT_MEASURED, omega)
    yield f"    # v_x, v_y [m^2/s^2] and yaw rate [rad^2/s^2] {_at(pace)}, with what the"
    yield f"    # multipliers leave out; {printable(errors.source)}"
    yield f"    twist_covariance_diagonal: [{', '.join(map(_number, diagonal))}]"


def _left_over(x: Stated, y: Stated) -> Iterable[str]:
    """What the controller's numbers have no place for."""
    if x.value == y.value == 0:
        yield "    # The model supposes x_icr = 0 and symmetric ICRs, as this controller does."
        return
    yield "    # These numbers have no place for v_y = -x_icr omega and for y_middle omega in v_x:"
    yield f"    #   x_icr = {_number(x.value)} m, {_interval(x)}"
    yield f"    #   y_middle = (y_left + y_right) / 2 = {_number(y.value)} m, {_interval(y)}"
    yield "    # A frame at (x_icr, y_middle) moves without them: base_frame_id: icr_link, and"
    yield (
        f"    #   ros2 run tf2_ros static_transform_publisher --x {_number(-x.value)} "
        f"--y {_number(-y.value)} --frame-id icr_link --child-frame-id base_link"
    )


def _filter(errors: MotionErrors | None, pace: Pace | None) -> Iterable[str]:
    if errors is None or pace is None:
        yield "# ekf_filter_node is left out: its process noise is not known."
        return
    noise = np.array(EXAMPLE_NOISE)
    noise[list(MEASURED)] = errors.pose_variances_per_s(pace)
    yield "ekf_filter_node:"
    yield "  ros__parameters:"
    yield f"    # x, y [m^2/s] and yaw [rad^2/s] {_at(pace)}, with wheel odometry alone;"
    yield f"    # {printable(errors.source)}"
    yield "    # The other variances are those of robot_localization's example: not measured."
    yield "    dynamic_process_noise_covariance: false"
    yield f"    process_noise_covariance: [{_rows(np.diag(noise))}]"


def _slip(terrains: Sequence[DriveNumbers]) -> Iterable[str]:
    yield "slip_by_terrain:"
    yield "  ros__parameters:"
    yield "    # slip_left = 1 - alpha_left, of the tread speed; turning_slip is the share of the"
    yield "    # yaw rate that is lost on the spot. What a simulator's contacts need (slip per"
    yield "    # force) does not follow from motion: choose it so that these come out."
    for each in terrains:
        yield f"    {_key(each.terrain)}:"
        yield f"      wheel_separation_multiplier: {_with_interval(each.separation)}"
        yield f"      slip_left: {_with_interval(_lost(each.left))}"
        yield f"      slip_right: {_with_interval(_lost(each.right))}"
        yield f"      turning_slip: {_with_interval(each.turning_slip)}"
        yield f"      x_icr: {_with_interval(each.x_icr_m)}"
        yield f"      y_middle: {_with_interval(each.y_middle_m)}"


def _lost(factor: Stated) -> Stated:
    return Stated(1 - factor.value, 1 - factor.high, 1 - factor.low)


def _at(pace: Pace) -> str:
    return f"at a wheel speed of {pace.wheel_speed_m_s:.3g} m/s and {pace.yaw_rate_rad_s:.3g} rad/s"


def _with_interval(number: Stated) -> str:
    return f"{_number(number.value)}  # {_interval(number)}"


def _interval(number: Stated) -> str:
    if np.isnan(number.low):
        return "not identified: as the model supposes, or without a stated uncertainty"
    return f"{number.low:.4g} to {number.high:.4g}"


def _number(value: float) -> str:
    """A number that YAML reads as a float; ROS 2 takes no integer for one."""
    text = f"{value:.6g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa if '.' in mantissa else mantissa + '.0'}e{exponent}"
    return text if "." in text else f"{text}.0"


def _rows(matrix: FloatArray) -> str:
    rows = [", ".join(map(_number, row)) for row in matrix.tolist()]
    return (",\n" + 31 * " ").join(rows)


def _key(name: str) -> str:
    """A name as a YAML string."""
    return '"' + printable(name).replace("\\", "\\\\").replace('"', '\\"') + '"'


def printable(text: str) -> str:
    """A text as one line of YAML: names may hold line breaks."""
    return "".join(c if c.isprintable() else "?" for c in text)
