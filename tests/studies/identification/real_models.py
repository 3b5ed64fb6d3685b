"""Every model on the real recordings: held-out errors by robot and ground, against `icr`.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.identification.real_models [--out FOLDER]
        [--jobs 2]

Runs with a pose are grouped by robot and ground as INDEX.csv names them; recordings whose ground
is not stated are one ground of each robot. A run is evaluated with models identified on the other
runs of its group, where there is one run each half by the other. `least` is the candidate with the
smallest error, translation and rotation as ratios to those of `icr` added up, when the runs that
are not held out are split once more in the same way; `chosen` is the same among those with errors
no larger than `icr` in either. Neither uses what it is evaluated on, but the rule of `chosen` was
added after a first look at the results of `least`. H of the inertia models is held at 1, since it
acts inside a sign alone. Slow models are identified on a part of the windows, evenly picked: at
most 120 for inertia, 45 for `contact`.

Printed, and written to FOLDER/real_models.md: a table robot x ground x model of mean errors per
metre over 2 m, with paired 95 % intervals of the difference to `icr`, and what they say.
"""

import argparse
import csv
import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from odometry.comparison.candidates import Candidate, IdentifiedModel, Predictor
from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import evaluation_windows
from odometry.comparison.files import write_comparison
from odometry.comparison.result import Comparison
from odometry.comparison.split import Split, folds
from odometry.comparison.statistics import Difference, between
from odometry.comparison.summary import QUANTITIES, Place, Summary
from odometry.errors import OdometryError
from odometry.identification.start import SolverConfig
from odometry.io.files import atomic_write
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.report.comparison.comparison_page import write_comparison_report
from odometry.windows.window_errors import window_errors

BASELINE = "icr"
NAMES = (
    *("differential_drive", "icr_symmetric", "icr", "radius_of_curvature", "full_linear"),
    *("traction_mode", "icr_slope", "icr_inertia", "icr_inertia_measured", "contact"),
)
SLOW = {"icr_inertia": 120, "icr_inertia_measured": 120, "contact": 45}  # most windows of a fit
CONFIG = ComparisonConfig(solver=SolverConfig(starts=1))


@dataclass(frozen=True)
class Remembered(Candidate):
    """A candidate whose identifications are kept: inner splits of different runs are the same."""

    candidate: Candidate
    known: dict[Any, Predictor | OdometryError] = field(default_factory=dict)

    @property
    def label(self) -> str:
        return self.candidate.label

    def on(
        self, split: Split, config: ComparisonConfig, near: Mapping[str, float] | None = None
    ) -> Predictor:
        key = tuple((part.name, part.start, part.stop) for part in split.training)
        if key not in self.known:
            try:
                self.known[key] = self.candidate.on(split, config, near)
            except OdometryError as error:
                self.known[key] = error
        found = self.known[key]
        if isinstance(found, OdometryError):
            raise found
        return found


@dataclass(frozen=True)
class Least(Candidate):
    """The candidate with the smallest error where the fitted parts are split once more.

    Attributes
    ----------
    name : str
    candidates : sequence of Candidate
        The baseline among them.
    most_ratio : float
        Only those whose errors, translation and rotation, are at most so many of the baseline's.
    """

    name: str
    candidates: Sequence[Candidate]
    most_ratio: float = np.inf

    @property
    def label(self) -> str:
        return self.name

    def on(
        self, split: Split, config: ComparisonConfig, near: Mapping[str, float] | None = None
    ) -> Predictor:
        inner = folds(split.robot, split.terrain, split.training)
        scores = {each.label: score(each, inner, config) for each in self.candidates}
        ratios = {label: errors / scores[BASELINE] for label, errors in scores.items()}
        allowed = [c for c in self.candidates if ratios[c.label].max() <= self.most_ratio]
        best = min(allowed, key=lambda each: ratios[each.label].sum())
        predictor = best.on(split, config, near)
        return replace(predictor, source=f"chosen: {best.label}; {predictor.source}")


def score(candidate: Candidate, inner: Sequence[Split], config: ComparisonConfig) -> np.ndarray:
    """Mean translation and rotation errors over inner splits; infinite where it fails on one."""
    translation, rotation = [], []
    for split in inner:
        try:
            predictor = candidate.on(split, config)
            for part in split.held_out:
                windows = evaluation_windows(part, config.horizons_m[0], config.training)
                errors = window_errors(predictor.model, predictor.packed, windows)
                translation.append(errors.translation_per_m)
                rotation.append(errors.rotation_per_m)
        except OdometryError:
            return np.full(2, np.inf)
    return np.array([np.concatenate(translation).mean(), np.concatenate(rotation).mean()])


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=None, help="keep table and reports here")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        study(arguments.out or Path(scratch), arguments.jobs)


