"""One tread that stands, or keeps one value, while its motion goes on."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import relation
from odometry.checks.treads.slow_speeds import or_slow, slow_speeds_zero
from odometry.checks.turns.measured_turns import STUCK_S, measured_turns
from odometry.windows.recorded.spans import constant_spans, runs_of

STANDING = 0.01  # of the ordinary fastest speed: noise of a tread that stands
# Share of the rows with a slower speed that is not near zero, where slower ones read as the kept
# one, and what is near zero as a share of it.
RARE, ZERO = 0.01, 0.1
BOTH = 0.8  # share of such a time in which both treads keep their values: a held command does so
PIVOTS = 0.8  # share of the turns that the other tread explains where the robot turns about one
LEAST_ROWS = 20  # windows
SHOWN = 3  # times of which begin and end are printed


def stuck_encoders(evidence: Evidence) -> Iterator[Finding]:
    """A tread that keeps one value while gyroscope or poses say that it goes on differently."""
    dead = [_is_dead(evidence, side) for side in range(2)]
    spans = [
        []
        if dead[side]
        else [s for k in _kept(evidence, side) for s in _contradicted(evidence, k, side)]
        for side in range(2)
    ]
    for side, name in enumerate(("v_left", "v_right")):
        if dead[side]:
            yield _dead(evidence, name)
        elif spans[side]:
            yield _stuck(evidence, name, spans[side], both=all(spans))


def _stuck(
    evidence: Evidence, name: str, spans: list[tuple[float, float]], *, both: bool
) -> Finding:
    """A tread that is lost at times; `both` where the other one is as well, at other times."""
    row = int(np.searchsorted(evidence.stamps_s, spans[0][0]))
    values = evidence.speeds_m_s[:, ("v_left", "v_right").index(name)]
    in_run_time = [(evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans]
    times = ", ".join(f"from {b:.1f} to {e:.1f} s" for b, e in in_run_time[:SHOWN])
    times += " ..." if len(spans) > SHOWN else ""
    or_slowly = ""
    if np.abs(values[row]) < STANDING * evidence.fastest_m_s:
        if (slow := slow_speeds_zero(evidence, name, spans, times)) is not None:
            return slow
        or_slowly = or_slow(evidence, name, spans) or _or_stands(evidence, name, spans)
    limited = _or_limited(values, float(values[row]), or_slowly, both=both)
    return Finding(
        "stuck_encoder",
        Level.WARNING,
        f"{name} stays at {values[row]:.4g} m/s {times} of run time, "
        "while gyroscope or poses say that this tread goes on differently",
        f"{'Either the' if limited else 'The'} encoder of the {name.removeprefix('v_')} tread is "
        f"stuck or was lost{limited}",
        "Cut the recording with --from and --to, or leave it out",
        tuple(in_run_time),
    )


def _or_stands(evidence: Evidence, name: str, spans: list[tuple[float, float]]) -> str:
    """What else it may be where the other tread alone explains the turns of each such time."""
    side = ("v_left", "v_right").index(name)
    sensors = list(measured_turns(evidence))
    if not all(any(of.pivots(span, side) for of in sensors) for span in spans):
        return ""
    return (
        "this tread is stationary or slow, and slow speeds read zero: the other one alone explains "
        "the turns of these times"
    )


def _or_limited(values: FloatArray, kept: float, or_slowly: str, *, both: bool) -> str:
    """What else keeps a value: a limit of the speeds that are read."""
    size, largest_m_s = np.abs(values), float(np.abs(values).max())
    slower = (size > ZERO * abs(kept)) & (size < (1 - STANDING) * abs(kept))
    moves = STANDING * largest_m_s < abs(kept) < largest_m_s
    if moves and slower.mean() < RARE:
        other = f"it reads no speed between 0 and {abs(kept):.4g} m/s, and slower ones as this one"
    elif kept in (values.max(), values.min()) and kept != 0:
        other = f"it is clipped at {kept:.4g} m/s, its largest value"
    elif or_slowly:
        other = or_slowly
    elif both and abs(kept) < STANDING * largest_m_s:
        other = "slow speeds read zero (a dead band, play of the gear): both treads have such times"
    else:
        return ""
    return f"; or {other}. These cannot be distinguished"


def _is_dead(evidence: Evidence, side: int) -> bool:
    """Whether a tread stands all the time, and what is measured does not follow the other alone."""
    speeds = np.abs(evidence.speeds_m_s)
    if np.quantile(speeds[:, side], 0.99) > STANDING * evidence.fastest_m_s:
        return False
    for measured in measured_turns(evidence):
        of_other = (measured.motion.right_m, measured.motion.left_m)[side]
        fit = relation(measured.target, of_other)
        if fit is not None and fit.measured >= LEAST_ROWS and fit.explained < PIVOTS:
            return True
    return False


def _dead(evidence: Evidence, name: str) -> Finding:
    tread, other = (("left", "right"), ("right", "left"))[name == "v_right"]
    return Finding(
        "stuck_encoder",
        Level.WARNING,
        f"{name} stays near 0 m/s all the time, while v_{other} reaches "
        f"{evidence.fastest_m_s:.3g} m/s and the robot does not turn about the {tread} tread",
        f"Either the encoder of the {tread} tread is stuck or was lost, or its column was not "
        "filled; or it was never fast enough to be read",
        "Record again with both encoders",
        ((evidence.run_time_s(evidence.stamps_s[0]), evidence.run_time_s(evidence.stamps_s[-1])),),
    )


def _kept(evidence: Evidence, side: int) -> list[FloatArray]:
    """Times in which one tread stands or keeps one value, and the other does not keep a speed.

    Where the other keeps its values as well, at other times, the columns hold commands.
    """
    stamps_s, speeds = evidence.stamps_s, evidence.speeds_m_s
    stands = np.abs(speeds[:, side]) < STANDING * evidence.fastest_m_s
    rows = runs_of(stands)
    standing = np.stack([stamps_s[rows[:, 0]], stamps_s[rows[:, 1] - 1]], axis=-1)
    constant = constant_spans(stamps_s, np.where(stands, np.nan, speeds[:, side]), STUCK_S)
    other_stands = np.abs(speeds[:, 1 - side]) < STANDING * evidence.fastest_m_s
    of_other = constant_spans(
        stamps_s, np.where(other_stands, np.nan, speeds[:, 1 - side]), STUCK_S
    )
    both = constant_spans(stamps_s, np.where(other_stands[:, None], np.nan, speeds), 0.0)
    if np.ptp(of_other, axis=1).sum() > np.ptp(constant, axis=1).max(initial=0.0):
        constant = constant[:0]
    return [
        span
        for span in (*standing[np.ptp(standing, axis=1) >= STUCK_S], *constant)
        if not _are_both(span, both) and not _is_a_gap(evidence, span)
    ]


def _are_both(span: FloatArray, both: FloatArray) -> bool:
    overlaps = np.minimum(both[:, 1], span[1]) - np.maximum(both[:, 0], span[0])
    return bool(np.max(overlaps, initial=0.0) > BOTH * (span[1] - span[0]))


def _is_a_gap(evidence: Evidence, span: FloatArray) -> bool:
    """Whether most of its rows are lost, or one is held for long."""
    rows = np.diff(np.searchsorted(evidence.stamps_s, span))[0]
    return bool(rows * evidence.period_s < 0.5 * (span[1] - span[0]))


def _contradicted(evidence: Evidence, span: FloatArray, side: int) -> list[tuple[float, float]]:
    """From when to when what a sensor measures is far from what the treads say; [] where never.

    Where the gyroscope and the poses part, one of these is at fault. A tread about which the robot
    turns stands: elsewhere, or all the time, treads have another scale.
    """
    sensors = list(measured_turns(evidence))
    for measured in sensors:
        found = measured.contradicts(evidence.fastest_m_s, span, side)
        if found is None:
            continue
        others = (sensor for sensor in sensors if sensor is not measured)
        agrees = any(other.agrees(evidence.fastest_m_s, found, side) for other in others)
        pivots = _is_read(evidence, found, side) and measured.pivots(found, side)
        return [] if agrees or pivots else [found]
    return []


def _is_read(evidence: Evidence, span: tuple[float, float], side: int) -> bool:
    """Whether the values of a tread that stands differ, as those of an encoder that works."""
    inside = (evidence.stamps_s >= span[0]) & (evidence.stamps_s <= span[1])
    return bool(np.ptp(evidence.speeds_m_s[inside, side]) > 0)
