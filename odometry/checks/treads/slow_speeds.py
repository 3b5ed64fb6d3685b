"""One tread whose slow speeds read zero: it seems lost where the robot drives slowly."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.turns.measured_turns import measured_turns
from odometry.windows.recorded.spans import runs_of, touched

STANDING = 0.01  # of the ordinary fastest speed: noise of a tread that stands
MOSTLY = 0.75  # share of the windows of such times in which the tread is slow
LEAST = 0.01  # of the values that are not zero: the slowest that is read
# Of the ordinary fastest speed: where the slowest reading is between these, slower speeds are none.
BAND = (0.1, 0.6)
# Values that are at most so many times the slowest, as a share of those that are not zero: a drive
# that is seldom slow has few of them, and its slowest reading says nothing of slower ones.
EDGE, OFTEN = 1.5, 0.05
# Three quarters of the windows were below 0.22 of the ordinary fastest speed, or 1.07 times the
# slowest reading, in 14 of 15 simulated drives in which slow speeds read zero. Of 24 encoders that
# were lost they reached 0.26, and 4 times the slowest reading; of one in a real drive 0.217.
SLOW, ABOUT = 0.22, 1.2
# Times the slowest reading, up to which neither is sure: 1.2 and 1.3 of two real drives whose slow
# speeds were made zero, 1.8 and more of 55 encoders that were lost.
NEARLY = 1.5
# Of the ordinary fastest speed, that a tread reads beside zeros to which it slows and from which it
# starts: below 0.1 at each end of three such times of dead zones in real drives, above at one end
# of 26 of 27 encoders that were lost.
QUIET = 0.1
# Share of the rows in which the other tread moves, and this one reads zero outside these times as
# well: 0.075 and more of ten dead zones and least readings of real drives, 0.027 and less of 53
# encoders that were lost for a time, and 0.059 of one.
ELSEWHERE, MOVING = 0.05, 0.1  # of the ordinary fastest speed
Spans = list[tuple[float, float]]


def slow_speeds_zero(evidence: Evidence, name: str, spans: Spans, times: str) -> Finding | None:
    """A tread that reads zero in spans of stamps, at speeds that it reads nowhere; else None.

    An encoder that is lost goes on to be lost where the robot drives fast.
    """
    side = ("v_left", "v_right").index(name)
    values, speed_m_s = np.abs(evidence.speeds_m_s[:, side]), _speed_m_s(evidence, spans, side)
    least_m_s = least_read_m_s(values, evidence.fastest_m_s)
    if least_m_s > BAND[1] * evidence.fastest_m_s or speed_m_s > ABOUT * least_m_s:
        return None
    return Finding(
        "slow_speeds_zero",
        Level.WARNING,
        f"{name} reads zero {times} of run time, where gyroscope or poses say that this tread "
        f"moves by up to {speed_m_s:.2g} m/s in most of it, and the fastest are "
        f"{evidence.fastest_m_s:.2g} m/s",
        f"Slow speeds of the {name.removeprefix('v_')} tread read zero (a dead band, a minimum "
        f"reading, play of the gear): it reads none between 0 and {least_m_s:.2g} m/s; or its "
        "encoder was stuck or lost at these times, which were slow by chance",
        "Turn that wheel slowly by hand and look what it reads; leave these times out",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans),
    )


def or_slow(evidence: Evidence, name: str, spans: Spans) -> str:
    """What else it may be where a tread reads zero, and moves slowly in most of these spans.

    Or at about the slowest speed that it reads anywhere, or nobody knows how fast; or where it
    often reads zero elsewhere, as no encoder does that was lost for these times alone.
    """
    side, fastest_m_s = ("v_left", "v_right").index(name), evidence.fastest_m_s
    speed_m_s = _speed_m_s(evidence, spans, side)
    least_m_s = least_read_m_s(np.abs(evidence.speeds_m_s[:, side]), fastest_m_s)
    if speed_m_s <= SLOW * fastest_m_s:
        moves = f"it moves by up to {speed_m_s:.2g} m/s in most of these times"
    elif all(_slows_to_zero(evidence, span, side) for span in spans):
        moves = "it slows down to zero, and starts from zero, as a tread that stops"
    elif least_m_s > 0 and (speed_m_s < NEARLY * least_m_s or not np.isfinite(speed_m_s)):
        moves = f"it reads none between 0 and {least_m_s:.2g} m/s"
    elif (share := _zero_elsewhere(evidence, spans, side)) > ELSEWHERE:
        moves = (
            f"it reads zero at other times as well, in {100 * share:.0f} % of the rows in which "
            "the other one moves"
        )
    else:
        return ""
    return f"slow speeds read zero (a dead band, play of the gear): {moves}"


def _zero_elsewhere(evidence: Evidence, spans: Spans, side: int) -> float:
    """Share of the rows with the other tread in motion that read zero, but for zeros of spans."""
    stamps_s, sizes = evidence.stamps_s, np.abs(evidence.speeds_m_s) / evidence.fastest_m_s
    zero, moving = sizes[:, side] < STANDING, sizes[:, 1 - side] > MOVING
    runs = runs_of(zero)
    here = touched(np.array(spans), stamps_s[runs[:, 0]], stamps_s[runs[:, 1] - 1])
    for first, end in runs[here]:
        moving[first:end] = False
    return float(np.mean(zero[moving])) if moving.any() else 0.0


def _slows_to_zero(evidence: Evidence, span_s: tuple[float, float], side: int) -> bool:
    """Whether a tread reads slow speeds beside the zeros amid a span of stamps.

    An encoder that is lost leaves a speed, or comes back to one, wherever the robot drives.
    """
    values = np.abs(evidence.speeds_m_s[:, side])
    read = np.flatnonzero(values > STANDING * evidence.fastest_m_s)
    after = int(np.searchsorted(evidence.stamps_s[read], float(np.mean(span_s))))
    beside = values[read[max(after - 1, 0) : after + 1]]
    return bool(np.all(beside < QUIET * evidence.fastest_m_s))


def least_read_m_s(values: FloatArray, fastest_m_s: float) -> float:
    """The slowest reading of speeds (N,) without sign, where slower ones read zero; else 0."""
    read = values[values != 0]
    if not len(read):
        return 0.0
    least = float(np.quantile(read, LEAST))
    often = np.mean(read < EDGE * least) > OFTEN
    return least if often and least > BAND[0] * fastest_m_s else 0.0


def _speed_m_s(evidence: Evidence, spans: Spans, side: int) -> float:
    """Speed below which one tread is in most of some spans; infinite where it is not known.

    By the first sensor of turns that was read in them.
    """
    for measured in measured_turns(evidence):
        found = measured.speeds_m_s(evidence.fastest_m_s, spans, side)
        if found is not None and len(found):
            return float(np.quantile(np.abs(found), MOSTLY))
    return np.inf
