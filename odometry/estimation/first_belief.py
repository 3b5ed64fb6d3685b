"""The estimate of a filter at its first frame."""

import math

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.course import UNKNOWN_YAW_VARIANCE, Course
from odometry.estimation.estimate import OF_TERRAIN, IcrBelief
from odometry.estimation.measurement import Gaussian, Place, reference_point
from odometry.estimation.terrain_beliefs import OF_TERRAIN_BLOCK
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW
from odometry.frames import Frame


def first_belief(
    frame: Frame,
    of_terrain: IcrBelief,
    pose_covariance: FloatArray,
    lever_m: Place,
    *,
    bias_sigma_rad_s: float,
    yaw_sigma_rad: float | None,
) -> tuple[Gaussian, Course | None]:
    """Mean (9,) and covariance (9, 9), and the search for the heading where that is not known.

    Parameters
    ----------
    frame : Frame
        Where it has no pose, the filter starts at the origin.
    of_terrain : IcrBelief
    pose_covariance : (3, 3)
        Of a measured pose.
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    bias_sigma_rad_s : float
        Standard deviation of the gyroscope's bias; 0 where it is not used.
    yaw_sigma_rad : float, optional
        Standard deviation of the yaw where it is not that of a measured one.
    """
    pose = np.full(3, math.nan) if frame.pose is None else frame.pose
    pose = np.where(np.isfinite(pose), pose, math.nan)
    placed, headed = not np.isnan(pose[:2]).any(), not math.isnan(pose[YAW])
    mean, covariance = np.zeros(STATES), np.zeros((STATES, STATES))
    covariance[:3, :3] = pose_covariance
    if headed:
        mean[YAW] = pose[YAW]
    if placed:
        mean[:2] = pose[:2] - reference_point(mean, lever_m)
    course = None
    if placed and not headed:
        course = Course.begun(frame.stamp_s, pose[:2], pose[:2])
        covariance[YAW, YAW] = UNKNOWN_YAW_VARIANCE
    elif yaw_sigma_rad is not None:
        covariance[YAW, YAW] = yaw_sigma_rad**2
    mean[OF_TERRAIN] = *of_terrain.icrs, *of_terrain.alphas
    covariance[OF_TERRAIN_BLOCK] = of_terrain.covariance
    covariance[GYRO_BIAS, GYRO_BIAS] = bias_sigma_rad_s**2
    return (mean, covariance), course
