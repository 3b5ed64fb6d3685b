"""Positions that differ from dead reckoning, within some seconds and as a whole path."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.poses.steps import reckoned, without_window_changes
from odometry.windows.recorded.in_motion import moving_samples

SPAN_S = 10.0
LEAST_M = 1.5  # besides the share of the travel
OF_TRAVEL = 0.1  # by which slip moves a robot aside or back
TIMES = 5.0  # the median over the recording: elsewhere the two agree
HALF = 0.4  # of the travel: this much is no slip of a robot that drives elsewhere as its treads say
STOOD = 0.4  # of the travel: a robot that moves less is stuck
LEAST_SPANS = 20
LONGEST_S = 0.5  # between two poses


@dataclass(frozen=True)
class PositionSpans:
    """Of K spans of ten seconds: stamps, how far both part, were driven by the treads and moved."""

    start_s: FloatArray
    apart_m: FloatArray
    driven_m: FloatArray
    moved_m: FloatArray

    @property
    def drives(self) -> BoolArray:
        """Spans (K,) in which the robot drives."""
        far_m = float(np.quantile(self.driven_m[moving_samples(self.driven_m)], 0.9))
        return np.asarray(self.driven_m > 0.2 * far_m)

    @property
    def much(self) -> BoolArray:
        """Spans (K,) in which they part by far more than slip leaves."""
        return np.asarray(self.drives & (self.apart_m - LEAST_M > HALF * self.driven_m))


def positions_apart_everywhere(evidence: Evidence) -> str:
    """Positions that have little to do with what treads and yaw say."""
    spans = _spans(evidence)
    if spans is None or float(np.mean(spans.much)) < 0.5:
        return ""
    return (
        f"positions end {np.median(spans.apart_m):.2g} m from where treads and yaw lead in "
        f"{SPAN_S:g} s, in which the robot drives {np.median(spans.driven_m):.2g} m"
    )


def positions_apart(evidence: Evidence) -> str:
    """A stretch in which poses leave what treads and yaw say, while elsewhere they agree."""
    spans = _spans(evidence)
    if spans is None:
        return ""
    drives = spans.drives
    usual_m = float(np.median(spans.apart_m[drives if drives.any() else slice(None)]))
    alone = spans.apart_m > LEAST_M + OF_TRAVEL * spans.driven_m
    alone &= spans.apart_m > TIMES * usual_m
    odd = (alone | spans.much) & (spans.moved_m > STOOD * spans.driven_m)
    if not odd.any():
        return ""
    worst = int(np.argmax(np.where(odd, spans.apart_m, 0.0)))
    return (
        f"positions end {spans.apart_m[worst]:.2g} m from where treads and yaw lead within "
        f"{SPAN_S:g} s at {evidence.run_time_s(spans.start_s[worst]):.0f} s (usual: "
        f"{usual_m:.2g} m), as by reflected signals (multipath) or slip"
    )


@once
def _spans(evidence: Evidence) -> PositionSpans | None:
    pose, scale = evidence.run.pose, evidence.metres_per_metre
    if pose is None or scale is None or evidence.heading is None or evidence.poses_used is None:
        return None
    rows = np.flatnonzero(evidence.poses_used & np.isfinite(pose["yaw"]))
    stamps_s = pose.stamps_s[rows]
    inside = (stamps_s >= evidence.stamps_s[0]) & (stamps_s <= evidence.stamps_s[-1])
    rows, stamps_s = rows[inside], stamps_s[inside]
    off = pose.stack("x", "y")[rows] - reckoned(evidence, rows, scale)
    off = without_window_changes(evidence, rows, off)
    first = np.arange(len(rows))
    last = np.searchsorted(stamps_s, stamps_s + SPAN_S)
    first, last = first[last < len(rows)], last[last < len(rows)]
    whole = stamps_s[last] - stamps_s[first] < 1.2 * SPAN_S
    rests = np.concatenate([[0], np.cumsum(np.diff(stamps_s) > LONGEST_S)])
    whole &= rests[last] == rests[first]  # between poses the way is a straight line here
    whole &= ~evidence.left_out(stamps_s[first], stamps_s[last])
    first, last = first[whole], last[whole]
    if len(first) < LEAST_SPANS:
        return None
    apart_m = np.hypot(*(off[last] - off[first]).T)
    travel_m = evidence.travel_m(stamps_s)
    driven_m = scale * (travel_m[last] - travel_m[first])
    moved_m = np.hypot(*np.diff(pose.stack("x", "y")[rows[[first, last]]], axis=0)[0].T)
    return PositionSpans(stamps_s[first], apart_m, driven_m, moved_m)


PATH_SPAN_S, STEP_S = 20.0, 0.25  # long enough to have a shape, short enough for dead reckoning
LEAST_PATH_M = 2.0  # that a robot drives in a span
LEAST_PATH_SPANS = 2
TIMES_NOISE = 3.0  # of positions, by which a path must be longer
ALIKE = 0.5  # below, paths are others: recordings of robots that slip have 0.62 and more,
ALIKE_BY_TREADS = 0.7  # without a gyroscope, whose turns hold from span to span, 0.82
STEEP_RAD, STEEP_SHARE = np.radians(8.0), 0.9  # figure eights at 12 degrees slide off their path
WIDTHS = (1.0, 1.4, 2.0)  # of treads, in track widths, where no gyroscope measures the turns


def paths_apart(evidence: Evidence) -> str:
    """Paths whose shapes have little to do with each other."""
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 2 or evidence.yaw_measured:
        return ""
    if _is_steep(evidence):
        return ""
    rows = np.flatnonzero(used)
    likeness, least = _likeness(evidence, pose.stamps_s[rows], pose.stack("x", "y")[rows])
    if not likeness < least:
        return ""
    return (
        "the path of pose.csv is not the one that treads and gyroscope say: turned and scaled to "
        f"fit, their similarity is {likeness:.2f} (1 where they are the same)"
    )


def _is_steep(evidence: Evidence) -> bool:
    """Whether a tenth of the drive is so steep that a robot slides downhill as it turns."""
    odometry = evidence.run.odometry
    return any(
        float(np.nanquantile(np.abs(odometry[name]), STEEP_SHARE)) > STEEP_RAD
        for name in ("roll", "pitch")
        if name in odometry and np.isfinite(odometry[name]).any()
    )


def _likeness(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> tuple[float, float]:
    """Similarity of both paths, and the limit below which they differ; NaN where not known.

    A path that is turned, scaled and moved is one complex number times the other: the size of their
    complex correlation over a span says how similar they are, its angle by how much one is turned.
    With a gyroscope that turn is the same in the next span.
    """
    of = evidence.integrals
    at_s, measured = _even(evidence, stamps_s, positions)
    if evidence.yaw_rate is not None:
        fits = _fits(evidence, at_s, measured, of.gyroscope_rad(at_s))
        pairs = fits[1:] * fits[:-1].conj()
        return _median(pairs.real / np.sqrt(np.maximum(np.abs(pairs), 1e-12))), ALIKE
    difference_m = of.right_m(at_s) - of.left_m(at_s)
    turns = [difference_m / width_m for width_m in _widths_m(evidence)]
    found = (_median(np.abs(_fits(evidence, at_s, measured, turn))) for turn in turns)
    return max(found), ALIKE_BY_TREADS


def path_likenesses(evidence: Evidence) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Similarities (K,) of spans to the treads as read and exchanged, and begins (K,) [s].

    NaN where one is not known; none without poses.
    """
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 2:
        return np.empty(0), np.empty(0), np.empty(0)
    at_s, measured = _even(evidence, pose.stamps_s[used], pose.stack("x", "y")[used])
    turned_m = evidence.integrals.right_m(at_s) - evidence.integrals.left_m(at_s)
    widths_m = [width * evidence.run.robot.track_width for width in WIDTHS]
    as_read, exchanged = (
        np.max([np.abs(_fits(evidence, at_s, measured, of / w)) for w in widths_m], axis=0)
        for of in (turned_m, -turned_m)
    )
    return as_read, exchanged, at_s[_begins(at_s)]


