"""Terrain by feel while rows of the IMU and of odometry come in."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from odometry.errors import ParameterError, RunFolderError
from odometry.feel.labels.felt import FeelConfig, FeltWindows
from odometry.feel.labels.follow import check_robot
from odometry.feel.labels.live_rows import LiveRows
from odometry.feel.model import FeelModel
from odometry.feel.recorded.imu_check import ImuSums
from odometry.feel.recorded.signals import (
    AXES,
    GAP_PERIODS,
    LEAST_RATE_HZ,
    FeelSignals,
    current_sizes,
    usual_rate_hz,
)
from odometry.feel.recorded.windows import steps_of, windows_of
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Robot
from odometry.windows.recorded.gaps import GapsSoFar

LATE_S = 5.0  # rows that come later than this after the frame of a window's end are too late
NOTHING = (math.nan, math.nan, math.nan)


class LiveFeel:
    """Windows of terrain by feel as they become known.

    Parameters
    ----------
    model : FeelModel
    robot : Robot
    imu_rad : (3,), optional
        roll, pitch, yaw of the axes of the IMU in the robot frame, `[sensors] imu`.
    config : FeelConfig, optional
    rate_hz : float, optional
        Samples a second of the IMU; by default found from the first window.

    Attributes
    ----------
    too_late : int
        Rows that were dropped: their stamps do not increase, or are no numbers.
    note : str
        Why nothing can be felt; "" where all is well.

    Raises
    ------
    RunFolderError
        If the robot is not that of the model.
    ParameterError
        If the model was made of no vibration.

    Notes
    -----
    A window is measured as by `follow_feel`, from rows up to the stamp from which it is known, and
    given at the first frame there or later. Memory does not grow with time. What needs the whole
    run is not checked: one clock, samples that repeat.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> model = odometry.read_feel_model(odometry.shipped_data() / "feel" / "demo.feel")
    >>> live = odometry.LiveFeel(model, odometry.Robot(track_width=0.4))
    >>> for i in range(61):
    ...     live.imu(0.05 * i, gyro=(0.0, 0.0, 0.1 * np.sin(9.0 * i)))
    >>> frames = (
    ...     odometry.Frame(0.5 * i, np.array([0.4, 0.5]), i, None, None) for i in range(7)
    ... )
    >>> [len(list(live.step(frame))) for frame in frames]
    [0, 0, 0, 0, 1, 0, 1]
    """

    def __init__(
        self,
        model: FeelModel,
        robot: Robot,
        *,
        imu_rad: Sequence[float] | None = None,
        config: FeelConfig | None = None,
        rate_hz: float | None = None,
    ) -> None:
        check_robot(model, robot, robot.name or "the robot")
        needed = {*model.design.axes, *(("gyro_z",) if "yaw" in model.design.motion else ())}
        if not needed:
            raise ParameterError("the model of feel uses no column of an IMU; expected one or more")
        self.too_late, self.note = 0, ""
        self.config = config or FeelConfig()
        self._model, self._width_m = model, robot.track_width
        self._axes = tuple(axis for axis in AXES if axis in needed)
        turned = None if imu_rad is None else rotation_from_roll_pitch_yaw(np.array(imu_rad))
        self._rotation = turned
        self._rate_hz, self._begin_s = rate_hz, -math.inf
        self._imu, self._treads, self._currents = (
            LiveRows(len(self._axes)),
            LiveRows(2),
            LiveRows(2),
        )
        self._gaps, self._gap_s = GapsSoFar(), list[tuple[float, float]]()
        self._row, self._row_s = -1, -math.inf
        self._next = 0  # sample at which the next window begins
        self._sums, self._shape = ImuSums(), model.shape_so_far
        self._felt: FeltWindows | None = None

    def imu(
        self,
        stamp_s: float,
        *,
        gyro: Sequence[float] = NOTHING,
        accel: Sequence[float] = NOTHING,
    ) -> None:
        """A row of the IMU: x, y, z in rad/s and m/s2, gravity included; NaN if not measured."""
        if self.note:
            return
        both = (np.asarray(gyro, dtype=np.float64), np.asarray(accel, dtype=np.float64))
        if self._rotation is not None:
            both = (self._rotation @ both[0], self._rotation @ both[1])
        values = dict(zip(AXES, np.concatenate(both).tolist(), strict=True))
        self.too_late += not self._imu.add(stamp_s, [values[name] for name in self._axes])
        if self._rate_hz is None and self._imu.latest_s >= self._imu.first_s + self._window_s:
            self._rate_hz = usual_rate_hz(self._imu.stamps_s)
        if self._rate_hz is not None and math.isinf(self._begin_s):
            self._imu.forget(stamp_s - LATE_S)  # nothing was driven so far

    def currents(self, stamp_s: float, left_a: float, right_a: float) -> None:
        """Motor currents [A], held until the next."""
        self.too_late += not self._currents.add(stamp_s, (left_a, right_a))

    def step(self, frame: Frame) -> Iterator[FeltWindows]:
        """Take in a frame; each window that is known there, as the last of its stretch."""
        if self.note:
            return
        self._drive(frame)
        rate_hz = self._rate_hz
        if rate_hz is None or math.isinf(self._treads.first_s):
            self._treads.forget(frame.stamp_s - LATE_S)
            return
        if math.isinf(self._begin_s):
            self._begin_s = max(self._imu.first_s, self._treads.first_s)
            self._check_rate(rate_hz)
        while not self.note and self._due_s(self._next, rate_hz) <= frame.stamp_s:
            count, step = steps_of(self._window_s, rate_hz)
            last_s = self._begin_s + (self._next + count - 1) / rate_hz
            complete_s = self._imu.completed_s(last_s, rate_hz)
            if math.isinf(complete_s) and frame.stamp_s > last_s + LATE_S:
                complete_s = frame.stamp_s
            if not complete_s <= frame.stamp_s:
                return
            felt = self._measured(count, rate_hz, complete_s)
            self._next += step
            if felt is not None:
                yield felt
            self._forget(rate_hz)

    def _drive(self, frame: Frame) -> None:
        """Take in the tread speeds of a frame, and for how long those before are not known."""
        frame = self._gaps.marked(frame)
        if frame.in_gap:
            self._gap_s.append((self._row_s, frame.stamp_s))
        if frame.odometry_row != self._row:
            self._row, self._row_s = frame.odometry_row, frame.stamp_s
        if np.isfinite(frame.tread_speeds_m_s).all():
            self._treads.add(frame.stamp_s, frame.tread_speeds_m_s.tolist())

    @property
    def names(self) -> tuple[str, ...]:
        """The terrains of the model."""
        return self._model.names

    @property
    def _window_s(self) -> float:
        return self._model.design.window_s

    def _due_s(self, first: int, rate_hz: float) -> float:
        """The stamp at which a window ends, as `FeelWindows.ends_s` has it."""
        count, _ = steps_of(self._window_s, rate_hz)
        return (self._begin_s + first / rate_hz) + count / rate_hz

    def _measured(self, count: int, rate_hz: float, complete_s: float) -> FeltWindows | None:
        """The next window and those of the stretch before; None where nothing can be felt."""
        signals = self._signals(count, rate_hz)
        step = steps_of(self._window_s, rate_hz)[1]  # what the window before did not have
        axes = {name: of[-step:] for name, of in signals.axes.items()}
        new = (axes, signals.treads_m_s[-step:], rate_hz, self._width_m)
        self._sums = self._sums.plus(*new)
        self.note = self._sums.fault()
        if self.note:
            return None
        window = windows_of(signals, self._window_s, "", self._width_m)
        try:
            self._model.design.check(window, "live")
        except RunFolderError as error:
            self.note = str(error)
            return None
        known_s = np.maximum(window.ends_s, complete_s)
        window = replace(window, complete_s=known_s)
        self._shape = self._shape.plus(window)
        scores, foreign = self._model.scores(window), np.array([self._shape.is_foreign])
        alone = FeltWindows(self._model, self.config, window, scores, foreign)
        self._felt = _latest([self._felt, alone] if self._felt else [alone])
        return self._felt

    def _signals(self, count: int, rate_hz: float) -> FeelSignals:
        begin_s = self._begin_s + self._next / rate_hz
        grid_s = self._begin_s + np.arange(self._next, self._next + count) / rate_hz
        even = self._imu.even(grid_s, rate_hz)
        treads = self._treads.held(grid_s)
        for after_s, upto_s in self._gap_s:
            treads[(grid_s > after_s) & (grid_s < upto_s)] = math.nan
        currents = None
        if math.isfinite(self._currents.first_s):
            currents = current_sizes(self._currents.held(grid_s))
        axes = dict(zip(self._axes, even, strict=True))
        labels = np.full(count, UNKNOWN, dtype=object)
        return FeelSignals(begin_s, rate_hz, axes, treads, currents, labels)

    def _check_rate(self, rate_hz: float) -> None:
        if rate_hz < LEAST_RATE_HZ:
            self.note = (
                f"{rate_hz:.3g} rows of the IMU a second; terrain by feel needs {LEAST_RATE_HZ:g} "
                "or more"
            )

    def _forget(self, rate_hz: float) -> None:
        """Drop what no later window needs."""
        begin_s = self._begin_s + self._next / rate_hz
        self._imu.forget(begin_s - (GAP_PERIODS + 1) / rate_hz)
        self._treads.forget(begin_s)
        self._currents.forget(begin_s)
        self._gap_s = [one for one in self._gap_s if one[1] > begin_s]


LONGEST_STRETCH_S = 4.0  # beside the one that is set: what contradictions are judged over


def _latest(parts: Sequence[FeltWindows]) -> FeltWindows:
    """The windows that the last one is put together with."""
    felt = FeltWindows.joined(parts)
    stretch_s = max(felt.config.stretch_s, LONGEST_STRETCH_S)
    windows = felt.windows
    first = int(np.searchsorted(windows.begins_s, windows.ends_s[-1] - stretch_s - 1e-6))
    return felt.since(min(first, len(windows) - 1))
