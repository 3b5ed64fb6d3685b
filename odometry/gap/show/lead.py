"""The three sentences of a gap that a hurried reader should see."""

from collections.abc import Sequence

from odometry.checks.warned import sensor_faults
from odometry.effects.catalogue import EFFECTS
from odometry.effects.drive_limit import DriveLimit
from odometry.effects.late_treads import ActuatorLag, CommandDelay
from odometry.effects.reference_rounding import RoundedPositions
from odometry.effects.residual import Residual
from odometry.gap.answer.result import Equivalent, GapResult, NamedEffect
from odometry.gap.locate.region_words import noun_of_residual
from odometry.gap.name.verdict import Refusal
from odometry.gap.show.quantities import Share, held_out_share, metres, percent, with_interval

REFUSED = 2  # reasons that are given
COMMANDS = "treads_are_commands"  # a finding of the check
OF_DRIVE = frozenset({DriveLimit.name, CommandDelay.name, ActuatorLag.name})
OF_REFERENCE = frozenset(effect.name for effect in EFFECTS if effect.of_reference)


def lead(result: GapResult) -> tuple[str, str, str]:
    """What is missing, how sure that is, and what to do."""
    share = held_out_share(result)
    return _missing(result), _how_sure(result, share), _what_to_do(result)


def _missing(result: GapResult) -> str:
    model = result.calibration.base.model.name
    others = _instead(result.equivalent).get("unknown")
    if others:
        reasons = [one.reason for one in result.refusals if one.name in others]
        return f"Something is missing in {model} (unknown): {reasons[0]}."
    if not result.effects:
        return _nothing_named(result, model)
    kinds = [e.added.effect for e in result.effects]
    rest = list(dict.fromkeys(noun_of_residual(e) for e in kinds if isinstance(e, Residual)))
    named = [e for e in result.effects if not isinstance(e.added.effect, Residual)]
    if named:
        return _of_names(result, model, named, rest)
    refused = [one.name for one in result.refusals if one.name != Residual.name]
    if refused:
        return (
            f"Something is missing in {model} (unknown): it depends on {listed(rest)}, and no "
            f"effect of the catalogue passed every test (the nearest: {refused[0]})."
        )
    return (
        f"Something is missing in {model} that the catalogue of effects does not have "
        f"(unknown): it depends on {listed(rest)}."
    )


def _of_names(
    result: GapResult, model: str, named: Sequence[NamedEffect], rest: Sequence[str]
) -> str:
    """Of effects that have a name, beside what is unknown and depends on the `rest`."""
    names = listed([f"{e.added.in_words} ({e.added.effect.name})" for e in named])
    if result.verdict == "unknown":
        cause = f"it depends on {listed(rest)}" if rest else "nothing that was recorded explains it"
        return (
            f"Something is missing in {model} (unknown): {cause}; a smaller part of the gap is "
            f"{names}."
        )
    if rest:
        names += f", and something unknown that depends on {listed(rest)}"
    untold = "".join(
        f"; these runs do not distinguish {name} from {listed(others, 'or')}"
        for name, others in _instead(result.equivalent).items()
    )
    faults = _sensor_faults(result)
    if all(effect.added.effect.of_reference for effect in named) and not rest:
        return f"{_sensor(result, named)}: {names}{untold}."
    if faults:
        return (
            f"A sensor or the robot: {names}{untold}; {listed(faults)}, of which check warns in "
            "these recordings, may have the same effect."
        )
    return f"Missing in {model}: {names}{untold}."


def _sensor_faults(result: GapResult) -> list[str]:
    """Findings of the check that may stand for what is named.

    That the columns hold commands is none of them where an effect of the drive is named first: it
    is what a drive does with commands.
    """
    of_drive = result.verdict in OF_DRIVE
    return [one for one in sensor_faults(result.faults) if not (of_drive and one == COMMANDS)]


def _sensor(result: GapResult, named: Sequence[NamedEffect]) -> str:
    """Whether faults of the reference alone are named, or what a robot may do as well."""
    if any(one.name not in OF_REFERENCE for one in result.equivalent):
        return "A sensor or the robot"
    alike = [e.added.effect.robot_alike for e in named if e.added.effect.robot_alike]
    return (
        f"A sensor is at fault, or {alike[0]}" if alike else "A sensor is at fault, not the robot"
    )


def _instead(equivalent: Sequence[Equivalent]) -> dict[str, list[str]]:
    """Names of equivalents, by the name in whose place each may be."""
    places: dict[str, list[str]] = {}
    for one in equivalent:
        places.setdefault(one.instead_of, []).append(one.name)
    return places


