"""How well the answers of a track are those that the run names."""

from dataclasses import dataclass

import numpy as np

from odometry.modes.detection import (
    Detection,
    confusion,
    detections,
    false_switches,
    narrowed_s,
)
from odometry.modes.mode_track import ModeTrack


@dataclass(frozen=True)
class Score:
    """Answers against the modes that the run names.

    Attributes
    ----------
    detections : tuple of Detection
        One for each stretch of a mode.
    right, wrong, undetermined, none_of_these : float
        Shares of the time after each detection, over all stretches; NaN where none was detected.
    wrong_of_all : float
        Share of all the time in stretches of a mode, detected or not; NaN where there is none.
    narrowed_of_all, missed_of_all : float
        Shares of the same time in which no mode is named, and the true one is among candidates that
        are fewer than all; and is not among them.
    false_switches : int
    """

    detections: tuple[Detection, ...]
    right: float
    wrong: float
    undetermined: float
    none_of_these: float
    wrong_of_all: float
    narrowed_of_all: float
    missed_of_all: float
    false_switches: int

    @property
    def told(self) -> tuple[Detection, ...]:
        """Stretches whose mode was named."""
        return tuple(one for one in self.detections if np.isfinite(one.after_s))

    @property
    def median_after_s(self) -> float:
        """Median time to detection, NaN without one."""
        return float(np.median([one.after_s for one in self.told])) if self.told else float("nan")


def score_of(track: ModeTrack, sure: float) -> Score:
    """Answers, named from a probability of `sure` on, against the modes that the run names."""
    found = detections(track, sure)
    named = [one for one in found if np.isfinite(one.after_s)]
    weights = np.array([one.to_s - one.from_s - one.after_s for one in named])
    shares = np.array(
        [(one.right, one.wrong, one.undetermined, one.none_of_these) for one in named]
    )
    means = np.full(4, np.nan)
    if weights.sum() > 0:
        means = weights @ shares / weights.sum()
    right, wrong, open_, none = means.tolist()
    seconds = confusion(track, sure, track.names)
    judged = float(seconds.sum())
    of_modes = seconds[:, : len(track.names)]
    off = float(of_modes.sum() - np.trace(of_modes))
    wrong_of_all, narrowed_of_all, missed_of_all = (
        one / judged if judged else float("nan") for one in (off, *narrowed_s(track, sure))
    )
    return Score(
        found,
        right,
        wrong,
        open_,
        none,
        wrong_of_all,
        narrowed_of_all,
        missed_of_all,
        false_switches(track, sure),
    )
