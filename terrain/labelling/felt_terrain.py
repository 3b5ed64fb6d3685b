"""The terrain that feel gives to the images which showed it before."""

from dataclasses import replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import RunFolderError
from odometry.feel.labels.felt import SILENT, FeelConfig
from odometry.feel.labels.files import doubts
from odometry.feel.labels.follow import Felt, follow_feel
from odometry.feel.model import FeelModel
from odometry.recording.run import UNKNOWN, Run
from terrain.labelling.given_terrain import GivenTerrain

SURE = 0.8  # probability from which a window labels: a wrong label misleads the classifier
STRETCH_S = 4.0  # so long is put together, around the moment that is labelled
LONG_S = 10.0  # and so long has to say the same: a terrain that was never felt shows over time


def given_by_feel(run: Run, model: FeelModel, sure: float = SURE) -> GivenTerrain:
    """The terrain by feel of a run, where that is sure; elsewhere there is no label.

    Evidence of STRETCH_S and of LONG_S is put together, half of it from before each moment and half
    from after. Both have to give the same terrain, and the smaller probability counts.

    Parameters
    ----------
    run : Run
    model : FeelModel
        Of the same robot.
    sure : float
        Probability from which a terrain is given.

    Raises
    ------
    RunFolderError
        If no moment feels like a terrain with that probability, or as `follow_feel`.
    """
    felt = follow_feel(run, model, FeelConfig(stretch_s=STRETCH_S, sure=sure))
    names, most = sure_labels(felt)
    labelled = names != ""
    if not labelled.any():
        raise RunFolderError(
            f"{run.folder}: no moment feels like one of {', '.join(model.names)} with a "
            f"probability of {sure:g} or more (at the most {most.max():.2f}), over {STRETCH_S:g} "
            f"and {LONG_S:g} s around it"
        )
    return GivenTerrain(
        f"feel (mean probability {most[labelled].mean():.2f})",
        felt.stamps_s - STRETCH_S / 2,
        tuple(names.tolist()),
        probabilities=most,
        notes=doubts(felt),
    )


def sure_labels(felt: Felt, long_s: float = LONG_S) -> tuple[AnyArray, FloatArray]:
    """Names (N,), "" where there is none, and probabilities (N,) of the middles of its stretches.

    Of the terrain that its stretch, and so long around the same moment, feel like.
    """
    longer = replace(felt, config=replace(felt.config, stretch_s=long_s))
    late_s = (long_s - felt.config.stretch_s) / 2
    late = np.searchsorted(felt.stamps_s, felt.stamps_s + late_s - 1e-6)
    late = np.minimum(late, len(late) - 1)
    names = felt.lasting_answers.astype(str)
    silent = np.isin(names, [*SILENT, UNKNOWN]) | (names != longer.lasting_answers[late])
    most = felt.lasting_probabilities.max(axis=1)
    most = np.minimum(most, longer.lasting_probabilities[late].max(axis=1))
    return np.where(silent, "", names), most
