"""The check of recordings on the last minutes of a live run."""

import math
from collections import deque
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.recording.frames import POSE_COLUMNS, VELOCITY_COLUMNS, Frame
from odometry.recording.run import Robot, Run
from odometry.tables.table import Table

FIRST_S, TIMES = 60.0, 2.0  # of frames at the first check, and how many times as many at the next
WINDOW_S = 120.0  # of the frames that are checked
Rows = deque[tuple[float, ...]]
COLUMNS = {
    "odometry": ("t", "v_left", "v_right"),
    "imu": ("t", "gyro_z"),
    "pose": ("t", *POSE_COLUMNS),
    "velocity": ("t", *VELOCITY_COLUMNS),
}
# What is set up wrongly and stays so. What terrain, slip, a stop or a lost message make is not: the
# filter watches these.
OF_SETUP = frozenset(
    {
        *("tread_unit", "treads_swapped", "treads_both_reversed", "tread_left_reversed"),
        *("tread_right_reversed", "treads_or_gyroscope_reversed", "treads_are_twist"),
        *("treads_equal", "treads_unsigned", "treads_are_counters", "treads_unrelated"),
        *("gyroscope_unit", "gyroscope_reversed", "gyroscope_unrelated", "gyroscope_dead"),
        *("velocity_unit", "velocity_reversed", "velocity_axes", "velocity_unrelated"),
        *("yaw_in_degrees", "yaw_reversed", "yaw_off_by_90", "yaw_backwards", "yaw_offset"),
        *("yaw_constant", "yaw_is_quaternion", "yaw_unrelated", "pose_mirrored"),
        *("positions_mirrored", "position_axes", "position_unit", "latitude_longitude"),
        *("earth_centred", "web_map_positions", "positions_stretched", "far_sensor"),
        *("pose_late", "yaw_late", "positions_late", "gyroscope_late", "treads_late"),
        *("clocks_apart", "poses_unrelated"),
    }
)


class CheckedSoFar:
    """Keeps the measurements of the last minutes, and checks them as a recording now and then.

    Parameters
    ----------
    robot : Robot
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    """

    def __init__(self, robot: Robot, lever_m: tuple[float, float]) -> None:
        self._robot = robot
        self._settings = {"sensors": {"pose": [*lever_m, 0.0]}} if any(lever_m) else {}
        self._rows: dict[str, Rows] = {name: deque() for name in COLUMNS}
        self._row, self._begin_s, self._last_s = -1, math.nan, math.nan
        self._due_after_s = FIRST_S
        self._notes: list[str] = []

    def add(self, frame: Frame) -> None:
        """Take in what a frame measured."""
        stamp_s, before_s = frame.stamp_s, self._last_s
        if math.isnan(before_s):
            self._begin_s = stamp_s
        if frame.odometry_row != self._row and np.isfinite(frame.tread_speeds_m_s).all():
            self._keep("odometry", stamp_s, frame.tread_speeds_m_s)
        if before_s < stamp_s and math.isfinite(frame.yaw_rate_rad_s):
            self._keep("imu", (before_s + stamp_s) / 2, np.array([frame.yaw_rate_rad_s]))
        for name, measured in (("pose", frame.pose), ("velocity", frame.velocity)):
            if measured is not None:
                self._keep(name, stamp_s, measured)
        self._row, self._last_s = frame.odometry_row, stamp_s

    def notes(self) -> list[str]:
        """What the last check warns of; it is made anew once there are twice as many frames."""
        after_s = self._last_s - self._begin_s
        if after_s >= self._due_after_s:
            self._due_after_s = TIMES * after_s
            self._notes = self._checked()
        return self._notes

    def _keep(self, name: str, stamp_s: float, values: FloatArray) -> None:
        rows = self._rows[name]
        if rows and rows[-1][0] >= stamp_s:
            return
        rows.append((stamp_s, *values.tolist()))
        while rows[0][0] < stamp_s - WINDOW_S:
            rows.popleft()

    def _checked(self) -> list[str]:
        odometry, imu, pose, velocity = map(self._table, ("odometry", "imu", "pose", "velocity"))
        if odometry is None:
            return []
        run = Run(
            Path("live"),
            self._robot,
            self._settings,
            odometry,
            pose=pose,
            velocity=velocity,
            imu=imu,
        )
        lasts_s = odometry.stamps_s[-1] - odometry.stamps_s[0]
        return [
            f"by the check of the last {lasts_s:.0f} s: {finding.line.partition(': ')[2]}"
            for finding in check_recording(run).findings
            if finding.name in OF_SETUP and finding.level is not Level.NOTE
        ]

    def _table(self, name: str) -> Table | None:
        rows = self._rows[name]
        if len(rows) < 2:
            return None
        columns = dict(zip(COLUMNS[name], np.array(rows).T, strict=True))
        return Table(Path(f"{name}.csv"), columns, np.arange(len(rows)) + 2)
