"""What a gap result says in sentences."""

from collections.abc import Iterator, Sequence

from odometry.effects.residual import Residual
from odometry.gap.closed import Share, held_out_share
from odometry.gap.region_words import EVERYWHERE, noun_of
from odometry.gap.result import GapResult, NamedEffect
from odometry.gap.statistic import MANY, Gap

REGIONS, VARIABLES = 2, 4  # said of them all
SHORT = 4  # parameters that are said one by one


def sentences(result: GapResult) -> tuple[str, ...]:
    """What disagrees and where, what explains it, how much that closes, and what is left.

    The first is the one that a hurried reader should see.
    """
    share = held_out_share(result)
    return (
        _verdict(result, share),
        _disagreement(result),
        *_where(result),
        *(_effect(effect, number) for number, effect in enumerate(result.effects, start=1)),
        *_equivalents(result),
        *_left(result, share),
    )


def metres(value: float) -> str:
    """A length of three figures."""
    return f"{value:.3g} m"


def with_interval(gap: Gap) -> str:
    """A gap and its 95 % interval, and from how many stretches that comes where they are few."""
    return f"{gap.value:.3g} m ({_interval(f'{gap.low:.3g} to {gap.high:.3g}', gap.pieces)})"


def percent(share: Share) -> str:
    """A share and its 95 % interval, as `with_interval` says it."""
    interval = f"{100 * share.low:.0f} to {100 * share.high:.0f}"
    return f"{100 * share.value:.0f} % ({_interval(interval, share.pieces)})"


def _interval(words: str, pieces: int) -> str:
    if pieces < 2:
        return "no interval can be told from one stretch"
    return words if pieces >= MANY else f"{words}, from {pieces} stretches alone"


def effect_words(effect: NamedEffect) -> str:
    """An effect by name and form."""
    if isinstance(effect.added.effect, Residual):
        return f"a smooth function of {noun_of(effect.added.effect.variable)}"
    return f"{effect.added.effect.name} ({effect.added.effect.form.replace('_', ' ')})"


def _verdict(result: GapResult, share: Share | None) -> str:
    model = result.calibration.base.model.name
    if not result.effects:
        if result.verdict == "unknown":
            return (
                f"Something is missing in {model} that neither an effect of the catalogue nor a "
                "smooth function of what was recorded explains with enough evidence."
            )
        if not result.measured.before.has_interval:
            return (
                f"Whether something is missing in {model} cannot be told: the measured windows "
                "are one stretch, of which the gap has no interval."
            )
        if result.measured.before.is_above(result.measured.noise_floor):
            return (
                f"Nothing that these runs could show is missing in {model} with enough evidence, "
                "but the gap is above the noise floor."
            )
        return f"Nothing that these runs could show is missing in {model}: noise explains the gap."
    closes = "" if share is None else f"; it closes {percent(share)} of the held-out excess"
    named = [e for e in result.effects if not isinstance(e.added.effect, Residual)]
    rest = [e for e in result.effects if isinstance(e.added.effect, Residual)]
    if not named:
        what = _listed([noun_of(_variable(effect)) for effect in rest])
        return (
            f"Something is missing in {model} that no effect of the catalogue explains; it follows "
            f"{what}{closes.replace('it closes', 'a smooth term closes')}."
        )
    names = _listed([effect.added.effect.name for effect in named])
    if rest:
        names += f", and something unknown that follows {noun_of(_variable(rest[0]))}"
    if len(result.effects) > 1:
        closes = closes.replace("it closes", "together they close")
    return f"Missing in {model}: {names}{closes}."


def _listed(names: Sequence[str]) -> str:
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def _variable(effect: NamedEffect) -> str:
    kind = effect.added.effect
    return kind.variable if isinstance(kind, Residual) else ""


def _disagreement(result: GapResult) -> str:
    held, measured = with_interval(result.holdout.before), with_interval(result.measured.before)
    return (
        f"Over windows of {result.horizon_s:g} s the simulated position ends {held} from the "
        f"measured one on what was held out, and {measured} on the measured runs; noise explains "
        f"{with_interval(result.holdout.noise_floor)}. These are root mean squares; in brackets "
        "95 % intervals."
    )


def _where(result: GapResult) -> Iterator[str]:
    location = result.location
    found = [noun_of(one.name) for one in location.predictors if one.discovered]
    if found:
        more = len(found) - VARIABLES
        others = f", and {more} more that go with them" if more > 0 else ""
        yield f"What predicts the disagreement: {', '.join(found[:VARIABLES])}{others}."
    elif location.predictors:
        yield "None of the recorded variables predicts the disagreement beyond chance."
    for number, region in enumerate(location.regions[:REGIONS]):
        if region.words == EVERYWHERE:
            yield f"It is everywhere alike: {metres(region.excess_m)} above the noise floor."
            continue
        which = "The largest share" if number == 0 else "The next"
        yield (
            f"{which}, {100 * region.share:.0f} % of the excess: {region.words}; there it is "
            f"{metres(region.excess_m)} above the noise floor."
        )


def _effect(effect: NamedEffect, number: int) -> str:
    kind = effect.added.effect
    place = f"Effect {number}, {effect_words(effect)}, acts on the {kind.acts_on}"
    gap = (
        f"on the measured runs the gap goes from {metres(effect.gap_before)} to "
        f"{metres(effect.gap_after)} (evidence {effect.evidence:.0f})"
    )
    if len(effect.added.values) > SHORT or isinstance(kind, Residual):
        return f"{place} with {len(effect.added.values)} parameters; {gap}."
    return f"{place}: {', '.join(parameter_words(effect))}; {gap}."


def parameter_words(effect: NamedEffect) -> Sequence[str]:
    """Each parameter with its 95 % interval."""
    added = effect.added
    return [
        f"{p.name} = {value:.4g}{' ' + p.unit if p.unit else ''} ({low:.4g} to {high:.4g})"
        for p, value, low, high in zip(
            added.effect.parameters, added.values, effect.low, effect.high, strict=True
        )
    ]


def _equivalents(result: GapResult) -> Iterator[str]:
    for one in result.equivalent:
        yield (
            f"The data cannot tell {one.instead_of} from {one.name}; what would: "
            f"{one.told_apart_by}."
        )


def _left(result: GapResult, share: Share | None) -> Iterator[str]:
    held = result.holdout
    if not result.effects:
        return
    before, after = with_interval(held.before), with_interval(held.after)
    falls = f"On what was held out the gap goes from {before} to {after}"
    if share is None:
        yield f"{falls}; it was hardly above the noise floor before, so that no share is stated."
    else:
        yield f"{falls}: {percent(share)} of its excess above the noise floor is closed."
    if not held.after.is_above(held.noise_floor):
        yield "What is left cannot be told from noise."
    else:
        left = held.after.value - held.noise_floor.value
        yield f"Left unexplained: {metres(left)} above the noise floor."
