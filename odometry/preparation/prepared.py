"""A run as the filter takes it, and the settings of the filter that the recording shows."""

from collections.abc import Sequence

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.measured import robot_run
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.speed_step import with_speed_step
from odometry.preparation.even_rows import with_even_rows
from odometry.preparation.pose_delay import without_pose_delay
from odometry.preparation.pose_noise import with_pose_noise
from odometry.preparation.row_rates import with_row_rates
from odometry.recording.run import Run
from odometry.windows.recorded.measured_poses import lacks_yaw


def prepared_run(
    run: Run, config: IcrEkfConfig, effects: Sequence[Added]
) -> tuple[Run, IcrEkfConfig, tuple[FilterEvent, ...]]:
    """The run and the settings of its filter, by what it shows, and what was noticed.

    `effects` are those of the sensors.
    """
    run, even = with_even_rows(run, config)
    # the filter itself undoes the lever arm of positions, and in time of all poses
    if effects or not (config.causal or lacks_yaw(run)):
        run = robot_run(run, effects)
    run, of_rows = with_row_rates(run, config)
    run, late = without_pose_delay(run, config)
    config, noisy = with_pose_noise(run, config)
    config, coarse = with_speed_step(run, config)
    return run, config, (*even, *of_rows, *late, *noisy, *coarse)
