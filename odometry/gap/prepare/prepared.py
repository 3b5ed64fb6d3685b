"""Runs made ready for a search: windows to fit and to evaluate, the base and its noise."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from odometry.gap.config import GapConfig
from odometry.gap.prepare.by_terrain import by_terrain
from odometry.gap.prepare.calibration import Calibration, calibrated
from odometry.gap.prepare.determined import require_determined
from odometry.gap.prepare.given_base import check_given, given_notes
from odometry.gap.prepare.held_out import Apart, held_out_pieces
from odometry.gap.prepare.outliers import Outliers
from odometry.gap.prepare.rounding import rounding_notes
from odometry.gap.prepare.scenes import (
    alike,
    dealt,
    for_chains,
    for_positions,
    scene_of,
    scenes_of,
    without_outliers,
)
from odometry.gap.prepare.statistic import Gap, Measure, floor_of
from odometry.identification.identify import robot_of
from odometry.models.base import KinematicModel
from odometry.positions.heading import headed
from odometry.recording.run import Run


@dataclass(frozen=True)
class Prepared:
    """What a gap is searched in.

    Attributes
    ----------
    config : GapConfig
        With the duration of windows that the poses allow.
    known : Calibration
        The base, and what it leaves of the calibration runs.
    scenes : (list of DenseWindows, list of DenseWindows)
        Of the measured runs, to fit, and of what is held out, without the poses that are far off.
    raw_scenes : (list of DenseWindows, list of DenseWindows)
        The same with all poses.
    outliers : Outliers or None
        The poses that were left out.
    has_yaw : bool
        Whether headings were measured, and not found from positions.
    notes : tuple of str
        What the reader should know of headings, given parameters and rounded positions.
    """

    config: GapConfig
    known: Calibration
    scenes: Apart
    raw_scenes: Apart
    outliers: Outliers | None
    has_yaw: bool
    notes: tuple[str, ...]

    def floor(self, measure: Measure = Measure.POSITION) -> Gap:
        """The noise floor of the calibration by a measure."""
        return floor_of(self.known.held_back, self.config.part_s, measure)


def prepared(
    measured: Sequence[Run],
    calibration: Sequence[Run],
    holdout: Sequence[Run],
    base: tuple[KinematicModel, Mapping[str, float] | None],
    config: GapConfig,
) -> Prepared:
    """Identify the base on the calibration, and take windows of all runs alike.

    `base` is the model, and its parameters where they are given. Where nothing is to be held out,
    pieces of the measured runs are.

    Raises
    ------
    GapError
        As `check_given` and `calibrated`.
    """
    model, given = base
    robot = robot_of([*calibration, *measured, *holdout])
    headings = headed([*measured, *calibration, *holdout])
    measured, calibration, holdout = dealt(headings.runs, len(measured), len(calibration))
    if given is not None and not headings.found:
        check_given(model, given, calibration)
    config = for_positions(for_chains(config, headings.runs), headings)
    known_scenes, whole, held = alike(
        [scene_of(run, config) for run in calibration],
        *scenes_of(measured, holdout, config),
    )
    known = calibrated(known_scenes, model, robot, config, given)
    if given is None:
        require_determined(known, whole)
    known = by_terrain(known, known_scenes, config)
    numbers = None if holdout else held_out_pieces(whole, config)
    raw_scenes, scenes, outliers = without_outliers(
        (measured, holdout), (whole, held), numbers, (known_scenes, known), config
    )
    of_given = () if given is None else given_notes(known, known_scenes, config.part_s)
    notes = (*headings.notes, *of_given, *rounding_notes(known_scenes, *scenes))
    return Prepared(config, known, scenes, raw_scenes, outliers, not headings.found, notes)
