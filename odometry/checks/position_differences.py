"""Positions that part from dead reckoning within some seconds."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.steps import reckoned, without_window_changes

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
    def much(self) -> BoolArray:
        """Spans (K,) in which they part by far more than slip leaves."""
        drives = self.driven_m > 0.2 * float(np.quantile(self.driven_m, 0.9))
        return np.asarray(drives & (self.apart_m - LEAST_M > HALF * self.driven_m))


def positions_apart_everywhere(evidence: Evidence) -> str:
    """Positions that have little to do with what treads and yaw say."""
    spans = _spans(evidence)
    if spans is None or float(np.mean(spans.much)) < 0.5:
        return ""
    return (
        f"positions part by {np.median(spans.apart_m):.2g} m from what treads and yaw say in "
        f"{SPAN_S:g} s, in which the robot drives {np.median(spans.driven_m):.2g} m"
    )


def positions_apart(evidence: Evidence) -> str:
    """A stretch in which poses leave what treads and yaw say, while elsewhere they agree."""
    spans = _spans(evidence)
    if spans is None:
        return ""
    usual_m = float(np.median(spans.apart_m))
    alone = spans.apart_m > LEAST_M + OF_TRAVEL * spans.driven_m
    alone &= spans.apart_m > TIMES * usual_m
    odd = (alone | spans.much) & (spans.moved_m > STOOD * spans.driven_m)
    if not odd.any():
        return ""
    worst = int(np.argmax(np.where(odd, spans.apart_m, 0.0)))
    return (
        f"positions part by {spans.apart_m[worst]:.2g} m from what treads and yaw say within "
        f"{SPAN_S:g} s at {evidence.run_time_s(spans.start_s[worst]):.0f} s (usual: "
        f"{usual_m:.2g} m), as by reflected signals (multipath) or slip"
    )


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
