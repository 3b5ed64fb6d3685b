"""ros.yaml: the numbers of a parameter set or a result for nodes of ROS 2."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from odometry.errors import ParameterError
from odometry.export.drive_numbers import MotionErrors, Pace, drive_numbers
from odometry.export.ros_yaml import printable, ros_yaml
from odometry.export.source import ExportSource
from odometry.identification.identification import Identification
from odometry.io.files import atomic_write
from odometry.recording.run import Run


def write(source: ExportSource, folder: Path) -> None:
    """Write ros.yaml: of the chosen terrain for the controller, of all for simulators.

    Terrains without such numbers are left out with a comment.

    Raises
    ------
    ParameterError
        If the chosen one has none.
    """
    chosen, terrains = source.chosen_terrain, source.parameters.terrains
    numbers = {chosen: drive_numbers(chosen, terrains[chosen], source.track_width_m)}
    left_out = ""
    for name in terrains:
        if name == chosen:
            continue
        try:
            numbers[name] = drive_numbers(name, terrains[name], source.track_width_m)
        except ParameterError as error:
            left_out += f"# left out: {printable(str(error))}\n"
    ordered = [numbers[name] for name in terrains if name in numbers]
    robot = source.content.get("robot", {})
    text = ros_yaml(
        numbers[chosen],
        ordered,
        errors=source.motion_errors,
        pace=source.pace,
        wheel_radius_m=robot.get("wheel_radius"),
        comment=source.comment + left_out,
    )
    write_text(folder / "ros.yaml", text)


def identified_ros_yaml(found: Identification, runs: Sequence[Run], comment: str) -> str:
    """The text of ros.yaml for what was identified, with its held-out errors.

    Raises
    ------
    ParameterError
        If the runs have several terrains, or the model has no constant ICRs.
    """
    terrains = found.to_parameter_set().terrains
    if len(terrains) > 1:
        raise ParameterError(
            f"a controller knows one terrain, and the runs have {', '.join(terrains)}; choose with "
            "terrain-odometry export SET.toml --to ros --terrain NAME --out DIR"
        )
    ((name, table),) = terrains.items()
    drive = drive_numbers(name, table, found.robot.track_width)
    of_terrain = found.terrains[name]
    errors = None
    if of_terrain.held_out is not None:
        horizon_m = float(np.mean(of_terrain.fit.windows.travel_m))
        source = f"from held-out errors over {horizon_m:.2g} m, by {of_terrain.held_out_by}"
        errors = MotionErrors.of_windows(of_terrain.held_out, horizon_m, source)
    return ros_yaml(
        drive,
        [drive],
        errors=errors,
        pace=_pace(runs, drive.separation.value * drive.track_width_m),
        wheel_radius_m=found.robot.wheel_radius,
        comment=comment,
    )


def write_text(file: Path, text: str) -> None:
    """Write a text file whole or not at all."""
    with atomic_write(file) as part:
        part.write_text(text, encoding="utf-8")


def _pace(runs: Sequence[Run], width_m: float) -> Pace:
    """Mean wheel speed and yaw rate of runs, turned by treads an effective width apart."""
    travel_m = duration_s = turned = 0.0
    for run in runs:
        steps_s = np.diff(run.odometry.stamps_s)
        difference = run.odometry["v_right"] - run.odometry["v_left"]
        travel_m += float(run.wheel_travel_m[-1])
        duration_s += float(steps_s.sum())
        turned += float(np.sum(np.abs(difference[:-1]) * steps_s)) / width_m
    return Pace(travel_m / duration_s, turned / duration_s)
