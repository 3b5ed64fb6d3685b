"""Single samples of the tread speeds that are none: outliers, zeros and placeholders."""

from collections.abc import Callable, Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.findings.undo import TREADS, changed, in_turn
from odometry.checks.statistics.outliers import peaks, spikes
from odometry.checks.treads.slow_speeds import EDGE, least_read_m_s
from odometry.estimation.speed_step import step_of, tick_of
from odometry.windows.recorded.spans import runs_of

DROPPED = 0.001  # share of samples that are lost, from which it is a warning
# Share of the speeds in motion that are slower than those beside zeros: of lost messages a half.
FEW, SLOWEST = 20, 0.15
PEAKS = 0.004  # share of the samples; 0.0003 of real recordings
OR_SLOW = "Either slow speeds read zero (a dead band: none slower is read), or samples"
OR_SLOWEST = "Either it is the slowest speed that is read (slower ones read zero), or a"
STOP_S = 0.3  # no robot stops and is at full speed again within
STEPS = 1.5  # of coarse readings, above which a speed does not round to zero
LEAST_SAME, SAME = 8, 0.5  # rows of one value, their share of all that are alone and of that value


def tread_samples(evidence: Evidence) -> Iterator[Finding]:
    """Absurd samples, zeros where one was lost, and values that stand for nothing."""
    yield from _absurd(evidence)
    yield from _dropped(evidence)
    yield from _placeholders(evidence)


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
            f"{name} jumps out and back in {counted(len(rows), 'sample')}, up to "
            f"{values[worst]:.4g} m/s (row {evidence.run.odometry.lines[worst]}), where "
            f"{evidence.fastest_m_s:.3g} m/s is the ordinary fastest; this moves the odometer by "
            f"{travel_m.sum():.3g} m",
            "Single corrupt samples (an outlier or spike: a counter that overflowed, a lost byte, "
            "a placeholder for what was not measured)",
            "Remove these rows: the speed before them holds meanwhile",
            tuple(
                (evidence.run_time_s(s), evidence.run_time_s(s)) for s in evidence.stamps_s[rows]
            ),
        )


def peaks_often(evidence: Evidence) -> str:
    """Words where single samples often go out and back as no robot drives; "" elsewhere."""
    odometry = evidence.run.odometry
    counts = [int(peaks(odometry[name], evidence.fastest_m_s).sum()) for name in TREADS]
    if evidence.period_s > STOP_S or sum(counts) < max(FEW, PEAKS * 2 * len(odometry)):
        return ""
    return (
        f"tread speeds go out and back by more than half of the ordinary fastest speed in "
        f"{counted(sum(counts), 'single sample')} (v_left {counts[0]}, v_right {counts[1]})"
    )


def _dropped(evidence: Evidence) -> Iterator[Finding]:
    """Single zeros amid motion; where only the slowest speeds are lost, no message was."""
    counts, spans, shares, mends, slow = {}, [], [], [], []
    for name in TREADS:
        zero, least_m_s = _zeros(evidence, name)
        before = np.abs(evidence.run.odometry[name][zero - 1])
        moving = np.abs(evidence.speeds_m_s[:, TREADS.index(name)])
        slowest_m_s = least_read_m_s(moving, evidence.fastest_m_s)
        slow += (before < EDGE * slowest_m_s).tolist()
        moving = np.sort(moving[moving > least_m_s])
        shares += (np.searchsorted(moving, before) / max(len(moving), 1)).tolist()
        counts[name] = len(zero)
        spans += [evidence.run_time_s(s) for s in evidence.stamps_s[zero]]
        mends.append(changed("odometry", name, _held_in(_short_zeros(evidence, name))))
    total = sum(counts.values())
    if total and not (total > FEW and np.median(shares) < SLOWEST):
        share = total / (2 * len(evidence.stamps_s))
        either = OR_SLOW if np.median(slow) > 0 else ""
        yield Finding(
            "dropped_speeds",
            Level.WARNING if total > 5 and share > DROPPED else Level.NOTE,
            f"tread speeds are zero between two of full speed in {counted(total, 'sample')} "
            f"(v_left {counts['v_left']}, v_right {counts['v_right']})",
            f"{either or 'Samples'} drop out: zeros are written where a message was lost; or rows "
            "are out of order, or small speeds read too large beside a tread that stands",
            "Remove these rows: the speed before them holds meanwhile",
            tuple((span, span) for span in sorted(spans)),
            mend=in_turn(*mends),
        )


