"""Terrain by feel, as labels of the images that showed it before."""

import numpy as np

from odometry.errors import RunFolderError
from odometry.feel.follow import SILENT, FeelConfig, follow_feel
from odometry.feel.model import FeelModel
from odometry.run import UNKNOWN, Run
from terrain.labelling.given_terrain import GivenTerrain

SURE = 0.8  # probability from which a window labels: a wrong label misleads the classifier
STRETCH_S = 4.0  # so long is put together, around the moment that is labelled


def told_by_feel(run: Run, model: FeelModel, sure: float = SURE) -> GivenTerrain:
    """The terrain by feel of a run, where that is sure; elsewhere there is no label.

    Evidence of STRETCH_S is put together, half of it from before each moment and half from after.

    Parameters
    ----------
    run : Run
    model : FeelModel
        Of the same robot.
    sure : float
        Probability from which a terrain is told.

    Raises
    ------
    RunFolderError
        If no moment feels like a terrain with that probability, or as `follow_feel`.
    """
    felt = follow_feel(run, model, FeelConfig(stretch_s=STRETCH_S, sure=sure))
    silent = np.isin(felt.lasting_answers.astype(str), [*SILENT, UNKNOWN])
    most = felt.lasting_probabilities.max(axis=1)
    if silent.all():
        raise RunFolderError(
            f"{run.folder}: no moment feels like one of {', '.join(model.names)} with a "
            f"probability of {sure:g} or more (at the most {most.max():.2f})"
        )
    names = np.where(silent, "", felt.lasting_answers)
    return GivenTerrain(
        f"feel (mean probability {most[~silent].mean():.2f})",
        felt.stamps_s - STRETCH_S / 2,
        tuple(names.tolist()),
        probabilities=most,
    )
