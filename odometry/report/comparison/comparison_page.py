"""One page and its figures from a comparison."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from odometry.checks.findings.finding import CheckReport
from odometry.comparison.result import Comparison
from odometry.comparison.summary import QUANTITIES, Place
from odometry.comparison.training_horizons import horizon_sentence
from odometry.report.comparison.comparison_figures import (
    distribution_picture,
    horizon_picture,
    picture_name,
    rotation_picture,
)
from odometry.report.comparison.comparison_tables import (
    difference_grid,
    error_grid,
    fitness_grid,
    parameter_grid,
    quartile_grid,
    settings_grid,
    split_grid,
)
from odometry.report.comparison.speed_plane import speed_plane_picture
from odometry.report.comparison.training_horizons import training_horizon_picture
from odometry.report.drawing.before_use import before_use
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page

Block = Paragraph | Listing | Grid | Picture

FIGURES = ("errors", "speed_plane", "horizons", "rotation", "training_horizons")
HOW = (
    "Every window is evaluated with a model that was not identified on it; the tables name the "
    "runs that it was identified on. Errors are per metre of wheel travel. Windows are distinct; "
    "they may lie across joints of chained reference poses, where the reference is less certain, "
    "but across no gaps; that is the same for every model. Intervals are 95 % intervals of paired "
    "differences by a bootstrap of runs and of blocks of neighbouring windows. Each is of one pair "
    "of models: of many such intervals some miss by chance."
)


def write_comparison_report(
    comparison: Comparison, out: str | Path, reports: Iterable[CheckReport] = ()
) -> list[Path]:
    """Write `figures/*.png` and `report.html`.

    Parameters
    ----------
    comparison : Comparison
    out : path
        Folder; made if it is missing.
    reports : iterable of CheckReport
        Of the runs: what the check warns of stands first on the page.

    Returns
    -------
    list of Path
        The files written, the page last. Figures of an earlier comparison are removed.
    """
    folder = Path(out) / "figures"
    robots = dict.fromkeys(robot for robot, _ in comparison.robots_and_terrains)
    sections = [
        before_use(reports),
        Section("How to read this", [Paragraph(HOW)]),
        Section("All errors", [error_grid(comparison), *_left_out(comparison)]),
        *(_place(comparison, place, folder) for place in comparison.places),
        *(_horizons(comparison, *pair, folder) for pair in comparison.robots_and_terrains),
        *(_training(comparison, *pair, folder) for pair in comparison.robots_and_terrains),
        *(_rotation(comparison, robot, folder) for robot in robots),
        Section("Whole runs", [fitness_grid(comparison)]),
        Section("Parameters", [parameter_grid(comparison)]),
        Section("Settings", [settings_grid(comparison)]),
    ]
    page = write_page(
        Path(out) / "report.html", "Kinematic models compared", lead(comparison), sections
    )
    pictures = [b.file for s in sections for b in s.blocks if isinstance(b, Picture)]
    for kind in FIGURES:
        for file in set(folder.glob(f"{kind}_*.png")) - set(pictures):
            file.unlink()
    return [*pictures, page]


def lead(comparison: Comparison) -> str:
    """The main result: the best model, and what contradicts that."""
    if len(comparison.places) == 1:
        said = comparison.sentences_at(comparison.places[0])
        contradicted = comparison.contradictions_at(comparison.places[0])
        others = [each for each in contradicted if each != said[0]]
        return " ".join([*said[:1], *others]) or "No model could be evaluated."
    best = {place: _best(comparison, place) for place in comparison.places}
    counts = Counter(model for model in best.values() if model)
    words = " and ".join(f"with {model} in {count}" for model, count in counts.items())
    said = [
        f"The mean translation error is smallest {words} of {len(best)} comparisons (of one robot, "
        "terrain and horizon each)."
        if words
        else "No model could be evaluated."
    ]
    equal = sum(_is_equalled(comparison, place, model) for place, model in best.items())
    if equal:
        said.append(f"In {equal} of them another model cannot be distinguished from the best one.")
    count = sum(bool(comparison.contradictions_at(place)) for place in comparison.places)
    if count:
        said.append(f"In {count} of them medians or whole runs give another order; see there.")
    return " ".join(said)


def _best(comparison: Comparison, place: Place) -> str:
    """The model with the smallest mean translation error, empty where none was evaluated."""
    means = {
        summary.model: summary.means["translation"]
        for summary in comparison.summaries_at(place)
        if summary.ranked
    }
    return min(means, key=means.__getitem__, default="")


def _is_equalled(comparison: Comparison, place: Place, model: str) -> bool:
    """Whether the interval of a difference of translation errors with a model holds zero."""
    return any(
        each.quantity == "translation" and each.interval.holds_zero
        for each in comparison.differences_at(place)
        if model in (each.first, each.second)
    )


def _place(comparison: Comparison, place: Place, folder: Path) -> Section:
    """Everything about one robot and terrain over one horizon."""
    evaluations = comparison.evaluations_at(place)
    name = picture_name(comparison, place)
    pictures = (
        distribution_picture(comparison, place, folder),
        speed_plane_picture(evaluations, comparison.models, folder / f"speed_plane_{name}.png"),
    )
    found = comparison.differences_at(place)
    blocks: list[Block] = [
        Listing(comparison.sentences_at(place)),
        quartile_grid(comparison, place),
    ]
    blocks += [picture for picture in pictures if picture is not None]
    blocks += [difference_grid(found)] if found else []
    blocks += [split_grid(comparison, place)] if evaluations else []
    return Section(place.title, blocks)


def _horizons(comparison: Comparison, robot: str, terrain: str, folder: Path) -> Section:
    picture = horizon_picture(comparison, robot, terrain, folder)
    return Section(f"{robot} on {terrain}, over every horizon", [picture] if picture else [])


def _training(comparison: Comparison, robot: str, terrain: str, folder: Path) -> Section:
    """Which training horizon suits which evaluation horizon, model by model."""
    blocks: list[Block] = []
    for model, errors in comparison.horizon_errors_of(robot, terrain).items():
        blocks.append(Listing([horizon_sentence(model, errors, q) for q in QUANTITIES]))
        picture = training_horizon_picture(errors, folder, model)
        blocks += [picture] if picture else []
    return Section(f"{robot} on {terrain}: training and evaluation horizon", blocks)


def _rotation(comparison: Comparison, robot: str, folder: Path) -> Section:
    picture = rotation_picture(comparison, robot, folder)
    return Section(f"{robot}: commanded and measured turns", [picture] if picture else [])


def _left_out(comparison: Comparison) -> list[Block]:
    reasons = [f"Note: {note}." for note in comparison.notes]
    reasons += [f"Left out: {reason}." for reason in comparison.left_out.values()]
    return [Listing(reasons)] if reasons else []