def study(out: Path, jobs: int) -> None:
    """Compare group by group, print and write."""
    groups = recordings(Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion")
    compared = Parallel(n_jobs=jobs, verbose=10)(
        delayed(compare)(runs, candidates(), config=CONFIG) for runs in groups.values()
    )
    for name, comparison in zip(groups, compared, strict=True):
        write_comparison(comparison, out / name)
        write_comparison_report(comparison, out / name)
    text = "\n".join([*table(compared), "", *verdicts(compared), ""])
    print(text)
    with atomic_write(out / "real_models.md") as part:
        part.write_text(text, encoding="utf-8")


def recordings(folder: Path) -> dict[str, list[Run]]:
    """Runs with a pose by robot and ground, each with its ground as INDEX.csv names it."""
    groups: dict[str, list[Run]] = {}
    with (folder / "INDEX.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            run = Run.read(folder / row["run"])
            if run.pose is None:
                continue
            ground = row["terrain"].split(" (")[0]
            settings = {**run.settings, "run": {"terrain": ground}}
            name = f"{row['robot']} {ground}".replace(" ", "_")
            groups.setdefault(name, []).append(replace(run, settings=settings))
    return dict(sorted(groups.items(), key=lambda group: -total_rows(group[1])))


def total_rows(runs: Sequence[Run]) -> int:
    """Rows of odometry: the longest groups go first."""
    return sum(len(run.odometry) for run in runs)


def candidates() -> list[Candidate]:
    """The models of the catalogue that are here, and the choice among them."""
    found: list[Candidate] = []
    for name in NAMES:
        if name in MODELS:
            in_sign = [p.name for p in MODELS[name].parameters if p.in_sign]
            model = IdentifiedModel(MODELS[name], dict.fromkeys(in_sign, 1.0), SLOW.get(name))
            found.append(Remembered(model))
    return [*found, Least("least", tuple(found)), Least("chosen", tuple(found), most_ratio=1.0)]


def table(compared: Sequence[Comparison]) -> list[str]:
    """Lines of the table in Markdown."""
    against = f"less {BASELINE} [95 %]"
    header = ("robot", "ground", "model", "windows", "m per m", against, "deg per m", against, "")
    lines = [line(header), line(["---"] * len(header))]
    for comparison in compared:
        for place in comparison.places:
            found = comparison.differences_at(place)
            lines += [
                line(row(comparison, place, summary, found))
                for summary in comparison.summaries_at(place)
            ]
    return lines


def row(
    comparison: Comparison, place: Place, summary: Summary, found: Sequence[Difference]
) -> list[str]:
    """Cells of one model at one place."""
    cells = [place.robot, place.terrain, summary.model, str(summary.windows)]
    for quantity, decimals in (("translation", 4), ("rotation", 3)):
        mean = summary.means.get(quantity)
        difference = against_baseline(found, summary.model, quantity)
        cells.append("-" if mean is None else f"{mean:.{decimals}f}")
        cells.append(difference.words().split("]")[0] + "]" if difference else "-")
    remarks = "; ".join(comparison.remarks_at(place, summary))
    return [
        *cells,
        f"{remarks[:90]}{'...' if len(remarks) > 90 else ''} {picks(comparison, summary)}",
    ]


def picks(comparison: Comparison, summary: Summary) -> str:
    """What was chosen, split by split."""
    sources = [
        models.predictors[summary.model].source
        for models in comparison.split_models
        if summary.model in models.predictors
    ]
    chosen = [source for source in sources if source.startswith("chosen: ")]
    return ", ".join(source.removeprefix("chosen: ").split(";")[0] for source in chosen)


def verdicts(compared: Sequence[Comparison]) -> list[str]:
    """Where the chosen models beat, match or lose to `icr`, and where nothing beats a width."""
    lines = []
    for comparison in compared:
        for place in comparison.places:
            found = comparison.differences_at(place)
            lines.append(f"- {place.title}")
            for model in ("chosen", "least"):
                words = [
                    f"{quantity} {verdict(against_baseline(found, model, quantity))}"
                    for quantity in QUANTITIES
                ]
                lines.append(f"  - {model} against {BASELINE}: {'; '.join(words)}.")
            lines += [f"  - {said}" for said in comparison.sentences_at(place)]
    return lines


def verdict(difference: Difference | None) -> str:
    """A difference in a word, and in numbers."""
    if difference is None:
        return "not evaluated"
    if difference.interval.holds_zero:
        return f"matched, {difference.words()}"
    return f"{'better' if difference.interval.high < 0 else 'worse'}, {difference.words()}"


def against_baseline(found: Sequence[Difference], model: str, quantity: str) -> Difference | None:
    """The difference of a model to `icr`, the model first."""
    if model == BASELINE:
        return None
    return between([each for each in found if each.quantity == quantity], model, BASELINE)


def line(cells: Sequence[str]) -> str:
    """One line of a table in Markdown."""
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
