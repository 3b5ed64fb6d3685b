"""Whether parameters that are given for the base fit the calibration runs."""

from collections.abc import Mapping, Sequence

from odometry.errors import GapError, WindowError
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.statistic import floor_of, gap_of
from odometry.models.base import KinematicModel
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.dense.dense import DenseWindows
from odometry.windows.travel.motion_ratios import FEWEST_WINDOWS, HORIZON_M, motion_ratios
from odometry.windows.travel.windows import windows_of


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


def given_notes(
    known: Calibration, scenes: Sequence[DenseWindows], part_s: float
) -> tuple[str, ...]:
    """A sentence where given parameters leave surely more of the calibration runs than noise does.

    Less than `check_given` refuses: another day, or an effect that they lack on purpose.
    """
    own, floor = gap_of(known.base, (), scenes, part_s), floor_of(known.held_back, part_s)
    if own.low <= floor.high:
        return ()
    return (
        f"on the calibration runs, too, the given parameters leave {own.value:.2g} m (by noise "
        f"alone {floor.value:.2g} m): what is named may be theirs, and none of the measured runs",
    )
