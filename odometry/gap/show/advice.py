"""What to do about a gap, and how far its answer can be relied on."""

from collections.abc import Sequence

from odometry.checks.findings.warned import sensor_faults
from odometry.effects.commands.drive_limit import DriveLimit
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.measurement.gyroscope_error import GyroscopeError
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.result import GapResult
from odometry.gap.show.unknown import how_to_separate, where_to_look

# Findings of the check, and the effects of which they are no rivals but the same.
SAME = {
    "treads_are_commands": frozenset({DriveLimit.name, CommandDelay.name, ActuatorLag.name}),
    "gyroscope_scale": frozenset({GyroscopeError.name}),
}


def what_to_do(result: GapResult) -> str:
    """Drives that distinguish rivals, the remedy, and measures that distinguish the rest."""
    between: dict[str, list[str]] = {}
    odds: dict[str, float] = {}
    for drive in result.next_drives:
        between.setdefault(drive.words, [drive.between[0]]).append(drive.between[1])
        odds[drive.words] = min(drive.odds, odds.get(drive.words, 1.0))
    drives = [
        f"To distinguish {name} from {listed(others, 'or')}: {words}, for a minute (decides in "
        f"{100 * odds[words]:.0f} % of cases)."
        for words, (name, *others) in between.items()
    ]
    if faults_of_sensors(result):
        drives.insert(0, "First correct what check warns of, and run gap again.")
    decided = {name for one in result.next_drives for name in one.between}
    measures = [
        f"If it is {one.name}: {one.told_apart_by}."
        if one.instead_of == "unknown"
        else f"What distinguishes {one.instead_of} from {one.name}: {one.told_apart_by}."
        for one in result.equivalent
        if one.name not in decided
    ]
    remedy = _remedy(result)
    if drives and result.verdict != "none":
        remedy = f"If it is {result.verdict}: {remedy[0].lower()}{remedy[1:]}"
    return " ".join([*drives, remedy, *measures])


def _remedy(result: GapResult) -> str:
    if not result.effects:
        return _of_nothing(result)
    if result.verdict == "unknown" and not result.depends_on:
        return "Look at the worst stretches in report.html, and record what may differ there."
    effects = [effect.added.effect for effect in result.effects]
    unknown = [effect for effect in effects if isinstance(effect, Residual)]
    remedies = [effect.remedy for effect in effects if not isinstance(effect, Residual)]
    said = "; ".join(dict.fromkeys([*remedies, *where_to_look(unknown)]))
    apart = how_to_separate(unknown)
    return f"{said[0].upper()}{said[1:]}.{' ' if apart else ''}{apart}"


def _of_nothing(result: GapResult) -> str:
    """What to do where nothing was added."""
    if is_not_held_out(result):
        return "Hold out whole runs that are driven as the measured ones are (--holdout)."
    if result.verdict == "unknown":
        return "Look at the worst stretches in report.html, and record what may differ there."
    if is_doubtful(result):
        return (
            "Do not rely on this: hold out whole runs with the same kind of drive "
            "(--holdout), and try again."
        )
    if is_closed_by_the_base(result):
        return "Identify the parameters on runs like the measured ones, and run gap again."
    return "Keep the model as it is."


def faults_of_sensors(result: GapResult) -> list[str]:
    """Findings of the check that may stand for what is named.

    That the columns hold commands is none of them where an effect of the drive is named first: it
    is what a drive does with commands. Nor is the scale of a gyroscope that is named.
    """
    found = sensor_faults(result.faults)
    return [one for one in found if result.verdict not in SAME.get(one, ())]


def is_not_held_out(result: GapResult) -> bool:
    """Whether the measured runs show what is unknown and the held-out data do not."""
    held = result.closings[1]
    return (
        result.verdict == "unknown"
        and is_doubtful(result)
        and not held.before.is_above(held.noise_floor)
    )


def is_doubtful(result: GapResult) -> bool:
    """Whether noise does not explain the measured runs, as they were: no "none" is sure then."""
    measured, _ = result.closings
    return measured.before.is_above(measured.noise_floor)


def is_closed_by_the_base(result: GapResult) -> bool:
    """Whether other values of the base, and no effect, surely lower the gap on held-out data."""
    held = result.closings[1]
    return not result.effects and held.after.high < held.before.low


def listed(names: Sequence[str], word: str = "and") -> str:
    """Names as a sentence lists them."""
    *others, last = names
    return f"{', '.join(others)} {word} {last}" if others else last
