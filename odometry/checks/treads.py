"""What is odd about single stretches and samples of the tread speeds."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.motion import Motion
from odometry.checks.relation import relation
from odometry.checks.spans import constant_spans, within
from odometry.checks.spikes import spikes

STUCK_S = 2.0
BOTH_STUCK_S = 1.0
COARSE = 0.1  # a step of the readings as a share of the ordinary fastest speed
OTHER_MOVES = 0.05  # of the ordinary fastest speed, by which the other tread changes meanwhile
CONTRADICTED = 5.0  # times the usual residual
LEAST_CHANGES = 30  # of a tread speed, and as a share of the rows: else it is a held command
DROPPED = 0.001  # share of samples that are lost, from which it is a warning
CHANGING = 0.02
SATURATED = 0.05  # share of rows at the very largest value


def treads(evidence: Evidence) -> Iterator[Finding]:
    """Absurd samples, stuck encoders, coarse steps, saturation, missing motion."""
    yield from _counters(evidence)
    yield from _absurd(evidence)
    yield from _stuck(evidence)
    yield from _coarse(evidence)
    yield from _saturated(evidence)
    yield from _dropped(evidence)
    yield from _both_still(evidence)
    yield from _idle(evidence)


def _counters(evidence: Evidence) -> Iterator[Finding]:
    """Columns whose changes, not whose values, are the motion."""
    for motion, target in _targets(evidence):
        rows = [
            np.clip(np.searchsorted(evidence.stamps_s, at_s, side="right") - 1, 0, None)
            for at_s in (motion.start_s, motion.end_s)
        ]
        left, right = (evidence.run.odometry[n] for n in ("v_left", "v_right"))
        changed = relation(target, left[rows[1]] - left[rows[0]], right[rows[1]] - right[rows[0]])
        plain = relation(target, motion.left_m, motion.right_m)
        if changed is None or changed.explained < 0.8:
            continue
        if plain is None or plain.explained < 0.5:
            yield Finding(
                "treads_are_counters",
                Level.WARNING,
                f"changes of v_left and v_right explain {100 * changed.explained:.0f} % of the "
                "motion, their values do not",
                "The columns hold counters: positions or angles of the wheels (accumulated odometer, "
                "encoder ticks), not speeds",
                "Differentiate them by t, and convert to m/s",
            )
            return


def _absurd(evidence: Evidence) -> Iterator[Finding]:
    for name in ("v_left", "v_right"):
        values = evidence.run.odometry[name]
        rows = np.flatnonzero(spikes(values))
        rows = rows[np.abs(values[rows]) > evidence.fastest_m_s]
        if not len(rows):
            continue
        worst = rows[np.argmax(np.abs(values[rows]))]
        travel_m = np.abs(values[rows]) * np.append(np.diff(evidence.stamps_s), 0.0)[rows]
        yield Finding(
            "absurd_speed",
            Level.WARNING,
            f"{len(rows)} samples of {name} jump out and back, up to {values[worst]:.4g} m/s (row "
            f"{evidence.run.odometry.lines[worst]}), where {evidence.fastest_m_s:.3g} m/s is the "
            f"ordinary fastest; they move the odometer by {travel_m.sum():.3g} m",
            "Single corrupt samples (an outlier or spike: a counter that overflowed, a lost byte)",
            "Remove these rows: the speed before them holds meanwhile",
            tuple(
                (evidence.run_time_s(s), evidence.run_time_s(s)) for s in evidence.stamps_s[rows]
            ),
        )


def _stuck(evidence: Evidence) -> Iterator[Finding]:
    """A tread that keeps one value while its motion goes on by gyroscope or poses."""
    for side, name in enumerate(("v_left", "v_right")):
        speeds = evidence.speeds_m_s
        spans = constant_spans(evidence.stamps_s, speeds[:, side], STUCK_S)
        contradicted = [span for span in spans if _contradicted(evidence, span, side)]
        if not contradicted:
            continue
        lasts_s = sum(end_s - begin_s for begin_s, end_s in contradicted)
        row = int(np.searchsorted(evidence.stamps_s, contradicted[0][0]))
        yield Finding(
            "stuck_encoder",
            Level.WARNING,
            f"{name} stays at {speeds[row, side]:.4g} m/s for {lasts_s:.1f} s (from "
            f"{evidence.run_time_s(contradicted[0][0]):.1f} s of run time) while gyroscope or "
            "poses say that this tread goes on differently",
            f"The encoder of the {name.removeprefix('v_')} tread is stuck or was lost",
            "Cut the recording with --from and --to, or leave it out",
            tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in contradicted),
        )


def _contradicted(evidence: Evidence, span: FloatArray, side: int) -> bool:
    """Whether turns or the way along in a span are far from what the treads say elsewhere.

    Where both treads keep their values, a command that is held looks alike: that is no evidence.
    """
    begin_s, end_s = span
    rows = within(evidence.stamps_s, span[None])
    if np.ptp(evidence.speeds_m_s[rows, 1 - side]) < OTHER_MOVES * evidence.fastest_m_s:
        return False
    for motion, target in _targets(evidence):
        inside = (motion.start_s >= begin_s) & (motion.end_s <= end_s)
        outside = ~within((motion.start_s + motion.end_s) / 2, span[None])
        if inside.sum() < 2:
            continue
        fit = relation(np.where(outside, target, np.nan), motion.left_m, motion.right_m)
        if fit is None or fit.correlation < 0.8:
            continue
        usual = float(np.median(np.abs(fit.residuals[outside & np.isfinite(target)])))
        size = float(np.quantile(np.abs(target[np.isfinite(target)]), 0.9))
        treads = np.stack([motion.left_m[inside], motion.right_m[inside]], axis=-1)
        here = target[inside] - treads @ fit.coefficients
        if np.nanmedian(np.abs(here)) > max(CONTRADICTED * usual, 0.2 * size):
            return True
    return False


def _targets(evidence: Evidence) -> Iterator[tuple[Motion, FloatArray]]:
    if evidence.yaw_rate is not None:
        yield evidence.uniform, evidence.uniform.gyroscope_rad
    if evidence.yaw_measured:
        yield evidence.motion, evidence.motion.turn_rad
        yield evidence.motion, evidence.forward_m


def _coarse(evidence: Evidence) -> Iterator[Finding]:
    """Readings that come in large steps, from one to the next and back."""
    step = min(filter(None, map(_step, evidence.speeds_m_s.T)), default=0.0)
    if step < COARSE / 4 * evidence.fastest_m_s or step == 0:
        return
    much = step > COARSE * evidence.fastest_m_s
    yield Finding(
        "coarse_speeds",
        Level.WARNING if much else Level.NOTE,
        f"tread speeds come in steps of {step:.3g} m/s, where {evidence.fastest_m_s:.3g} m/s is "
        "the ordinary fastest",
        "Quantisation: speeds from few encoder ticks in a short time, or rounded in the log",
        "Log ticks, or speeds over a longer time or with more digits"
        if much
        else "Nothing to do where slow motion does not matter",
    )


def _step(values: FloatArray) -> float | None:
    """The step of which all changes are multiples; None where there is none, or few changes."""
    changes = np.abs(np.diff(values))
    changes = changes[changes > 1e-9]
    if len(changes) < max(LEAST_CHANGES, CHANGING * len(values)):
        return None
    step = float(np.quantile(changes, 0.02))
    counts = changes / step
    single = float(np.mean(np.abs(counts - 1) < 0.05))
    whole = float(np.mean(np.abs(counts - np.round(counts)) < 0.05 + 0.01 * counts))
    return step if whole > 0.95 and single > 0.2 else None


def _saturated(evidence: Evidence) -> Iterator[Finding]:
    for side, name in enumerate(("v_left", "v_right")):
        values = evidence.speeds_m_s[:, side]
        largest = float(np.abs(values).max())
        if largest <= 0:
            continue
        at_top = np.abs(np.abs(values) - largest) < 1e-9
        changes = int(np.sum(np.diff(at_top.astype(np.int8)) == 1))
        lively = len(np.unique(np.round(np.abs(values[~at_top]), 4))) > 50
        both = bool((values[at_top] > 0).any() and (values[at_top] < 0).any())
        if at_top.mean() > SATURATED and changes >= 3 and both and lively:
            yield Finding(
                "saturated_speed",
                Level.WARNING,
                f"{100 * at_top.mean():.0f} % of {name} are exactly +-{largest:.4g} m/s, reached "
                f"{changes} times",
                "The speed saturates: it is clipped at a limit of the sensor or the log, or it is "
                "the command and not what the wheels did",
                "Log measured wheel speeds over their whole range",
            )


def _dropped(evidence: Evidence) -> Iterator[Finding]:
    """Single zeros amid motion."""
    counts, spans = {}, []
    for name in ("v_left", "v_right"):
        values = evidence.run.odometry[name]
        zero = (np.abs(values[1:-1]) < 1e-9) & (np.abs(values[:-2]) > 0.1 * evidence.fastest_m_s)
        zero &= np.abs(values[2:]) > 0.1 * evidence.fastest_m_s
        zero &= np.sign(values[:-2]) == np.sign(values[2:])
        counts[name] = int(zero.sum())
        spans += [evidence.run_time_s(s) for s in evidence.stamps_s[1:-1][zero]]
    total = sum(counts.values())
    if total:
        share = total / (2 * len(evidence.stamps_s))
        yield Finding(
            "dropped_speeds",
            Level.WARNING if total > 5 and share > DROPPED else Level.NOTE,
            f"{total} samples of tread speed are zero between two of full speed (v_left "
            f"{counts['v_left']}, v_right {counts['v_right']})",
            "Samples drop out: zeros are written where a message was lost",
            "Remove these rows: the speed before them holds meanwhile",
            tuple((span, span) for span in sorted(spans)),
        )


def _both_still(evidence: Evidence) -> Iterator[Finding]:
    """Both treads keep their values exactly while gyroscope or poses say that motion changes."""
    spans = constant_spans(evidence.stamps_s, evidence.speeds_m_s, BOTH_STUCK_S)
    odd = [span for span in spans if _differs(evidence, span)]
    if not odd:
        return
    lasts_s = sum(end_s - begin_s for begin_s, end_s in odd)
    row = int(np.searchsorted(evidence.stamps_s, odd[0][0]))
    left, right = evidence.speeds_m_s[row]
    yield Finding(
        "treads_frozen",
        Level.WARNING,
        f"both treads stay at ({left:.3g}, {right:.3g}) m/s for {lasts_s:.1f} s (first at "
        f"{evidence.run_time_s(odd[0][0]):.1f} s) while gyroscope or poses say that the robot moves "
        "differently",
        "Odometry is lost: the log repeats its last value or zeros (a motor driver or bus that "
        "stopped); or the robot was pushed, carried or slid",
        "Cut the recording with --from and --to",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd),
    )


def _differs(evidence: Evidence, span: FloatArray) -> bool:
    """Whether the measured motion in a span changes, or differs from that of the held speeds."""
    for motion, target in _targets(evidence):
        inside = (motion.start_s >= span[0]) & (motion.end_s <= span[1]) & np.isfinite(target)
        known = np.isfinite(target)
        if inside.sum() < 1:
            continue
        fit = relation(np.where(inside, np.nan, target), motion.left_m, motion.right_m)
        if fit is None or fit.explained < 0.7:
            continue
        size = float(np.quantile(np.abs(target[known]), 0.9))
        usual = float(np.median(np.abs(fit.residuals[known & ~inside])))
        off = np.abs(fit.residuals[inside])
        if float(np.median(off)) > max(2 * CONTRADICTED * usual, 0.3 * size):
            return True
    return False


def _idle(evidence: Evidence) -> Iterator[Finding]:
    """Treads that do not move."""
    if evidence.fastest_m_s > 1e-3:
        return
    moved = ""
    if evidence.positions_measured is not None:
        moved = f" while poses move by {float(np.nansum(evidence.motion.distance_m)):.3g} m"
    yield Finding(
        "treads_still",
        Level.WARNING,
        f"the fastest tread speed is {evidence.fastest_m_s:.3g} m/s{moved}",
        "The robot was stationary, carried or pushed, or the columns are empty or in km/s",
        "Record a drive",
    )
