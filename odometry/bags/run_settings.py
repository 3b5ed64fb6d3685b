"""run.toml of an imported bag."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from odometry.bags.plan import Plan
from odometry.bags.rows.camera_info import camera_table, looks_along_z
from odometry.bags.topics.message_fields import FIX, body_frame
from odometry.bags.topics.robot_frame import HOW_HEIGHT
from odometry.bags.topics.survey import Survey
from odometry.bags.topics.topic_guess import RECTIFIED
from odometry.fixes.local_metres import LocalMetres
from odometry.geometry import se3
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA

HOW_MOUNT = (
    "Or find the mount: terrain-odometry camera RUN --from-motion --out camera --write; or give it "
    "there as measured: --mount X Y Z ROLL PITCH YAW"
)
NO_PLACE = 1e-9  # metres and radians that are not worth a line


def run_settings(
    plan: Plan, survey: Survey, local: LocalMetres, losses: Sequence[str]
) -> tuple[dict[str, Any], list[str]]:
    """Tables of run.toml, and what is to be said of them."""
    notes: list[str] = []
    settings: dict[str, Any] = {"robot": _robot(plan)}
    sensors = _sensors(plan, survey, notes)
    if sensors:
        settings["sensors"] = sensors
    camera = _camera(plan, survey, notes)
    if camera:
        settings["camera"] = camera
    settings["source"] = _source(plan, survey, local, losses)
    return settings, notes


def _robot(plan: Plan) -> dict[str, Any]:
    said = {
        "name": plan.robot.name,
        "track_width": plan.robot.track_width_m,
        "wheel_radius": plan.robot.wheel_radius_m,
        **plan.robot.size_m,
    }
    return {key: value for key, value in said.items() if value}


def _sensors(plan: Plan, survey: Survey, notes: list[str]) -> dict[str, list[float]]:
    sensors = {}
    if plan.reference:
        frame = plan.frames[plan.reference]
        pose = plan.robot.pose_of(frame, survey.robot)
        if pose is not None and abs(pose[:3, 3]).max() > NO_PLACE:
            sensors["pose"] = pose[:3, 3].tolist()
        elif pose is None:
            notes.append(
                f"{plan.reference}: where its frame {frame or '(not named)'} sits on the robot is "
                "not in the bag: its place is taken as the robot's origin; else write [sensors] "
                "pose = [x, y, z] to run.toml"
            )
    if plan.imu:
        frame = plan.frames[plan.imu]
        pose = plan.robot.pose_of(frame, survey.robot)
        if pose is None:
            notes.append(
                f"{plan.imu}: how its frame {frame or '(not named)'} is turned on the robot is not "
                "in the bag: its axes are taken as the robot's; else write [sensors] imu = [roll, "
                "pitch, yaw] to run.toml"
            )
        else:
            angles = se3.roll_pitch_yaw(pose[:3, :3])
            if abs(angles).max() > NO_PLACE:
                sensors["imu"] = angles.tolist()
    return sensors


def _camera(plan: Plan, survey: Survey, notes: list[str]) -> dict[str, Any]:
    if not plan.images:
        return {}
    if not plan.camera_info:
        notes.append(
            f"{plan.images}: there is no CameraInfo that goes with it, so that run.toml has no "
            "[camera]. Name one by --camera-info, or calibrate: terrain-odometry camera --help"
        )
        return {}
    info = survey.topics[plan.camera_info].sample
    frame = plan.frames[plan.images] or body_frame(info)
    pose = plan.robot.pose_of(frame, survey.robot)
    if pose is None:
        notes.append(
            f"{plan.images}: where its frame {frame or '(not named)'} sits on the robot is not in "
            f"the bag, so that [camera] has no mount. {HOW_MOUNT}"
        )
    elif not plan.robot.height_known:
        notes.append(
            f"{plan.images}: the height of {plan.robot.base} above the terrain is not known, so "
            "that [camera] has no mount. Add --frame-height METRES "
            f"({HOW_HEIGHT}). {HOW_MOUNT}"
        )
        pose = None
    elif not looks_along_z(pose):
        notes.append(
            f"{plan.images}: its frame {frame} has z upwards, as no optical frame has: its x axis "
            "is taken as the viewing direction"
        )
        pose = pose @ se3.pose(np.zeros(3), OPTICAL_FROM_CAMERA.T)
    rectified = bool(RECTIFIED.search(plan.images))
    table, said = camera_table(info, pose, rectified=rectified)
    notes += said
    return table


def _source(
    plan: Plan, survey: Survey, local: LocalMetres, losses: Sequence[str]
) -> dict[str, Any]:
    topics = {
        "wheels": plan.wheels.topic,
        "imu": plan.imu,
        "reference": plan.reference,
        "images": plan.images,
    }
    source: dict[str, Any] = {
        "bags": [file.path.name for file in survey.files],
        "topics": {role: name for role, name in topics.items() if name},
        **({"wheel_unit": plan.wheels.unit} if plan.wheels.unit else {}),
        "time": "header" if plan.by_header else "log",
        "notes": list(plan.notes),
        "lost": list(losses),
    }
    if local.origin is not None and survey.topics[plan.reference].message_type == FIX:
        latitude, longitude, altitude = local.origin
        source["origin"] = {"latitude": latitude, "longitude": longitude, "altitude": altitude}
    return source
