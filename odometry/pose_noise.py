"""Positions that scatter by more than the filter was told: single-point GNSS."""

from dataclasses import replace

from odometry.checks.evidence import Evidence
from odometry.checks.position_noise import position_noise_m
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.run import Run


def with_pose_noise(run: Run, config: IcrEkfConfig) -> tuple[IcrEkfConfig, tuple[FilterEvent, ...]]:
    """The settings of a filter with the noise of the positions of a run.

    The noise counts where the positions show it for certain, and where it is more than
    `position_sigma_m`: a filter that trusts them too far follows their noise, and learns ICRs
    from it. Unless `config` is `causal` or does not watch its sensors.

    Returns
    -------
    IcrEkfConfig
    tuple of FilterEvent
        One where the setting was changed.
    """
    if run.pose is None or config.causal or not config.watch_sensors:
        return config, ()
    evidence = Evidence(run)
    used = evidence.poses_used
    if used is None:
        return config, ()
    stamps_s = run.pose.stamps_s[used]
    sigma_m = position_noise_m(evidence, stamps_s, run.pose.stack("x", "y")[used])
    if sigma_m is None or sigma_m <= config.position_sigma_m:
        return config, ()
    event = FilterEvent(
        "noisy_positions",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"positions scatter by {sigma_m:.2g} m: that is their noise in the filter, in place of "
        f"{config.position_sigma_m:g} m",
        (sigma_m,),
    )
    return replace(config, position_sigma_m=sigma_m), (event,)
