"""What was found of the modes of a run: three lines in short, and sentences."""

from collections.abc import Iterator, Mapping

import numpy as np

from odometry.modes.follow.detection import Detection, Score
from odometry.modes.follow.followed import (
    MOTION,
    MOTION_AND_CAMERA,
    MOTION_AND_FEEL,
    Followed,
    Misfit,
)
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.models.mode_set import NO_MODES, UNDETERMINED
from odometry.modes.show.camera_words import camera_words
from odometry.modes.show.doubt import Doubt
from odometry.modes.show.doubts import LEAST_DOUBT, doubts, not_checked

WHOSE = {MOTION: "", MOTION_AND_FEEL: " with feel", MOTION_AND_CAMERA: " with camera"}
FEW = 4  # stretches, or answers, that are given one by one
LEAST_SHARE = 0.005  # less is not reported
LEAST_OPEN = 0.1  # of the undetermined time: sets of modes that are named
SIGNALS = {
    "velocity": ("forward speed", "yaw rate"),
    "traction": ("position", "position", "heading", "yaw rate"),
}
SCALE = ((3.0, "slightly off"), (6.0, "clearly off"), (np.inf, "far off"))

MOSTLY = 0.5  # of the time
SLIGHTLY, _ = SCALE[0]  # standard deviations below which identification may be what is off
CHECKS = {
    "forward speed": "the measured speed (its unit and stamps) and the treads (a wheel scaled)",
    "position": "the poses (late stamps, jumps, where the antenna sits)",
    "heading": "the heading of the poses (late stamps, jumps, an offset)",
    "yaw rate": "the gyroscope (unit, scale, bias, a value that is held) and the treads (left and "
    "right exchanged, a wheel scaled)",
}


def sentences(followed: Followed) -> tuple[str, ...]:
    """The answer, then what is to be known of it; the first is for a hurried reader."""
    return (answer_words(followed, followed.motion), *_more(followed))


def answer_words(followed: Followed, track: ModeTrack) -> str:
    """How soon and how well modes were detected; where the run names none, what the answers are."""
    score = followed.score(track)
    if not score.detections:
        return f"{_shares_said(followed.shares(track), ' of the time')}."
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


def _more(followed: Followed) -> Iterator[str]:
    yield from _open_words(followed)
    for one in doubts(followed):
        yield f"No mode is named where {one.reason}."
    if followed.with_feel is not None:
        yield f"With feel: {answer_words(followed, followed.with_feel)}"
    if followed.with_camera is not None:
        yield f"With the camera: {answer_words(followed, followed.with_camera)}"
    for name, track in followed.tracks.items():
        count = followed.score(track).false_switches
        if count:
            times = "once" if count == 1 else f"{count} times"
            whose = WHOSE[name]
            yield f"The answer{whose} turned to a wrong mode {times}."
    if followed.foreign_labels:
        yield (
            f"The run names {', '.join(followed.foreign_labels)}, which is no mode of the set: a "
            "mode that is named there is wrong, and the shares leave it out."
        )
    yield from camera_words(followed)


def _open_words(followed: Followed) -> Iterator[str]:
    """Between which modes the answer by motion lies while it is undetermined."""
    sets = followed.left_open(followed.motion)
    said = [
        f"{' or '.join(names)} for {percent(share)} of that time"
        for names, share in list(sets.items())[:FEW]
        if len(names) < len(followed.mode_set.names) and share >= LEAST_OPEN
    ]
    if said:
        yield f"While undetermined, the candidates are {', '.join(said)}."


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
    count = f"{len(score.detected)} of {len(score.detections)} stretches were detected"
    if not score.detected:
        return f"{count}; wrong {percent(score.wrong_of_all)} of all the time."
    return (
        f"{count}, after {score.median_after_s:.1f} s in the median; right "
        f"{percent(score.right)} of the time after that, wrong {percent(score.wrong)}, "
        f"undetermined {percent(score.undetermined)}; wrong {percent(score.wrong_of_all)} of all "
        "the time."
    )


