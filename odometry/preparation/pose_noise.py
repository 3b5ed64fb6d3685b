"""Noise of poses that the recording shows: of scatter, of rounding, of interpolation."""

import math
from dataclasses import replace

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.poses.position_noise import position_noise_m
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.preparation.lasting_errors import lasting_sigma_m
from odometry.preparation.rounded_positions import with_rounding
from odometry.preparation.wander_at_rest import wander_sigma_m
from odometry.recording.run import Run
from odometry.windows.recorded.interpolated import poses_per_measured_one

Noise = tuple[IcrEkfConfig, tuple[FilterEvent, ...]]


def with_pose_noise(run: Run, config: IcrEkfConfig) -> Noise:
    """The settings of a filter with the noise of the poses of a run.

    The noise of positions counts where they show it for certain, and where it is more than
    `position_sigma_m`: a filter that trusts them too far follows their noise, and learns ICRs
    from it. Where positions were rounded and that is more than their scatter, it counts instead.
    Where n poses were interpolated from one measurement, its variance is n times as large:
    together they say what one measured pose says. Unless `config` is `causal` or does not watch
    its sensors.

    Returns
    -------
    IcrEkfConfig
    tuple of FilterEvent
        One for each change of a setting.
    """
    if run.pose is None or config.causal or not config.watch_sensors:
        return config, ()
    evidence = Evidence(run)
    used = evidence.poses_used
    if used is None:
        return config, ()
    stamps_s, positions = run.pose.stamps_s[used], run.pose.stack("x", "y")[used]
    rounded, of_rounding = with_rounding(stamps_s, positions, config)
    # a second difference of rounded positions makes at most 0.6 of their step of scatter
    least_m = max(rounded.position_sigma_m, rounded.position_step_m)
    config, noticed = _scattered(evidence, stamps_s, positions, config, least_m)
    if not noticed:
        config, noticed = rounded, of_rounding
    config, wandering = _wandering(evidence.run, stamps_s, positions, config)
    noticed = (*noticed, *wandering)
    count = poses_per_measured_one(stamps_s, positions)
    if count == 1:
        return config, noticed
    event = FilterEvent(
        "interpolated_poses",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"{count:.0f} poses were interpolated from each measured one: together they count as one",
        (count,),
    )
    return replace(
        config,
        position_sigma_m=config.position_sigma_m * math.sqrt(count),
        yaw_sigma_rad=config.yaw_sigma_rad * math.sqrt(count),
    ), (*noticed, event)


def _scattered(
    evidence: Evidence,
    stamps_s: FloatArray,
    positions: FloatArray,
    config: IcrEkfConfig,
    least_m: float,
) -> Noise:
    """With the scatter of positions (M, 2) as their noise, where it is more than `least_m`."""
    sigma_m = position_noise_m(evidence, stamps_s, positions)
    if sigma_m is None or sigma_m <= least_m:
        return config, ()
    lasting_m = config.lasting_sigma_m
    if not lasting_m:
        lasting_m = lasting_sigma_m(evidence.run, stamps_s, positions, sigma_m)
    event = FilterEvent(
        "noisy_positions",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"positions scatter by {sigma_m:.2g} m: that is their noise in the filter, in place of "
        f"{config.position_sigma_m:g} m. Errors that last (satellites, reflections) may come on "
        f"top: the sigmas of x and y hold {lasting_m:.2g} m of them",
        (sigma_m, lasting_m),
    )
    return replace(config, position_sigma_m=sigma_m, lasting_sigma_m=lasting_m), (event,)


def _wandering(
    run: Run, stamps_s: FloatArray, positions: FloatArray, config: IcrEkfConfig
) -> Noise:
    """With errors of positions (M, 2) that last, where they wander while the treads stand."""
    lasting_m = wander_sigma_m(run, stamps_s, positions)
    if lasting_m is None or lasting_m <= max(config.lasting_sigma_m, config.position_sigma_m):
        return config, ()
    event = FilterEvent(
        "wandering_positions",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        "positions wander while the treads stand: their errors last (satellites, a receiver that "
        f"smooths), unless something else moves the robot. The sigmas of x and y hold "
        f"{lasting_m:.2g} m of them, if they last for a minute or so",
        (lasting_m,),
    )
    return replace(config, lasting_sigma_m=lasting_m), (event,)
