"""Which topic goes to which file of a run folder."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.bags.plan import Plan
from odometry.bags.rows.fix_rows import fix_reader, sensor_frame
from odometry.bags.rows.image_files import ImageFiles
from odometry.bags.rows.lens_watch import LensWatch
from odometry.bags.rows.ordered_rows import OrderedRows
from odometry.bags.rows.places_watch import PlacesWatch
from odometry.bags.rows.pose_rows import (
    POSE_COLUMNS,
    Attitudes,
    AttitudesOf,
    PosesOfRobot,
    point_row,
    pose_reader,
    positions_alone,
    turns,
)
from odometry.bags.rows.streams import Consumer, Images, Rows, Stream, TransformRows
from odometry.bags.topics.imu_fields import FORCE, RATE, measures
from odometry.bags.topics.message_fields import FIX, POINT, TRANSFORM_LISTS, body_frame, check_frame
from odometry.bags.topics.survey import Survey
from odometry.bags.topics.transforms import TransformPoses
from odometry.bags.wheels.speeds import TreadSpeeds, row_reader
from odometry.fixes.local_metres import LocalMetres

IMU_COLUMNS = ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")
OTHER = "other_odometry"


@dataclass(frozen=True)
class Learned:
    """What streams learn on their way.

    Attributes
    ----------
    speeds : TreadSpeeds
        Whether the wheels of a side agree.
    local : LocalMetres
        The origin of satellite fixes.
    attitudes : Attitudes
        Those of the robot.
    lens : LensWatch
        Whether the calibration of the camera stays.
    places : PlacesWatch
        Whether velocities of joints are those of their positions.
    """

    speeds: TreadSpeeds
    local: LocalMetres
    attitudes: Attitudes
    lens: LensWatch
    places: PlacesWatch


def make_streams(
    plan: Plan, survey: Survey, folder: Path, learned: Learned
) -> dict[str, list[Consumer]]:
    """Streams by topic, which fill what is learned."""
    streams: dict[str, list[Consumer]] = {}
    made: list[Consumer] = [_wheels(plan, survey, folder, learned.speeds)]
    wheels = plan.wheels
    is_stated = wheels.values_stated or wheels.unit_stated
    if wheels.kind == "joints" and wheels.speeds and not is_stated:
        made.append(learned.places)
    if plan.imu:
        made.append(_imu(plan, survey, folder, learned.attitudes))
    if plan.reference:
        made.append(_reference(plan, survey, folder, learned.local))
    if plan.images:
        made.append(Images(plan.images, ImageFiles(folder), by_header=plan.by_header))
    if plan.camera_info:
        made.append(learned.lens)
    made += [_other(topic, plan, survey, folder) for topic in plan.other_odometry]
    for stream in made:
        streams.setdefault(stream.topic, []).append(stream)
    return streams


def _wheels(plan: Plan, survey: Survey, folder: Path, speeds: TreadSpeeds) -> Stream:
    source = plan.wheels
    rows = OrderedRows(folder / "odometry.csv", ("v_left", "v_right"), speeds, 2)
    read = row_reader(source, survey.topics[source.topic].message_type)
    return Rows(source.topic, "odometry.csv", rows, read, by_header=plan.by_header)


def _imu(plan: Plan, survey: Survey, folder: Path, attitudes: Attitudes) -> Stream:
    topic = survey.topics[plan.imu]
    taken = sensor_frame(topic, plan.frames.get(plan.imu, ""))
    gyro, accel = measures(topic, RATE), measures(topic, FORCE)
    # REP-145: a covariance that begins with -1 says that the sensor does not measure this
    turned = topic.sample.orientation_covariance[0] != -1
    names = IMU_COLUMNS[: 3 * gyro] + IMU_COLUMNS[3 : 3 + 3 * accel]

    def read(message: Any) -> tuple[float, ...]:
        check_frame(message, taken, "inertial sensor", "imu")
        rate, force, turn = (
            message.angular_velocity,
            message.linear_acceleration,
            message.orientation,
        )
        rates = (rate.x, rate.y, rate.z) if gyro else ()
        forces = (force.x, force.y, force.z) if accel else ()
        return (*rates, *forces, turn.w, turn.x, turn.y, turn.z)

    def columns(stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        values = rows[:, : len(names)]
        if turned:
            attitudes.add(stamps_ns, rows[:, len(names) :], values[:, 3 * gyro :])
        return stamps_ns, values

    rows = OrderedRows(folder / "imu.csv", names, columns, 0)
    return Rows(plan.imu, "imu.csv", rows, read, by_header=plan.by_header)


def _reference(plan: Plan, survey: Survey, folder: Path, local: LocalMetres) -> Stream:
    topic, file = survey.topics[plan.reference], folder / "pose.csv"
    if topic.message_type == FIX:
        rows = OrderedRows(file, ("x", "y", "yaw", "z"), local, 2)
        read = fix_reader(topic, plan.frames.get(topic.name, ""))
        return Rows(topic.name, "pose.csv", rows, read, by_header=plan.by_header)
    if topic.message_type == POINT:
        rows = OrderedRows(file, ("x", "y", "yaw", "z"), positions_alone, 2)
        return Rows(topic.name, "pose.csv", rows, point_row, by_header=plan.by_header)
    frame = plan.frames.get(topic.name, "")
    pose = plan.robot.pose_of(frame, survey.robot)
    measured = topic.message_type in TRANSFORM_LISTS or turns(topic)
    turned = AttitudesOf(np.eye(4) if pose is None else pose, measured=measured)
    rows = OrderedRows(file, POSE_COLUMNS, turned, 2)
    if topic.message_type in TRANSFORM_LISTS:
        poses = TransformPoses(plan.world, frame, survey.robot.fixed)
        return TransformRows(topic.name, "pose.csv", rows, poses, by_header=plan.by_header)
    read = pose_reader(topic)
    return Rows(topic.name, "pose.csv", rows, read, by_header=plan.by_header)


def _other(name: str, plan: Plan, survey: Survey, folder: Path) -> Stream:
    topic = survey.topics[name]
    pose = plan.robot.pose_of(body_frame(topic.sample), survey.robot)
    plain = [_plain(one) for one in plan.other_odometry]
    again = plain[: plan.other_odometry.index(name)].count(_plain(name))
    file = f"{OTHER}/{_plain(name)}{f'_{again + 1}' if again else ''}.csv"
    columns = PosesOfRobot(np.eye(4) if pose is None else pose)
    rows = OrderedRows(folder / file, ("x", "y", "yaw"), columns, 3)
    return Rows(name, file, rows, pose_reader(topic), by_header=plan.by_header)


def _plain(topic: str) -> str:
    """A topic's name as that of a file."""
    return re.sub(r"[^A-Za-z0-9.-]+", "_", topic).strip("_.") or "odometry"
