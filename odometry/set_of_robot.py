"""Whether a parameter set is of this robot, and in the units of this program."""

from math import inf

import numpy as np

from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Robot

# As which a robot turns, in track widths; printed sets have up to 14 (Baril 2020, concrete)
LEAST_WIDTHS, MOST_WIDTHS = 0.5, 20.0
LEAST_GAIN = 0.1  # metres of the robot for each metre of its treads
SPEED_M_S = 0.5
DRIVES = Inputs(
    SPEED_M_S * np.array([[0.5, 1.0], [1.0, 1.0]]), accelerations_m_s2=np.zeros((2, 2))
)  # a bend to the left, and straight on
IDEAL = "differential_drive"  # whose track width may be an effective one


def set_notes(parameters: ParameterSet, robot: Robot) -> list[str]:
    """Sentences on what cannot be of this robot; none where nothing is odd.

    Examples
    --------
    >>> import odometry
    >>> from odometry.set_of_robot import set_notes
    >>> grass = odometry.TerrainParameters("icr", {"y_left": 350.0, "y_right": -330.0, "x_icr": 0})
    >>> (note,) = set_notes(odometry.ParameterSet({"grass": grass}), odometry.Robot(0.4))
    >>> note.split(":")[0]
    '[terrain.grass]'
    """
    other = other_width(parameters, robot)
    odd = (odd_values(name, table, robot) for name, table in parameters.terrains.items())
    return [note for note in (other, *odd) if note]


def other_width(parameters: ParameterSet, robot: Robot) -> str:
    """A sentence where a set states another track width than the robot has; else empty."""
    tables = [table for table in parameters.terrains.values() if table.model != IDEAL]
    stated = [of.get("track_width") for of in (parameters.vehicle, *(t.values for t in tables))]
    for width in stated:
        if isinstance(width, float | int) and not robot.may_have_width(width):
            named = parameters.vehicle.get("name")
            return (
                f"the parameter set is of a robot of track width {width:g} m"
                f"{f' ({named})' if named else ''}, and this one has {robot.track_width:g} m: how "
                "terrain turns one robot says nothing of another"
            )
    return ""


def odd_values(name: str, table: TerrainParameters, robot: Robot) -> str:
    """A sentence where no robot of this size turns or goes as a table says; else empty.

    Without its effects, in a bend and straight on, on level ground.
    """
    if table.model not in MODELS:
        return ""
    model = MODELS[table.model]
    bend, straight = model.twist(model.pack(table.values), DRIVES)
    gain = float(straight[0]) / SPEED_M_S
    if gain < LEAST_GAIN:
        return (
            f"[terrain.{name}]: a metre of the treads moves the robot by {gain:.2g} m: they are "
            "slip factors of speeds in another unit than m/s"
        )
    width_m = SPEED_M_S / 2 / float(bend[2]) if bend[2] > 0 else inf
    widths = width_m / robot.track_width
    if LEAST_WIDTHS <= widths <= MOST_WIDTHS:
        return ""
    return (
        f"[terrain.{name}]: the robot would turn as if {width_m:.4g} m wide, {widths:.4g} of its "
        "track widths: a set in another unit (metres, radians and m/s are expected), or of "
        "another robot"
    )
