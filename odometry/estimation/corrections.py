"""What the effects of a parameter set change at each row of odometry.csv, for the ICR filter."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Corrected, corrected_twist, with_true_speeds
from odometry.effects.tables import model_of
from odometry.errors import ParameterError
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.windows.recorded.run_inputs import inputs_of

NO_SPEEDS, NO_TWIST = np.zeros(2), np.zeros(3)


@dataclass(frozen=True)
class Correction:
    """What the effects of one terrain change along a run.

    Attributes
    ----------
    speeds_m_s : (N, 2)
        True less recorded tread speeds, at each row of odometry.csv.
    twists : (N, 3)
        What effects on the motion add to the twist of the base at the true speeds and at the
        parameters of the set. It stays while a filter estimates other ICRs.
    """

    speeds_m_s: FloatArray
    twists: FloatArray


def corrections_of(run: Run, parameters: ParameterSet) -> Mapping[str, Correction]:
    """The corrections of every terrain of a parameter set that has effects.

    Parameters
    ----------
    run : Run
        As recorded: effects on the measurement are undone by
        `odometry.effects.measurement.measured.robot_run`.
    parameters : ParameterSet

    Raises
    ------
    ParameterError
        If an effect is not known, or needs what the base model or the run does not have.
    """
    found = {}
    for name, table in parameters.terrains.items():
        model = model_of(table, run.robot, f"[terrain.{name}]")
        if isinstance(model, Corrected):
            base = Base(model.base, model.base.pack(table.values), run.robot)
            found[name] = _correction(base, model, run)
    return found


def _correction(base: Base, model: Corrected, run: Run) -> Correction:
    recorded = inputs_of(run)
    true = with_true_speeds(model.effects, recorded)
    plain = base.model.twist(base.values, true)
    return Correction(
        true.tread_speeds_m_s - recorded.tread_speeds_m_s,
        corrected_twist(base, model.effects, recorded) - plain,
    )


def require_corrections(parameters: ParameterSet, corrections: Mapping[str, Correction]) -> None:
    """Every terrain of a parameter set that has effects has its correction.

    Raises
    ------
    ParameterError
        If one has not.
    """
    for name, table in parameters.terrains.items():
        if table.effects and name not in corrections:
            raise ParameterError(
                f"[terrain.{name}]: effects were given; the ICR filter needs what they change "
                "along the run (odometry.estimation.corrections)"
            )


def added_from(
    corrections: Mapping[str, Correction], terrain: str, row: int
) -> tuple[FloatArray, FloatArray]:
    """What effects add to tread speeds (2,) and twist (3,) from a row of odometry.csv on.

    Nothing before the first row, which is -1, and on terrain without effects.
    """
    correction = corrections.get(terrain)
    if correction is None or row < 0:
        return NO_SPEEDS, NO_TWIST
    return correction.speeds_m_s[row], correction.twists[row]