def _zeros(evidence: Evidence, name: str) -> tuple[IntArray, float]:
    """Rows in which a tread is zero alone between two speeds of one sign, and their least size."""
    values = evidence.run.odometry[name]
    step_m_s = step_of(values)
    least_m_s = max(0.1 * evidence.fastest_m_s, STEPS * (step_m_s or 0.0))
    moved = np.abs(values) > least_m_s
    zero = (np.abs(values[1:-1]) < 1e-9) & moved[:-2] & moved[2:]
    if step_m_s is None:
        zero &= ~_is_less_than_a_tick(values, evidence.stamps_s)
    zero &= np.sign(values[:-2]) == np.sign(values[2:])
    zero &= np.diff(evidence.stamps_s)[1:] < STOP_S
    return np.flatnonzero(zero) + 1, least_m_s


def _is_less_than_a_tick(values: FloatArray, stamps_s: FloatArray) -> BoolArray:
    """Whether a row (N - 2,) between two others may hold no tick, at the speeds of these.

    Where stamps are uneven a short row holds none at a speed that is many ticks in a long one. Of
    the ticks of a row one may be of the way before it.
    """
    periods_s = np.diff(stamps_s, prepend=stamps_s[0])
    tick_m = tick_of(values, periods_s)
    if tick_m is None:
        return np.zeros(len(values) - 2, bool)
    least_m_s = (np.abs(values[1:]) * periods_s[1:] - tick_m) / periods_s[1:]
    least_m_s = np.insert(least_m_s, 0, 0.0)
    return np.minimum(least_m_s[:-2], least_m_s[2:]) * periods_s[1:-1] <= tick_m


def _short_zeros(evidence: Evidence, name: str) -> IntArray:
    """First rows, and rows after the last ones (K, 2), of zeros that are shorter than a stop."""
    values, stamps_s = evidence.run.odometry[name], evidence.stamps_s
    runs = runs_of(np.abs(values) < 1e-9)
    runs = runs[(runs[:, 0] > 0) & (runs[:, 1] < len(values))]
    short = stamps_s[runs[:, 1]] - stamps_s[runs[:, 0] - 1] < STOP_S
    return np.asarray(runs[short])


def _held_in(runs: IntArray) -> Callable[[FloatArray], FloatArray]:
    """The value before each of the rows (K, 2) in place of all of them."""

    def held(values: FloatArray) -> FloatArray:
        values = values.copy()
        for first, end in runs:
            values[first:end] = values[first - 1]
        return values

    return held


def _placeholders(evidence: Evidence) -> Iterator[Finding]:
    """One exact value, not zero, that comes for single rows amid others far from it."""
    stamps_s, seen, spans, slow = evidence.stamps_s, [], [], True
    for name in TREADS:
        values = evidence.run.odometry[name]
        least_m_s = max(0.1 * evidence.fastest_m_s, STEPS * (step_of(values) or 0.0))
        before, here, after = values[:-2], values[1:-1], values[2:]
        away = np.minimum(np.abs(here - before), np.abs(here - after))
        alone = (away > least_m_s) & (np.abs(after - before) < away / 2) & (np.abs(here) > 1e-9)
        found, counts = np.unique(here[alone], return_counts=True)
        if not len(found) or counts.max() < max(LEAST_SAME, SAME * alone.sum()):
            continue
        value = found[np.argmax(counts)]
        if counts.max() < SAME * np.sum(values == value):
            continue  # a speed that lasts elsewhere
        rows = np.flatnonzero(alone & (here == value)) + 1
        slow &= abs(value) < EDGE * least_read_m_s(np.abs(values), evidence.fastest_m_s)
        seen.append(f"{name} is {value:.6g} m/s in {counted(len(rows), 'row')}")
        spans += [(evidence.run_time_s(s),) * 2 for s in stamps_s[rows]]
    if seen:
        yield Finding(
            "placeholder_speeds",
            Level.WARNING,
            f"{' and '.join(seen)}, each time alone amid other speeds",
            f"{OR_SLOWEST if slow else 'A'} placeholder is written where nothing was measured",
            "Remove these rows: the speed before them holds meanwhile",
            tuple(sorted(spans)),
        )
