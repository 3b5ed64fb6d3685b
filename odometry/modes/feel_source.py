"""What a run feels like, as evidence of the mode it is in."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.mixture import floored, log_sum
from odometry.estimation.mode_belief import ModeBelief
from odometry.feel.follow import Felt, follow_feel
from odometry.feel.model import FeelModel
from odometry.feel.windows import STEPS
from odometry.run import UNKNOWN, Run


@dataclass(frozen=True)
class FeelSource:
    """Evidence of K windows of feel for M modes.

    Attributes
    ----------
    stamps_s : (K,)
        From when on each window is known.
    log_evidence : (K, M)
        Log likelihood of each mode, up to a constant, as much as a window is worth: what windows
        were worth on runs held out, and n that follow one another count as fewer (see
        `odometry.feel.evidence.Calibration`).
    """

    stamps_s: FloatArray
    log_evidence: FloatArray

    def at(self, stamps_s: FloatArray) -> dict[int, FloatArray]:
        """Evidence (M,) by the first row of stamps (N,) at which it is known."""
        rows = np.searchsorted(stamps_s, self.stamps_s - 1e-9)
        found: dict[int, FloatArray] = {}
        for row, evidence in zip(rows.tolist(), self.log_evidence, strict=True):
            if row < len(stamps_s):
                found[row] = found.get(row, 0.0) + evidence
        return found

    def alone(
        self,
        stamps_s: FloatArray,
        transition: Callable[[float], FloatArray],
        floor: float,
    ) -> FloatArray:
        """Probabilities (N, M) of modes that change by `transition`, from feel and nothing else."""
        evidence, modes = self.at(stamps_s), self.log_evidence.shape[1]
        logs = np.full(modes, -np.log(modes))
        found = np.empty((len(stamps_s), modes))
        for row, step_s in enumerate(np.diff(stamps_s, prepend=stamps_s[0]).tolist()):
            logs = np.log(np.exp(logs) @ transition(step_s))
            if row in evidence:
                logs = floored(logs + evidence[row], floor)
            found[row] = np.exp(logs - log_sum(logs))
        return found


def feel_source(
    run: Run, model: FeelModel, names: Sequence[str], dwell_s: FloatArray
) -> FeelSource:
    """Follow a run by feel, for modes `names` that last `dwell_s` (M,).

    A terrain that is no mode says nothing of any, nor does a window that is like no terrain of the
    model; a mode that the model does not know is as probable as the mean of its terrains.

    Raises
    ------
    ParameterError
        If no mode is a terrain of the model.
    RunFolderError
        As `follow_feel`.
    """
    if not set(names) & set(model.names):
        raise ParameterError(
            f"the model of feel knows {', '.join(model.names)}, the modes are {', '.join(names)}; "
            "expected terrains in common"
        )
    felt = follow_feel(run, model)
    rows = np.flatnonzero(felt.windows.felt & (felt.answers != UNKNOWN))
    likelihoods = _of_modes(felt, names)[rows]
    lasting = np.array([float(np.mean(dwell_s)) / felt.windows.window_s])
    worth = float(model.calibration.worth(lasting)[0] / lasting[0])
    return FeelSource(felt.stamps_s[rows], worth / STEPS * np.log(likelihoods))


def with_evidence(belief: ModeBelief, log_evidence: FloatArray | None, floor: float) -> ModeBelief:
    """The belief with further evidence (M,) of its modes, where there is some."""
    if log_evidence is None:
        return belief
    logs = floored(belief.log_probabilities + log_evidence, floor)
    return ModeBelief(belief.means, belief.covariances, logs, belief.innovations)


def _of_modes(felt: Felt, names: Sequence[str]) -> FloatArray:
    """Likelihood (W, M) of each mode, each row with a sum of 1."""
    of_terrain = dict(zip(felt.model.names, felt.probabilities.T, strict=True))
    mean = felt.probabilities.mean(axis=1)
    known = [of_terrain[name] for name in names if name in of_terrain]
    others = np.clip(1 - np.sum(known, axis=0), 0.0, 1.0)
    columns = np.stack([of_terrain.get(name, mean) for name in names], axis=1)
    columns = columns + others[:, None] / len(names)
    return np.asarray(columns / columns.sum(axis=1, keepdims=True))
