"""What was found of the modes of a run in sentences."""

from collections.abc import Iterator

import numpy as np

from odometry.modes.detection import Detection
from odometry.modes.doubts import doubts
from odometry.modes.followed import FELT, MOTION, SIGHTED, Followed
from odometry.modes.misfits import Misfit
from odometry.modes.mode_set import NO_MODES
from odometry.modes.mode_track import ModeTrack
from odometry.modes.not_checked import not_checked
from odometry.modes.score import Score

WHOSE = {MOTION: "", FELT: " with feel", SIGHTED: " with sight"}
FEW = 4  # stretches, or answers, that are given one by one
LEAST_SHARE = 0.005  # less is not reported
LEAST_OPEN = 0.1  # of the undetermined time: sets of modes that are named
SIGNALS = {
    "velocity": ("forward speed", "yaw rate"),
    "traction": ("position", "position", "heading", "yaw rate"),
}
SCALE = ((3.0, "slightly off"), (6.0, "clearly off"), (np.inf, "far off"))


def sentences(followed: Followed) -> tuple[str, ...]:
    """The answer, then what is to be known of it; the first is for a hurried reader."""
    return (answer_words(followed, followed.motion), *_more(followed))


def answer_words(followed: Followed, track: ModeTrack) -> str:
    """How soon and how well modes were detected; where the run names none, what the answers are."""
    score = followed.score(track)
    if not score.detections:
        shares = list(followed.shares(track).items())
        said = [f"{name} {percent(share)} of the time" for name, share in shares[:FEW]]
        others = len(shares) - FEW
        said += [f"{others} others the rest"] if others > 0 else []
        return f"{', '.join(said)}."
    if len(score.detections) > FEW:
        return _together(score)
    said = [_stretch(one, _answered(followed, track, one)) for one in score.detections]
    return f"{'. '.join(said)}."


def signal_of(followed: Followed, misfit: Misfit) -> str:
    """The name of the signal that fits least."""
    return SIGNALS[followed.mode_set.modes.kind][misfit.signal]


def scale_word(sigmas: float) -> str:
    """How far off so many standard deviations are."""
    return next(word for most, word in SCALE if sigmas < most)


def percent(share: float) -> str:
    """A share as text."""
    return "-" if np.isnan(share) else f"{round(100 * share)} %"


def disagreement_words(one: tuple[float, float, str, str]) -> str:
    """Where camera and motion disagree."""
    from_s, to_s, seen, felt = one
    return (
        f"From {from_s:.1f} s to {to_s:.1f} s it is {seen} by the camera and {felt} by the motion."
    )


def _more(followed: Followed) -> Iterator[str]:
    yield from _open_words(followed)
    for one in doubts(followed):
        yield f"No mode is named where {one.reason}."
    for what in not_checked(followed):
        yield f"Not checked: {what}."
    if followed.felt is not None:
        yield f"With feel: {answer_words(followed, followed.felt)}"
    if followed.sighted is not None:
        yield f"With the camera: {answer_words(followed, followed.sighted)}"
    for name, track in followed.tracks.items():
        count = followed.score(track).false_switches
        if count:
            times = "once" if count == 1 else f"{count} times"
            whose = WHOSE[name]
            yield f"The answer{whose} turned to a wrong mode {times}."
    if followed.foreign_labels:
        yield (
            f"The run names {', '.join(followed.foreign_labels)}, which is no mode: the answers "
            "there were not scored."
        )
    if followed.seen:
        argued = followed.disagreements
        yield from map(disagreement_words, argued)
        if not argued:
            lasting_s = followed.config.lasting_s
            yield f"Camera and motion disagree nowhere for {lasting_s:g} s or longer."


def _open_words(followed: Followed) -> Iterator[str]:
    """Between which modes the answer by motion lies while it is undetermined."""
    sets = followed.left_open(followed.motion)
    said = [
        f"{' or '.join(names)} {percent(share)} of that time"
        for names, share in list(sets.items())[:FEW]
        if len(names) < len(followed.mode_set.names) and share >= LEAST_OPEN
    ]
    if said:
        yield f"While undetermined, it is {', '.join(said)}."


def _answered(followed: Followed, track: ModeTrack, one: Detection) -> str:
    """The mode that was answered most in a stretch, where it was, and for how much of it."""
    inside = (track.stamps_s >= one.from_s) & (track.stamps_s <= one.to_s)
    names, counts = np.unique(followed.answers(track)[inside].astype(str), return_counts=True)
    modes = ~np.isin(names, NO_MODES)
    most = int(np.where(modes, counts, 0).argmax())
    share = counts[most] / inside.sum()
    if not modes[most] or share < LEAST_SHARE:
        return ""
    return f"; {names[most]} {percent(share)} of that time"


def _stretch(one: Detection, answered: str) -> str:
    if np.isnan(one.after_s):
        return f"{one.mode}: not detected in {one.to_s - one.from_s:.1f} s{answered}"
    wrong = f", wrong {percent(one.wrong)}" if one.wrong >= LEAST_SHARE else ""
    return (
        f"{one.mode}: detected after {one.after_s:.1f} s; right {percent(one.right)} of the time "
        f"after that{wrong}"
    )


def _together(score: Score) -> str:
    count = f"{len(score.told)} of {len(score.detections)} stretches were detected"
    if not score.told:
        return f"{count}; wrong {percent(score.wrong_of_all)} of all the time."
    return (
        f"{count}, after {score.median_after_s:.1f} s in the median; right "
        f"{percent(score.right)} of the time after that, wrong {percent(score.wrong)}, "
        f"undetermined {percent(score.undetermined)}; wrong {percent(score.wrong_of_all)} of all "
        "the time."
    )
