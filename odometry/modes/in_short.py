"""What was found of the modes of a run in three lines: what is in force, how sure, what to do."""

from collections.abc import Mapping

import numpy as np

from odometry.modes.doubts import LEAST_DOUBT, Doubt, doubts
from odometry.modes.followed import Followed
from odometry.modes.mode_set import UNDETERMINED
from odometry.modes.not_checked import not_checked
from odometry.modes.words import FEW, LEAST_SHARE, SCALE, percent, scale_word, signal_of

MOSTLY = 0.5  # of the time
SLIGHTLY, _ = SCALE[0]  # standard deviations below which identification may be what is off
CHECKS = {
    "forward speed": "the measured speed (its unit and stamps) and the treads (a wheel scaled)",
    "position": "the poses (late stamps, jumps, where the antenna sits)",
    "heading": "the heading of the poses (late stamps, jumps, an offset)",
    "yaw rate": "the gyroscope (unit, scale, bias, a value that is held) and the treads (left and "
    "right exchanged, a wheel scaled)",
}


def in_short(followed: Followed) -> tuple[str, str, str]:
    """What is in force, how sure that is, and what to do."""
    return _in_force(followed), _how_sure(followed), _to_do(followed)


def _in_force(followed: Followed) -> str:
    track = followed.last_track
    answers = followed.answers(track)
    named = np.flatnonzero(answers != UNDETERMINED)
    if not len(named):
        return "nothing that the motion tells: undetermined all the time."
    last = str(answers[named[-1]])
    others = np.flatnonzero(answers[named] != last)
    since = named[others[-1] + 1] if len(others) else named[0]
    until = named[-1]
    when = f"at the end, answered since {track.stamps_s[since]:.1f} s"
    if until < len(answers) - 1:
        when = f"answered last, at {track.stamps_s[until]:.1f} s; undetermined after that"
    return f"{last} {when}; of the time {_shares_said(followed.shares(track))}."


def _shares_said(shares: Mapping[str, float]) -> str:
    said = [f"{name} {percent(of)}" for name, of in shares.items() if of >= LEAST_SHARE]
    others = len(said) - FEW
    if others > 0:
        said[FEW:] = ["1 other" if others == 1 else f"{others} others"]
    return ", ".join(said)


def _how_sure(followed: Followed) -> str:
    """How well modes fit, and whether nothing checked the scale of the gyroscope."""
    said = _fit_said(followed)
    if followed.signals.heading_check is None:
        said += "".join(f" Not checked: {what}." for what in not_checked(followed)[:1])
    return said


def _fit_said(followed: Followed) -> str:
    named = f"a mode is named from a probability of {percent(followed.config.sure)} on"
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
        return f"{named}, and a mode of the set fits all along."
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
            "look at the innovations of each signal (innovations.png): where it keeps its sign, "
            "identify the modes again on longer runs that are driven as this one was."
        )
    if followed.shares(followed.last_track).get(UNDETERMINED, 0.0) > MOSTLY:
        return "drive turns of several radii to both sides: on straights modes are alike."
    return "nothing; where the answer is undetermined, take the one before it."


def _first_doubt(followed: Followed) -> Doubt | None:
    """The doubt that holds longest, where it holds for longer than no mode fits."""
    track = followed.motion
    whole_s = max(float(np.ptp(track.stamps_s)), 1e-12)
    misfit = sum(one.to_s - one.from_s for one in followed.misfits) / whole_s
    return next((one for one in doubts(followed) if one.share > misfit), None)
