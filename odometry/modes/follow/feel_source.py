"""What a run feels like, as evidence of the mode it is in."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import floored, log_sum
from odometry.feel.labels.follow import Felt, follow_feel
from odometry.feel.model import FeelModel
from odometry.feel.recorded.windows import STEPS
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.modes_config import ModesConfig
from odometry.recording.run import UNKNOWN, Run


@dataclass(frozen=True)
class FeelSource:
    """Evidence of K windows of feel for M modes.

    Attributes
    ----------
    stamps_s : (K,)
        From when on each window is known.
    log_evidence : (K, M)
        Log likelihood of each mode, up to a constant, times the weight of a window: what windows
        were worth on runs held out, and n that follow one another count as fewer (see
        `odometry.feel.assessment.evidence.Calibration`).
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

    A terrain that is no mode is no evidence on any, nor is a window unlike all terrains of the
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


def with_feel(
    track: ModeTrack, source: FeelSource, dwell_s: FloatArray, config: ModesConfig
) -> ModeTrack:
    """The track of modes that last `dwell_s` (M,), with what the run feels like.

    The probabilities of motion and of feel, each by a Markov chain of its own, are multiplied. What
    motion cannot distinguish is left to feel: modes that predict the same motion are as probable as
    their mean by motion, and where the rolling test does not agree with motion it says nothing.
    """
    felt = source.alone(track.stamps_s, ModeChain(dwell_s).transition, config.floor)
    product = felt * _by_motion(track, config.agreed)
    probabilities = product / product.sum(axis=1, keepdims=True)
    return replace(track, probabilities=probabilities, felt=felt, alike=None)


def _by_motion(track: ModeTrack, agreed: float) -> FloatArray:
    """Probabilities (N, M) among modes that motion distinguishes."""
    most = track.probabilities.argmax(axis=1)
    of_most = (np.arange(len(most)), most)
    by_motion = track.probabilities.copy()
    if track.alike is not None:
        one = track.alike.copy()
        one[of_most] = True
        means = (by_motion * one).sum(axis=1) / one.sum(axis=1)
        by_motion = np.where(one, means[:, None], by_motion)
    if track.fit is not None:
        by_motion[np.exp(track.fit.log_probabilities[of_most]) < agreed] = 1 / by_motion.shape[1]
    return by_motion


def _of_modes(felt: Felt, names: Sequence[str]) -> FloatArray:
    """Likelihood (W, M) of each mode, each row with a sum of 1."""
    of_terrain = dict(zip(felt.model.names, felt.probabilities.T, strict=True))
    mean = felt.probabilities.mean(axis=1)
    known = [of_terrain[name] for name in names if name in of_terrain]
    others = np.clip(1 - np.sum(known, axis=0), 0.0, 1.0)
    columns = np.stack([of_terrain.get(name, mean) for name in names], axis=1)
    columns = columns + others[:, None] / len(names)
    return np.asarray(columns / columns.sum(axis=1, keepdims=True))