def in_short(followed: Followed) -> tuple[str, str, str]:
    """What is in force, how sure that is, and what to do."""
    return _in_force(followed), _how_sure(followed), _to_do(followed)


def _in_force(followed: Followed) -> str:
    track = followed.last_track
    answers = followed.answers(track)[:-1]  # the last stamp lasts for no time
    named = np.flatnonzero(answers != UNDETERMINED)
    if not len(named):
        return "nothing that the motion distinguishes: undetermined all the time."
    last = str(answers[named[-1]])
    others = np.flatnonzero(answers[named] != last)
    since = named[others[-1] + 1] if len(others) else named[0]
    until = named[-1]
    when = f"at the end, since {track.stamps_s[since]:.1f} s"
    if until < len(answers) - 1:
        when = f"at last, until {track.stamps_s[until]:.1f} s; undetermined after that"
    return f"{last} {when}. Shares of the run: {_shares_said(followed.shares(track))}."


def _shares_said(shares: Mapping[str, float], unit: str = "") -> str:
    said = [f"{name} {percent(of)}{unit}" for name, of in shares.items() if of >= LEAST_SHARE]
    others = len(said) - FEW
    if others > 0:
        said[FEW:] = ["1 other" if others == 1 else f"{others} others"]
    return ", ".join(said)


def _how_sure(followed: Followed) -> str:
    """How well modes fit, and what nothing checked."""
    said = [_fit_said(followed), *(f"Not checked: {what}." for what in not_checked(followed))]
    return " ".join(said)


def _fit_said(followed: Followed) -> str:
    sure = f"{100 * followed.config.sure:.12g} %"  # 99.99999 %, not 100 %
    named = f"a mode is named where its probability is {sure} or more"
    doubt = _first_doubt(followed)
    if doubt is not None:
        return f"{named}; {doubt.reason}: there no mode is named."
    if not followed.misfits:
        doubtful = followed.doubtful(followed.last_track)
        if doubtful >= LEAST_DOUBT:
            return (
                f"{named}, and where it fits; {percent(doubtful)} of the time one is as probable "
                "and is not named, because it does not fit well."
            )
        return f"{named}, and some mode of the set fits at every moment."
    worst = max(followed.misfits, key=lambda one: one.to_s - one.from_s)
    more = len(followed.misfits) - 1
    others = f" and in {more} shorter stretch{'es' if more > 1 else ''}" if more else ""
    return (
        f"{named}; no mode fits from {worst.from_s:.1f} s to {worst.to_s:.1f} s{others}: the "
        f"{signal_of(followed, worst)} is {scale_word(worst.sigmas)} that of the nearest mode."
    )


def _to_do(followed: Followed) -> str:
    doubt = _first_doubt(followed)
    if doubt is not None:
        return f"{doubt.remedy}."
    worst = max(followed.misfits, key=lambda one: one.to_s - one.from_s, default=None)
    if worst is not None and worst.sigmas >= SLIGHTLY:
        return (
            f"check {CHECKS[signal_of(followed, worst)]}; if they are right, it drove on what the "
            "set does not hold (a terrain, a slope, a load): record that and identify it with the "
            "others."
        )
    if worst is not None or followed.doubtful(followed.last_track) >= LEAST_DOUBT:
        return (
            "look at the innovations of each signal (innovations.png): if they stay above zero, or "
            "below, identify the modes again on longer runs that are driven as this one was."
        )
    if followed.shares(followed.last_track).get(UNDETERMINED, 0.0) > MOSTLY:
        return "drive turns of several radii to both sides: on straights modes do not differ."
    return "nothing; where the answer is undetermined, take the one before it."


def _first_doubt(followed: Followed) -> Doubt | None:
    """The doubt that holds longest, where it holds for longer than no mode fits."""
    track = followed.motion
    whole_s = max(float(np.ptp(track.stamps_s)), 1e-12)
    misfit = sum(one.to_s - one.from_s for one in followed.misfits) / whole_s
    return next((one for one in doubts(followed) if one.share > misfit), None)