def _nothing_named(result: GapResult, model: str) -> str:
    held = result.judged[1]
    if _is_not_held_out(result):
        return (
            f"Something is missing in {model} on the measured runs (unknown), and held-out data "
            f"do not show it{_refused(result)}."
        )
    if result.verdict == "unknown" and not (
        held.before.is_above(held.noise_floor) or _is_doubtful(result)
    ):
        return (
            f"Whether something is missing in {model} is undetermined (unknown): the gap on "
            f"held-out data is above the noise floor, though not surely{_refused(result)}."
        )
    if result.verdict == "unknown":
        return (
            f"Something is missing in {model} (unknown): neither an effect of the catalogue, nor "
            "a smooth function of what was recorded, nor a slow course in run time explains it. A "
            "reference that is noisier than in the calibration looks the same."
        )
    if not result.measured.before.has_interval:
        return (
            f"Whether something is missing in {model} is undetermined: the measured windows are "
            "one stretch, of which the gap has no interval."
        )
    if _is_doubtful(result):
        return (
            f"Nothing is missing in {model} that held-out data confirm (none), but the gap on the "
            f"measured runs is above the noise floor{_refused(result)}."
        )
    return f"Nothing that these runs could show is missing in {model} (none)."


def _refused(result: GapResult) -> str:
    names = list(dict.fromkeys(_named(one) for one in result.refusals))[:REFUSED]
    return f": {listed(names, 'or')} would close part of it there" if names else ""


def _how_sure(result: GapResult, share: Share | None) -> str:
    held = result.judged[1]
    what = f"The {held.before.measure.noun} on held-out data"
    if result.by_turns:
        apart, floor_m = (of.value for of in (result.holdout.before, result.holdout.noise_floor))
        what = (
            f"Positions hardly show it within {result.horizon_s:g} s ({metres(apart)}, by noise "
            f"alone {metres(floor_m)}). {what}"
        )
    floor = f"the noise floor is {with_interval(held.noise_floor)}"
    if not result.effects:
        return f"{what} is {with_interval(held.before)}; {floor}."
    if all(isinstance(effect.added.effect, RoundedPositions) for effect in result.effects):
        rest = ""
        if held.before.is_above(held.noise_floor):
            left_m = held.before.value - held.noise_floor.value
            rest = f", and {metres(left_m)} stays unexplained"
        return (
            f"The gap on held-out data is {with_interval(held.before)}; with the rounding {floor}"
            f"{rest}."
        )
    change = f"from {with_interval(held.before)} to {with_interval(held.after)}"
    if held.after.value > held.before.value:
        return f"{what} gets worse, {change}: do not trust the name."
    said = f"{what} falls {change}; {floor}"
    if share is None:
        said += ", which the gap before hardly exceeds"
    else:
        below = ", down to the noise" if share.value > 1 else ""
        said += f", so that {percent(share)} of the excess is closed{below}"
    if held.after.is_above(held.noise_floor):
        left = held.after.value - held.noise_floor.value
        said += f" and {left:.2g} {held.after.measure.unit} stays unexplained"
    return f"{said}."


def _what_to_do(result: GapResult) -> str:
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
    if _sensor_faults(result):
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
        if _is_not_held_out(result):
            return "Hold out runs that are driven as the measured ones are (--holdout)."
        if result.verdict == "unknown":
            return "Look at the worst stretches in report.html, and record what may differ there."
        if _is_doubtful(result):
            return (
                "Do not rely on this: hold out whole runs with the same kind of drive "
                "(--holdout), and try again."
            )
        return "Keep the model as it is."
    remedies = dict.fromkeys(effect.added.effect.remedy for effect in result.effects)
    return f"{'; '.join(remedies)}.".capitalize()


def _is_not_held_out(result: GapResult) -> bool:
    """Whether the measured runs show what is unknown and the held-out data do not."""
    held = result.judged[1]
    return (
        result.verdict == "unknown"
        and _is_doubtful(result)
        and held.before.low <= held.noise_floor.high
    )


def _is_doubtful(result: GapResult) -> bool:
    """Whether "none" is said of measured runs that noise does not explain."""
    measured, _ = result.judged
    return measured.before.is_above(measured.noise_floor)


def _named(refused: Refusal) -> str:
    return "a smooth function" if refused.name == Residual.name else refused.name


def listed(names: Sequence[str], word: str = "and") -> str:
    """Names as a sentence lists them."""
    *others, last = names
    return f"{', '.join(others)} {word} {last}" if others else last
