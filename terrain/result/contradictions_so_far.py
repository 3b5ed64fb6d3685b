"""Spans in which camera, feel and motion name different terrains, moment by moment."""

from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray
from odometry.recording.run import UNKNOWN

BREAK_S = 2.5  # a shorter time between two equal stretches ends none
LASTS_S = 5.0  # what is shorter is an edge between terrains, or chance

Names = tuple[str, str, str]  # by camera, feel and motion


@dataclass(frozen=True)
class Contradiction:
    """A span in which sources differ, or in which neither knows the terrain.

    Attributes
    ----------
    begin_s, end_s : float
    camera, feel, motion : str
        The terrain by each source; "" of a source that names nothing.
    camera_probability, feel_probability : float
        Means over the span; NaN without a name.
    """

    begin_s: float
    end_s: float
    camera: str
    feel: str
    motion: str
    camera_probability: float
    feel_probability: float

    @property
    def is_new(self) -> bool:
        """Whether no source knows the terrain, and it is unknown by feel."""
        return self.feel == UNKNOWN and self.camera in ("", UNKNOWN)


def differ(camera: str, feel: str, motion: str) -> bool:
    """Whether two sources that name a terrain name different ones, or feel knows none.

    A camera that knows no terrain contradicts no other source, nor does feel where the camera knows
    one.
    """
    named = {name for name in (camera, feel, motion) if name not in ("", UNKNOWN)}
    return len(named) > 1 or (feel == UNKNOWN and not named)


@dataclass
class _Span:
    """Moments of the same names; probabilities as sums (2,) and counts (2,) of numbers.

    What came after the last such moment is in `after`, and belongs to the span if it goes on.
    """

    by_source: Names
    begin_s: float
    end_s: float
    sums: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))
    after: FloatArray = field(default_factory=lambda: np.zeros((2, 2)))

    def contradiction(self) -> Contradiction | None:
        """None where it is short."""
        if self.end_s - self.begin_s < LASTS_S:
            return None
        sums, counts = self.sums
        camera, feel = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan).tolist()
        return Contradiction(self.begin_s, self.end_s, *self.by_source, camera, feel)


class ContradictionsSoFar:
    """The contradictions of moments that come in order; memory does not grow with them."""

    def __init__(self) -> None:
        self._span: _Span | None = None
        self._before: Names | None = None

    def add(
        self, moment_s: float, by_source: Names, probabilities: tuple[float, float]
    ) -> tuple[Contradiction, ...]:
        """Take in a moment; the contradiction that ended before it, if one did.

        Parameters
        ----------
        moment_s : float
        by_source : (str, str, str)
            The terrain by camera, feel and motion; "" of a source that names none.
        probabilities : (float, float)
            By camera and feel; NaN where there is none.
        """
        span, goes_on = self._span, self._before == by_source
        self._before = by_source
        known = np.isfinite(probabilities)
        row = np.stack([np.where(known, probabilities, 0.0), known])
        if span is not None:
            span.after = span.after + row
        if not differ(*by_source):
            return ()
        same = span is not None and span.by_source == by_source
        if span is not None and same and (goes_on or moment_s <= span.end_s + BREAK_S):
            span.end_s = moment_s
            span.sums, span.after = span.sums + span.after, np.zeros((2, 2))
            return ()
        ended = self.lasting
        self._span = _Span(by_source, moment_s, moment_s, row)
        return ended

    @property
    def lasting(self) -> tuple[Contradiction, ...]:
        """The latest contradiction, if it lasts."""
        found = None if self._span is None else self._span.contradiction()
        return () if found is None else (found,)
