"""Answers against the modes that a run names: how soon, how often right."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.modes.follow.answers import candidates, named_modes
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.recording.run import UNKNOWN


@dataclass(frozen=True)
class Detection:
    """A stretch of one true mode, and how soon it was detected.

    Attributes
    ----------
    mode : str
    from_s, to_s : float
    after_s : float
        From its beginning to the first answer that names it; NaN where it never was named.
    right, wrong, undetermined, none_of_these : float
        Shares of the time after that: with its name, with another, with none, and where no mode
        is the answer. NaN where it was never named.
    """

    mode: str
    from_s: float
    to_s: float
    after_s: float
    right: float
    wrong: float
    undetermined: float
    none_of_these: float


def detections(track: ModeTrack, sure: float) -> tuple[Detection, ...]:
    """One for each stretch of a label that is a mode."""
    answers = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    cuts = np.flatnonzero(track.labels[1:] != track.labels[:-1]) + 1
    found = []
    for rows in np.split(np.arange(len(answers)), cuts):
        mode = str(track.labels[rows[0]])
        if mode == UNKNOWN or mode not in track.names:
            continue
        named = np.flatnonzero(answers[rows] == mode)
        begin, end = float(track.stamps_s[rows[0]]), float(track.stamps_s[rows[-1]])
        if not len(named):
            found.append(Detection(mode, begin, end, *[float("nan")] * 5))
            continue
        after = rows[named[0] :]
        shares = _shares(answers[after], lasts_s[after], mode)
        found.append(Detection(mode, begin, end, float(track.stamps_s[after[0]]) - begin, *shares))
    return tuple(found)


def false_switches(track: ModeTrack, sure: float) -> int:
    """How often the answer turned to a mode that is not the true one."""
    answers = named_modes(track, sure)
    rows = np.flatnonzero(~np.isin(answers, NO_MODES) & (track.labels != UNKNOWN))
    names, truth = answers[rows], track.labels[rows]
    turned = np.append(True, names[1:] != names[:-1])
    return int((turned & (names != truth)).sum())


def confusion(track: ModeTrack, sure: float, names: Sequence[str]) -> FloatArray:
    """Seconds (M, M + 2) by true mode or label (row) and answer (column).

    The last columns are "none of these" and "undetermined". `names` are the rows.
    """
    answers = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    columns = [*track.names, *NO_MODES]
    return np.array(
        [
            [lasts_s[(track.labels == row) & (answers == column)].sum() for column in columns]
            for row in names
        ]
    )


def narrowed_s(track: ModeTrack, sure: float) -> tuple[float, float]:
    """Seconds in which the answer is undetermined on a mode: narrowed down, and missed.

    The true mode is one of candidates that are fewer than all; it is none of them.
    """
    judged = np.isin(track.labels, track.names) & (named_modes(track, sure) == UNDETERMINED)
    chosen = candidates(track, sure)[judged]
    is_true = track.labels[judged, None] == np.array(track.names, dtype=object)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)[judged]
    among = (chosen & is_true).any(axis=1)
    narrowed = among & ~chosen.all(axis=1)
    return float(lasts_s[narrowed].sum()), float(lasts_s[~among].sum())


def _shares(answers: AnyArray, lasts_s: FloatArray, mode: str) -> tuple[float, float, float, float]:
    if not lasts_s.any():  # the last stamp alone
        lasts_s = np.ones(len(answers))
    whole = float(lasts_s.sum())
    others = ~np.isin(answers, (mode, *NO_MODES))
    chosen = (answers == mode, others, answers == UNDETERMINED, answers == NONE_OF_THESE)
    right, wrong, open_, none = (float(lasts_s[of].sum()) / whole for of in chosen)
    return right, wrong, open_, none


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
    def detected(self) -> tuple[Detection, ...]:
        """Stretches whose mode was named."""
        return tuple(one for one in self.detections if np.isfinite(one.after_s))

    @property
    def median_after_s(self) -> float:
        """Median time to detection, NaN without one."""
        return (
            float(np.median([one.after_s for one in self.detected]))
            if self.detected
            else float("nan")
        )


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
