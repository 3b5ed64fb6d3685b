"""Trajectories from elsewhere as poses of a run: their columns, clock, axes, and what is no yaw."""

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import TrajectoryError
from odometry.tables.table import Table
from odometry.trajectory import SpatialTrajectory

ZONE_S, MOST_ZONE_S = 900.0, 14 * 3600.0  # time zones differ by whole quarters of an hour
GPS_S, WEEK_S = 315_964_800.0 - 18.0, 604_800.0  # from 1970, less the leap seconds since 2017
MOST_TURN_RAD = 1.0  # of a step between two poses, by which it still shows where forward is
SAME_ROTATION = 1e-6  # of an entry of a matrix
ALONG = 1e-3  # of the way along: noise, and any bend, is larger
LEVEL = 0.2  # height of a path over its extent: below, z points up


def pose_columns(trajectory: SpatialTrajectory) -> dict[str, AnyArray]:
    """Columns of pose.csv by name: t, x, y, yaw, z, roll, pitch.

    Where no attitude is measured yaw is NaN, and roll and pitch are left out.
    """
    x, y, z = trajectory.positions_m.T
    if not measures_attitude(trajectory):
        return {"t": trajectory.stamps_s, "x": x, "y": y, "yaw": np.full(len(x), np.nan), "z": z}
    roll, pitch, yaw = trajectory.roll_pitch_yaw.T
    return {
        "t": trajectory.stamps_s,
        "x": x,
        "y": y,
        "yaw": yaw,
        "z": z,
        "roll": roll,
        "pitch": pitch,
    }


def poses_within(stamps_s: FloatArray, odometry: Table) -> int:
    """How many poses, of stamps (N,), lie within the odometry of a run.

    Raises
    ------
    TrajectoryError
        If none does: other clocks, or another run.
    """
    first_s, last_s = odometry.stamps_s[[0, -1]]
    within = int(np.sum((stamps_s >= first_s) & (stamps_s <= last_s)))
    if not within:
        raise TrajectoryError(
            f"the poses are of {stamps_s[0]:.3f} to {stamps_s[-1]:.3f} s, {odometry.file} of "
            f"{first_s:.3f} to {last_s:.3f} s; expected stamps of one clock"
            f"{_another_clock(stamps_s, odometry.stamps_s)}"
        )
    return within


def _another_clock(stamps_s: FloatArray, of_odometry_s: FloatArray) -> str:
    """What is said where stamps (N,) fit those of the odometry but for a zone, or GPS time."""
    behind_s = float(of_odometry_s[0] - stamps_s[0])
    zone_s = round(behind_s / ZONE_S) * ZONE_S
    gps_s = GPS_S + round((behind_s - GPS_S) / WEEK_S) * WEEK_S
    share = "They share time where the poses are moved by"
    if 0 < abs(zone_s) <= MOST_ZONE_S and _share_time(stamps_s + zone_s, of_odometry_s):
        return (
            f". {share} {zone_s / 3600:+g} hours: are they in another time zone than the odometry? "
            f"Then add {zone_s:g} s to their stamps"
        )
    if gps_s >= GPS_S and _share_time(stamps_s + gps_s, of_odometry_s):
        since = "6 January 1980" if gps_s == GPS_S else "the start of a week"
        return (
            f". {share} {gps_s:+.0f} s: they are GPS time, which counts from {since}. Add that to "
            "their stamps"
        )
    return ""


def _share_time(stamps_s: FloatArray, of_odometry_s: FloatArray) -> bool:
    return bool(stamps_s[0] <= of_odometry_s[-1] and stamps_s[-1] >= of_odometry_s[0])


def travel_axis(trajectory: SpatialTrajectory) -> int:
    """Axis of the body (0 is x) along which it moves most; 0 where nothing moves.

    Between poses that turn by more than a radian it may move along any: these do not count.
    """
    moved = np.diff(trajectory.positions_m, axis=0)
    first, last = trajectory.poses[:-1, :3, :3], trajectory.poses[1:, :3, :3]
    cosine = (np.einsum("nij,nij->n", first, last) - 1) / 2
    body = np.einsum("nji,nj->ni", first, moved)[cosine > np.cos(MOST_TURN_RAD)]
    return int(np.argmax(np.sum(body**2, axis=0)))


def measures_attitude(trajectory: SpatialTrajectory) -> bool:
    """Whether rotations are measured: not one for all poses, unless the body only goes along its x.

    Programs that have positions alone write the same rotation, mostly none, in every row.
    """
    rotations = trajectory.poses[:, :3, :3]
    if np.abs(rotations - rotations[0]).max() > SAME_ROTATION:
        return True
    apart_m = (trajectory.positions_m - trajectory.positions_m[0]) @ rotations[0]
    return bool(np.ptp(apart_m[:, 1:], axis=0).max() <= ALONG * np.ptp(apart_m[:, 0]))


def doubt_of_axes(trajectory: SpatialTrajectory) -> str:
    """Why a trajectory seems not to have robot axes; empty where it seems to.

    A skid-steer robot moves most along x of its body. Of one without attitudes the plane in which
    it moves is judged alone.
    """
    if not measures_attitude(trajectory):
        across, up = np.ptp(trajectory.positions_m, axis=0)[1:]
        if up <= across:
            return ""
        return (
            "positions lie in the plane of x and z more than in that of x and y, as those of a "
            "camera do (z along the viewing direction, y down): these need --axes optical"
        )
    if (axis := travel_axis(trajectory)) == 0:
        return ""
    doubt = f"the body moves most along its {'xyz'[axis]} axis; expected x forward."
    extent_m = np.ptp(trajectory.positions_m, axis=0)
    if axis == 1 or extent_m[2] < LEVEL * extent_m[:2].max():
        body = "a sensor whose own axes are turned"
        if axis != 1:
            body = "a camera's optical frame (z along the viewing direction) in a map whose z is up"
        return f"{doubt} Poses of {body}: write those of the robot's base frame"
    return f"{doubt} Poses of a camera (z along the viewing direction, y down) need --axes optical"
