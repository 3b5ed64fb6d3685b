"""Headings of gyroscope and poses over spans of the same time."""

from dataclasses import dataclass, fields

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.windows.recorded.spans import touched

LONGEST = 1.2  # times the length that was requested
LEAST = 30  # spans


@dataclass(frozen=True)
class HeadingSpans:
    """Turns over K spans.

    Attributes
    ----------
    start_s, end_s : (K,)
        Stamps.
    yaw_rad : (K, 2)
        Measured yaw at both ends, unwrapped along the gyroscope's heading.
    gyroscope_rad : (K,)
        Turn by the gyroscope.
    turned_rad : (K,)
        All turns within the span, without sign.
    """

    start_s: FloatArray
    end_s: FloatArray
    yaw_rad: FloatArray
    gyroscope_rad: FloatArray
    turned_rad: FloatArray

    def __len__(self) -> int:
        return len(self.start_s)

    @property
    def pose_rad(self) -> FloatArray:
        """Turn (K,) by the poses."""
        return np.asarray(self.yaw_rad[:, 1] - self.yaw_rad[:, 0])

    @property
    def lasts_s(self) -> FloatArray:
        """Duration (K,)."""
        return self.end_s - self.start_s

    def chosen(self, rows: BoolArray) -> "HeadingSpans":
        """The same with only the chosen spans."""
        return HeadingSpans(*(getattr(self, field.name)[rows] for field in fields(self)))


def heading_spans(evidence: Evidence, *choices_s: float) -> HeadingSpans | None:
    """Spans of about so many seconds, one from each pose; None without gyroscope or yaw.

    Spans that cross a change of `window`, a gap of poses or gyroscope, or what is left out are not
    there. The first choice that leaves enough is taken: windows may be short.
    """
    found = (_heading_spans(evidence, span_s) for span_s in choices_s)
    return next((spans for spans in found if spans is not None and len(spans) >= LEAST), None)


def _heading_spans(evidence: Evidence, span_s: float) -> HeadingSpans | None:
    pose, fit = evidence.run.pose, evidence.pose_turn_by_gyroscope
    if pose is None or evidence.poses_used is None or fit is None or not evidence.yaw_measured:
        return None
    stamps_s = pose.stamps_s
    turned = evidence.integrals.gyroscope_rad(stamps_s)
    rows = np.flatnonzero(evidence.poses_used & np.isfinite(turned))
    stamps_s, turned = stamps_s[rows], turned[rows]
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    yaw = np.unwrap(yaw - fit.slope * turned) + fit.slope * turned
    first = np.arange(len(rows))
    last = np.searchsorted(stamps_s, stamps_s + span_s)
    first, last = first[last < len(rows)], last[last < len(rows)]
    whole = stamps_s[last] - stamps_s[first] < LONGEST * span_s
    whole &= ~evidence.left_out(stamps_s[first], stamps_s[last])
    whole &= ~touched(evidence.silent_s, stamps_s[first], stamps_s[last])
    if "window" in pose:
        window = np.nan_to_num(pose["window"][rows])
        whole &= window[first] == window[last]
    first, last = first[whole], last[whole]
    everything = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(turned)))])
    return HeadingSpans(
        stamps_s[first],
        stamps_s[last],
        np.stack([yaw[first], yaw[last]], axis=-1),
        turned[last] - turned[first],
        (everything[last] - everything[first]) if len(rows) else np.empty(0),
    )
