"""Whether parameters that are given for the base fit the calibration runs."""

from collections.abc import Mapping, Sequence

from odometry.errors import GapError, WindowError
from odometry.models.base import KinematicModel
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.motion_ratios import FEWEST_WINDOWS, HORIZON_M, motion_ratios
from odometry.windows.windows import windows_of


def check_given(
    model: KinematicModel, given: Mapping[str, float], calibration: Sequence[Run]
) -> None:
    """Refuse parameters by which the calibration runs turn, or go, surely otherwise.

    What they lack there as well is not what the measured runs lack.

    Parameters
    ----------
    model : KinematicModel
    given : Mapping of name to float
    calibration : sequence of Run
        Whose yaw was measured.

    Raises
    ------
    GapError
        If turns are off by more than a quarter, or the way by more than 15 %.
    """
    try:
        windows = windows_of(calibration, WindowConfig(horizon_m=HORIZON_M))
    except WindowError:
        return
    if len(windows) < FEWEST_WINDOWS:
        return
    words = motion_ratios(model, model.pack(given), windows).words
    if words:
        raise GapError(
            f"on the calibration runs the robot {words} as far as the given parameters say "
            f"({len(windows)} windows of {HORIZON_M:g} m): they are of another robot, terrain or "
            "unit, and a gap would be mostly theirs. Identify the model on the calibration runs "
            f"(--model {model.name}), or calibrate on runs that the set fits"
        )
