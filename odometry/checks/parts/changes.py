"""What may be otherwise in a part of a recording, and how it is undone there."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.undo import TREADS
from odometry.checks.parts.span import Span
from odometry.recording.run import Run

YAW, RATE = ("yaw",), ("gyro_x", "gyro_y", "gyro_z")


@dataclass(frozen=True)
class Change:
    """A change of the columns of one sensor.

    Attributes
    ----------
    sensor : str
        pose, gyroscope or treads.
    words : str
        What is so then.
    remedy : str
    undo : callable of (C, N) to (C, N)
        The columns as they would be.
    """

    sensor: str
    words: str
    remedy: str
    undo: Callable[[FloatArray], FloatArray]

    @property
    def factor(self) -> float:
        """By which recorded values are larger than undone ones."""
        return float(1 / np.abs(self.undo(np.ones((2, 1)))).mean())

    def table(self, gyroscope_file: str) -> str:
        """The table that has the columns, without its ending."""
        if self.sensor == "gyroscope":
            return gyroscope_file.removesuffix(".csv")
        return "pose" if self.sensor == "pose" else "odometry"

    def columns(self, run: Run, table: str) -> FloatArray:
        """The columns (C, N) as recorded."""
        return np.stack([getattr(run, table)[name] for name in self._names(run, table)])

    def undone(self, run: Run, table: str, span: Span) -> Run:
        """The run with the change undone in a span."""
        of = getattr(run, table)
        recorded = self.columns(run, table)
        mended = np.where(span.holds(of.stamps_s), self.undo(recorded), recorded)
        columns = {**of.columns, **dict(zip(self._names(run, table), mended, strict=True))}
        return replace(run, **{table: replace(of, columns=columns)})

    def motion(self, of: Motion) -> Motion:
        """Windows of raw motion with the change undone in all of them."""
        if self.sensor == "pose":
            return of.with_yaw(lambda yaw: self.undo(yaw[None])[0])
        if self.sensor == "gyroscope":
            return replace(of, gyroscope_rad=self.undo(of.gyroscope_rad[None])[0])
        left_m, right_m = self.undo(np.stack([of.left_m, of.right_m]))
        return replace(of, left_m=left_m, right_m=right_m)

    def _names(self, run: Run, table: str) -> tuple[str, ...]:
        names = {"pose": YAW, "gyroscope": RATE, "treads": TREADS}[self.sensor]
        return tuple(name for name in names if name in getattr(run, table))


def _sides(left: float, right: float) -> Callable[[FloatArray], FloatArray]:
    return lambda columns: columns * np.array([[left], [right]])


SIGN = "Turn the sign there, or cut with --from and --to"
CHANGES = (
    Change("pose", "yaw is in degrees", "Convert these rows to radians", np.radians),
    Change("pose", "yaw counts clockwise (its sign is reversed)", SIGN, np.negative),
    Change(
        "gyroscope", "gyro_z is in degrees per second", "Convert these rows to rad/s", np.radians
    ),
    Change("gyroscope", "gyro_z has the opposite sign", SIGN, np.negative),
    Change(
        "treads",
        "left and right treads are exchanged",
        "Exchange both columns there, or cut with --from and --to",
        np.flipud,
    ),
    Change("treads", "both treads have the opposite sign", SIGN, np.negative),
    Change("treads", "v_left has the opposite sign", SIGN, _sides(-1, 1)),
    Change("treads", "v_right has the opposite sign", SIGN, _sides(1, -1)),
)
