"""By which error a gap is judged: that of positions, or another that shows it where they do not."""

from collections.abc import Sequence

from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.statistic import Gap, Measure, Shown, floor_of, floor_there, gap_of
from odometry.windows.dense.dense import DenseWindows


def measures_of(
    known: Calibration,
    measured: Sequence[DenseWindows],
    held_out: Sequence[DenseWindows],
    config: GapConfig,
    *,
    has_yaw: bool,
) -> tuple[Measure, ...]:
    """Positions, but where these hardly differ from noise, and another measure surely does.

    Over two seconds a robot that turns otherwise may be off by less than the noise of its
    positions, and by many times that of its heading; a gyroscope at fault moves neither. By its
    error alone nothing is missing in a model: positions follow it, where it gives nothing a name.
    """
    gap, floor = on_runs(known, held_out, config, Measure.POSITION)
    if gap.value > max(config.hardly * floor.value, floor.value + gap.doubt_above(floor)):
        return (Measure.POSITION,)
    for measure in other_measures(measured, held_out, has_yaw=has_yaw):
        shown = Shown(*(on_runs(known, scenes, config, measure) for scenes in (held_out, measured)))
        far = all(
            gap.value > config.turns_times * floor.value
            for gap, floor in (shown.held_out, shown.measured)
        )
        if far and shown.is_sure(config.turns_above):
            return (measure,) if measure is Measure.HEADING else (measure, Measure.POSITION)
    return (Measure.POSITION,)


def shown_as_measured(
    known: Calibration,
    measured: Sequence[DenseWindows],
    held_out: Sequence[DenseWindows],
    config: GapConfig,
    *,
    has_yaw: bool,
) -> Measure | None:
    """A measure besides positions that shows a gap on the measured runs, whatever is held out.

    A gyroscope that warms up in the first minute is off there, and hardly in the pieces held out.
    """
    for measure in other_measures(measured, held_out, has_yaw=has_yaw):
        if is_shown(*on_runs(known, measured, config, measure), config):
            return measure
    return None


def is_shown(gap: Gap, floor: Gap, config: GapConfig) -> bool:
    """Whether an error of headings or of the gyroscope is far above its floor, and surely so."""
    far = gap.value > config.turns_times * floor.value
    return far and gap.is_surely_above(floor, config.turns_above)


def other_measures(
    measured: Sequence[DenseWindows], held_out: Sequence[DenseWindows], *, has_yaw: bool
) -> list[Measure]:
    """What was measured of the motion besides positions."""
    others = [Measure.HEADING] if has_yaw else []
    if all(scene.reported_turns is not None for scene in (*measured, *held_out)):
        others.append(Measure.GYROSCOPE)
    return others


def on_runs(
    known: Calibration,
    scenes: Sequence[DenseWindows],
    config: GapConfig,
    measure: Measure,
    model: tuple[Base, Sequence[Added]] | None = None,
) -> tuple[Gap, Gap]:
    """The gap of a base and its effects, the calibrated base where absent, and its noise floor."""
    base, effects = model or (known.base, ())
    floor = floor_of(known.held_back, config.part_s, measure)
    gap = gap_of(base, effects, scenes, config.part_s, measure)
    return gap, floor_there(floor, known, scenes, config)
