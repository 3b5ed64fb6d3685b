"""Whether the runs of one terrain fit one model: if not, held-out errors are mostly of that."""

from collections.abc import Sequence

from odometry.comparison.candidates import IdentifiedModel
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation
from odometry.comparison.fitting import SplitModels
from odometry.comparison.split import Part, training_windows
from odometry.comparison.summary import Place, summarise
from odometry.errors import OdometryError
from odometry.identification.fitters import fitter
from odometry.identification.halves import halves_of
from odometry.identification.runs_apart import runs_apart

MIXTURE = "The errors below come mostly from that, and say little about which model suits them"


def parts_apart(
    candidates: Sequence[IdentifiedModel],
    split_models: Sequence[SplitModels],
    evaluations: Sequence[Evaluation],
    config: ComparisonConfig,
) -> dict[tuple[str, str], str]:
    """A sentence for each robot and terrain whose runs, or halves of one run, do not fit one model.

    Parameters
    ----------
    candidates : sequence of IdentifiedModel
        Of them the one with the smallest held-out error at a place is fitted to each run alone.
    split_models : sequence of SplitModels
    evaluations : sequence of Evaluation
    config : ComparisonConfig

    Returns
    -------
    dict of (robot, terrain) to str
        By the tests of `identify` (`runs_apart`, `halves_of`); without those that fit one model.
    """
    found = {}
    for robot, terrain in dict.fromkeys((s.split.robot, s.split.terrain) for s in split_models):
        here = [s for s in split_models if (s.split.robot, s.split.terrain) == (robot, terrain)]
        place = Place(robot, terrain, config.horizons_m[0])
        best = _best(candidates, place, here, evaluations)
        note = None if best is None else _apart(best, here, config)
        if note is not None:
            found[robot, terrain] = f"{note[0].upper()}{note[1:]}. {MIXTURE}."
    return found


def _best(
    candidates: Sequence[IdentifiedModel],
    place: Place,
    here: Sequence[SplitModels],
    evaluations: Sequence[Evaluation],
) -> IdentifiedModel | None:
    """The candidate with the smallest error at a place, of those that all splits determine."""
    of_place = [each for each in evaluations if place.holds(each)]
    errors: list[tuple[float, IdentifiedModel]] = []
    for candidate in candidates:
        fits = [each.predictors.get(candidate.label) for each in here]
        summary = summarise(place, of_place, (), candidate.label)
        if summary.windows and all(
            fit and fit.covariance_order and not fit.not_identified for fit in fits
        ):
            errors.append((summary.means["translation"], candidate))
    return min(errors, key=lambda each: each[0], default=(0.0, None))[1]


def _apart(
    candidate: IdentifiedModel, here: Sequence[SplitModels], config: ComparisonConfig
) -> str | None:
    """The note of `identify` on all parts of a place under one model; None where they agree."""
    every = (part for each in here for part in (*each.split.held_out, *each.split.training))
    parts = _whole(list(dict.fromkeys(every)))
    near = here[0].predictors[candidate.label].values
    fit_to = fitter(
        candidate.model,
        parts[0].run.robot,
        fixed=candidate.fixed,
        window_config=config.training,
        solver_config=config.solver,
    )
    try:
        windows = training_windows(parts, config.training)
        if len(parts) == 1:
            halves = halves_of(windows, fit_to, near)
            return None if halves is None else halves.note()
        apart = runs_apart(windows, fit_to, near)
    except OdometryError:
        return None
    return None if apart is None else apart.note()


def _whole(parts: Sequence[Part]) -> list[Part]:
    """Parts with the halves of one run put together."""
    by_name: dict[str, Part] = {}
    for part in parts:
        by_name.setdefault(part.name, part)
    return [
        Part(part.run, name, part.terrain, 0, len(part.run.odometry))
        for name, part in by_name.items()
    ]
