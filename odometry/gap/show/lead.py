"""The three sentences of a gap that a hurried reader should see."""

from collections.abc import Sequence

from odometry.effects.catalogue import EFFECTS
from odometry.effects.measurement.reference_rounding import RoundedPositions
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.result import Equivalent, GapResult, NamedEffect
from odometry.gap.locate.region_words import noun_of_residual
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.statistic import MANY
from odometry.gap.show.advice import (
    faults_of_sensors,
    is_closed_by_the_base,
    is_doubtful,
    is_not_held_out,
    listed,
    what_to_do,
)
from odometry.gap.show.quantities import (
    Share,
    held_out_share,
    of_two_figures,
    percent,
    with_interval,
)

REFUSED = 2  # reasons that are given
OF_REFERENCE = frozenset(effect.name for effect in EFFECTS if effect.of_reference)


def lead(result: GapResult) -> tuple[str, str, str]:
    """What is missing, how sure that is, and what to do."""
    share = held_out_share(result)
    return _missing(result), _how_sure(result, share), what_to_do(result)


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
    refused = list(dict.fromkeys(o.name for o in result.refusals if o.name != Residual.name))
    if refused:
        return (
            f"Something is missing in {model} (unknown): it depends on {listed(rest)}, and no "
            f"effect of the catalogue passed every test (refused: {listed(refused[:REFUSED])})."
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
    faults = faults_of_sensors(result)
    if all(effect.added.effect.of_reference for effect in named) and not rest:
        return f"{_sensor(result, named)}: {names}{untold}."
    if faults:
        return (
            f"A sensor or the robot: {names}{untold}; {listed(faults)}, of which check warns in "
            "these recordings, may have the same effect."
        )
    return f"Missing in {model}: {names}{untold}."


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
    held = result.closings[1]
    if is_not_held_out(result):
        return (
            f"Something is missing in {model} on the measured runs (unknown), and held-out data "
            f"do not show it{_refused(result)}."
        )
    if result.verdict == "unknown" and not (
        held.before.is_above(held.noise_floor) or is_doubtful(result)
    ):
        return (
            f"Whether something is missing in {model} is undetermined (unknown): the "
            f"{held.before.measure.noun} on held-out data is above the noise floor, though not "
            f"surely{_refused(result)}."
        )
    if result.verdict == "unknown":
        return (
            f"Something is missing in {model} (unknown): neither an effect of the catalogue, nor "
            "a smooth function of what was recorded, nor a slow course in run time surely explains "
            "it. A reference that is noisier than in the calibration looks the same."
        )
    return _none(result, model)


def _none(result: GapResult, model: str) -> str:
    held = result.closings[1]
    if not result.measured.before.has_interval:
        return (
            f"Whether something is missing in {model} is undetermined: the measured windows are "
            "one stretch, of which the gap has no interval."
        )
    if is_doubtful(result):
        return (
            f"Nothing is missing in {model} that held-out data confirm (none), but the "
            f"{held.before.measure.noun} on the measured runs is above the noise "
            f"floor{_refused(result)}."
        )
    if is_closed_by_the_base(result):
        return (
            f"Nothing is missing in {model} by the noise floor (none), but other values of its "
            f"parameters lower the {held.before.measure.noun} on held-out data from "
            f"{of_two_figures(held.before)} to {of_two_figures(held.after)}: the calibration runs, "
            "which the floor is of, are noisier than these, or they differ."
        )
    return f"Nothing that these runs could show is missing in {model} (none)."


def _refused(result: GapResult) -> str:
    names = list(dict.fromkeys(_named(one) for one in result.refusals))[:REFUSED]
    return f": {listed(names, 'or')} would close part of it there" if names else ""


def _how_sure(result: GapResult, share: Share | None) -> str:
    held = result.closings[1]
    what = f"The {held.before.measure.noun} on held-out data"
    if result.turns:
        apart, by_noise = result.holdout.before, result.holdout.noise_floor
        how = "hardly" if apart.value < 2 * by_noise.value else "do not surely"
        what = (
            f"Positions {how} show it within {result.horizon_s:g} s ({of_two_figures(apart)}, by "
            f"noise alone {of_two_figures(by_noise)}). {what}"
        )
    floor = f"the noise floor is {with_interval(held.noise_floor)}"
    if not result.effects:
        as_measured = of_two_figures(result.closings[0].before)
        there = f", on the measured runs {as_measured}" if is_not_held_out(result) else ""
        return f"{what} is {with_interval(held.before)}{there}; {floor}."
    if all(isinstance(effect.added.effect, RoundedPositions) for effect in result.effects):
        rest = ""
        if held.before.is_above(held.noise_floor):
            left = held.before.value - held.noise_floor.value
            rest = f", and {left:.2g} {held.before.measure.unit} stays unexplained"
        return f"{what} is {with_interval(held.before)}; with the rounding {floor}{rest}."
    change = f"from {with_interval(held.before)} to {with_interval(held.after)}"
    if held.after.value > held.before.value:
        return f"{what} gets worse, {change}: do not trust the name."
    said = f"{what} falls {change}; {floor}"
    if share is None and is_doubtful(result):
        fitted = result.closings[0]
        few = " on so few stretches" if held.before.pieces < MANY else ""
        said += (
            f", too near for a share{few}; the measured runs had {of_two_figures(fitted.before)}, "
            f"have {of_two_figures(fitted.after)}, and their noise floor is "
            f"{of_two_figures(fitted.noise_floor)}"
        )
    elif share is None:
        said += ", which the gap before hardly exceeds"
    else:
        below = ", down to the noise" if share.value > 1 else ""
        said += f", so that {percent(share)} of the excess is closed{below}"
    if held.after.is_above(held.noise_floor):
        left = held.after.value - held.noise_floor.value
        said += f"{' and' if share else '; held out,'} {left:.2g} {held.after.measure.unit} stays "
        said += "unexplained"
    return f"{said}."


def _named(refused: Refusal) -> str:
    return "a smooth function" if refused.name == Residual.name else refused.name
