"""One page and its figures from the result of a run."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from odometry.checks.findings.finding import CheckReport
from odometry.report.drawing.before_use import before_use
from odometry.report.drawing.figure import terrain_colours
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page
from terrain.report.figures import (
    Tints,
    distribution_picture,
    icr_picture,
    path_picture,
    position_picture,
)
from terrain.report.images import (
    confusion_picture,
    labels_picture,
    regions_picture,
    whole_image_picture,
)
from terrain.report.labels_and_truth import confusion
from terrain.report.lines import ReportLines
from terrain.report.tables import (
    contradiction_grid,
    error_table,
    event_grid,
    icr_table,
    settings_table,
    switch_table,
    uncertainty_grid,
)
from terrain.report.words import headline, notes
from terrain.result.evaluation_notes import advice
from terrain.result.label_confusion import label_confusions
from terrain.result.new_terrain import contradiction_lines
from terrain.result.run_notes import run_notes
from terrain.result.run_result import RunResult
from terrain.result.switch_delay import true_stretches
from terrain.sources.sources import SOURCE_WORDS

Block = Paragraph | Listing | Grid | Picture

FIGURES = (
    *("path", "position_errors", "error_per_metre", "icrs"),
    *("labels", "confusion", "regions", "whole_image"),
)


def write_report(
    result: RunResult,
    out: str | Path,
    compared_with: Mapping[str, RunResult] | None = None,
    reports: Iterable[CheckReport] = (),
) -> list[Path]:
    """Write `figures/*.png` and `report.html`.

    Parameters
    ----------
    result : RunResult
    out : path
        Folder; made if it is missing.
    compared_with : Mapping of name to RunResult, optional
        Other results of the same run, such as {"without vision": ...}.
    reports : iterable of CheckReport, optional
        Of the run, by default that of the result: what the check warns of stands first on the
        page, then `run_notes`.

    Returns
    -------
    list of Path
        The files written, the page last. What the run has no data for is left out.

    Raises
    ------
    OdometryError
        If an image cannot be read any more.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> with TemporaryDirectory() as folder:
    ...     print(terrain.write_report(result, folder)[-1].name)
    report.html
    """
    folder = Path(out) / "figures"
    lines = ReportLines(result, compared_with or {})
    tints = _tints(result)
    sections = [
        before_use(reports or result.reports, run_notes(result)),
        Section("Errors", _errors(lines, folder)),
        Section("Uncertainty of the odometer", _uncertainty(result)),
        Section("What the filter noticed", _some(event_grid(result))),
        Section("Path", [path_picture(lines, tints, folder)]),
        Section("Terrain", _terrain(result, tints, folder)),
        Section("Where the sources differ", _differing(result)),
        Section("Centres of rotation", [icr_picture(lines, folder), icr_table(result)]),
        Section("Settings", [settings_table(result)]),
        Section("Notes", [Listing(notes(lines))]),
    ]
    title = f"{result.run.name}: terrain-aware odometry"
    page = write_page(Path(out) / "report.html", title, headline(lines, lines.scores()), sections)
    pictures = [b.file for s in sections for b in s.blocks if isinstance(b, Picture)]
    for name in FIGURES:
        if folder / f"{name}.png" not in pictures:
            (folder / f"{name}.png").unlink(missing_ok=True)  # of an earlier run
    return [*pictures, page]


def _errors(lines: ReportLines, folder: Path) -> list[Block]:
    scores = lines.scores()
    if not scores:
        return []
    pictures = (position_picture(lines, folder), distribution_picture(lines, folder))
    return [error_table(lines, scores), *(picture for picture in pictures if picture)]


def _uncertainty(result: RunResult) -> list[Block]:
    grid = uncertainty_grid(result)
    return (
        [] if grid is None else [Paragraph(advice(result.uncertainty, result.reference_name)), grid]
    )


def _some(grid: Grid | None) -> list[Block]:
    return [] if grid is None else [grid]


def _terrain(result: RunResult, tints: Tints, folder: Path) -> list[Block]:
    watcher = result.watcher
    if result.source == "none":
        return []
    if watcher is None:
        return [
            Paragraph(f"The source of the terrain was {SOURCE_WORDS[result.source]}."),
            switch_table(result) or _never_changed(result),
        ]
    if not watcher.image_labels:
        return [Paragraph("No image lies within the time of the run.")]
    seen = confusion(result)
    blocks = [
        switch_table(result) or _never_changed(result),
        labels_picture(result, watcher, tints, folder),
        confusion_picture(seen, folder) if seen else None,
        label_table(result),
        regions_picture(result, watcher, tints, folder),
        whole_image_picture(result, watcher, watcher.classifier, tints, folder),
    ]
    return [block for block in blocks if block is not None]


def _differing(result: RunResult) -> list[Block]:
    lines = contradiction_lines(result)
    return [Listing(lines), contradiction_grid(result)] if lines else []


def _never_changed(result: RunResult) -> Paragraph:
    return Paragraph(f"The terrain never changed from {result.initial_terrain}.")


def _tints(result: RunResult) -> Tints:
    """One colour a terrain for the whole page."""
    names = {result.initial_terrain, *result.replay.terrains, *result.learned.terrains}
    names |= {stretch.terrain for stretch in true_stretches(result)}
    if result.watcher is not None:
        names |= {image_label.label for image_label in result.watcher.image_labels}
        names |= {str(name) for name in result.watcher.classifier.classes_}
    return terrain_colours(names)


def label_table(result: RunResult) -> Grid | None:
    """Images by the terrain that images.csv names and by label; None where it names none.

    Against truth.csv there is a picture, see `terrain.report.labels_and_truth.confusion`.
    """
    of = label_confusions(result).get("images.csv")
    if of is None:
        return None
    rows = [(name, *map(str, row)) for name, row in zip(of.true, of.counts.tolist(), strict=True)]
    share = of.right_share
    right = "" if share is None else f"; {100 * share:.0f} % of the labels that are names are right"
    caption = f"Images by their terrain in images.csv (rows) and by label (columns){right}."
    return Grid(("true terrain", *of.labels), rows, caption)
