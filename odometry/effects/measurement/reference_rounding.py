"""Positions of the reference that were rounded."""

from odometry.effects.interface.base import Effect, EffectParameter, MeasurementEffect
from odometry.effects.interface.recorded import Recorded


class RoundedPositions(MeasurementEffect):
    """Positions that lie on a grid: nothing undoes that, and it counts as noise."""

    name = "reference_fault"
    form = "rounded"
    in_words = "positions of the reference that are rounded"
    equation = "(x, y) -> step round((x, y) / step)"
    source = "rounding error uniform within a step: variance step^2 / 12"
    looks_like = "a robot that goes in steps of one size, along both axes of the map"
    remedy = "write positions with more digits: in double precision, relative to the start"
    needs = "positions whose noise is less than that of the rounding"
    of_reference = True

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """The step: for the reader."""
        return (EffectParameter("step", "m", 0.0, 1e6, 0.0, 0.01),)

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:  # noqa: ARG003 - of the interface
        """None: it is found before anything is fitted."""
        return ()