def _even(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> tuple[FloatArray, ComplexArray]:
    """Even stamps (L,), and the positions there as complex numbers."""
    begin_s = max(stamps_s[0], evidence.stamps_s[0])
    at_s = np.arange(begin_s, min(stamps_s[-1], evidence.stamps_s[-1]), STEP_S)
    x, y = (np.interp(at_s, stamps_s, column) for column in positions.T)
    return at_s, x + 1j * y


def _begins(at_s: FloatArray) -> IntArray:
    """First rows (K,) of spans of which each overlaps the next by half."""
    count = round(PATH_SPAN_S / STEP_S)
    return np.arange(0, len(at_s) - count, count // 2)


def _widths_m(evidence: Evidence) -> list[float]:
    """Effective widths that are tried: in long circles that by the course is needed."""
    widths_m = [width * evidence.run.robot.track_width for width in WIDTHS]
    by_course = evidence.pose_turn_by_difference
    if by_course is not None and by_course.certain() and by_course.slope > 0:
        widths_m.append(1 / by_course.slope)
    return widths_m


def _median(likenesses: FloatArray) -> float:
    known = likenesses[np.isfinite(likenesses)]
    return float(np.median(known)) if len(known) >= LEAST_PATH_SPANS else np.nan


def _fits(
    evidence: Evidence, at_s: FloatArray, measured: ComplexArray, yaw_rad: FloatArray
) -> ComplexArray:
    """Complex correlations (K,) over spans, each overlapping the next by half.

    NaN where the robot drove less than positions can show, a turn is not known, or the span is left
    out.
    """
    of, count = evidence.integrals, round(PATH_SPAN_S / STEP_S)
    steps_m = np.diff((of.left_m(at_s) + of.right_m(at_s)) / 2)
    middle = (yaw_rad[1:] + yaw_rad[:-1]) / 2
    unknown = np.isnan(middle)
    reckoned = np.append(0.0, np.cumsum(steps_m * np.exp(1j * np.nan_to_num(middle))))
    if (place_m := evidence.run.sensors.pose_m) is not None:
        reckoned += complex(*place_m[:2]) * np.exp(1j * np.nan_to_num(yaw_rad))
    first = _begins(at_s)
    left_out = evidence.left_out(at_s[first], at_s[first + count - 1])
    noise_m = TIMES_NOISE * evidence.position_sigma_m * np.sqrt(count)
    fits = np.full(len(first), np.nan, dtype=np.complex128)
    for k in np.flatnonzero(~left_out):
        chosen = slice(first[k], first[k] + count)
        if unknown[chosen].any():
            continue
        one, other = (path[chosen] - path[chosen].mean() for path in (reckoned, measured))
        driven_m = np.abs(steps_m[first[k] : first[k] + count - 1]).sum()
        sizes = np.linalg.norm(one), np.linalg.norm(other)
        if driven_m > LEAST_PATH_M and min(sizes) > noise_m:
            fits[k] = np.vdot(one, other) / (sizes[0] * sizes[1])
    return fits
