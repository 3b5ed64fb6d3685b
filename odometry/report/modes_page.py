"""One page and its figures from the modes of a run."""

from pathlib import Path

from odometry.modes.answers import NO_MODES, NONE_OF_THESE, UNDETERMINED, confusion
from odometry.modes.followed import Followed
from odometry.modes.words import percent, sentences
from odometry.report.html import Grid, Listing, Paragraph, Picture, Section, write_page
from odometry.report.mode_figures import modes_picture, path_picture

HOW = (
    "Each mode is a filter with a model of its own; the filters' predictions are weighed by what "
    "was measured, and a Markov chain lets modes change. The true mode is that of truth.csv, else "
    "what the run names; it serves the scores alone. Time to detection counts from the beginning "
    "of a stretch of one true mode to the first answer that names it; the shares are of the time "
    "after that."
)


def write_modes_report(followed: Followed, out: Path) -> list[Path]:
    """Write `figures/modes.png`, for traction modes `figures/path.png`, and `report.html`.

    Returns
    -------
    list of Path
        The files written, the page last. Figures of an earlier run are removed.
    """
    folder = Path(out) / "figures"
    lead, *others = sentences(followed)
    over_time, path = modes_picture(followed, folder), path_picture(followed, folder)
    if path is None:
        (folder / "path.png").unlink(missing_ok=True)
    pictures = [over_time] if path is None else [over_time, path]
    sections = [
        Section("In words", [Listing(others)] if others else []),
        Section("Over time", [over_time]),
        Section("Where it drove", [] if path is None else [path]),
        Section("Stretches", _detections(followed)),
        Section("Answers by true mode", _confusions(followed)),
        Section("Settings", [_settings(followed)]),
        Section("How to read this", [Paragraph(HOW)]),
    ]
    page = write_page(out / "report.html", f"Modes of {followed.run.name}", lead, sections)
    return [*(picture.file for picture in pictures), page]


def _detections(followed: Followed) -> list[Grid | Picture]:
    header = (
        *("mode", "from [s]", "to [s]", "told after [s]", "right", "wrong"),
        *(UNDETERMINED, NONE_OF_THESE),
    )
    grids: list[Grid | Picture] = []
    for name, track in followed.tracks.items():
        rows = [
            (
                one.mode,
                f"{one.from_s:.1f}",
                f"{one.to_s:.1f}",
                "never" if one.after_s != one.after_s else f"{one.after_s:.2f}",
                *map(percent, (one.right, one.wrong, one.undetermined, one.none_of_these)),
            )
            for one in followed.score(track).detections
        ]
        grids += [Grid(header, rows, f"By {name}.")] if rows else []
    return grids


def _confusions(followed: Followed) -> list[Grid | Picture]:
    """Seconds; modes that are neither true nor answered are left out."""
    names = followed.mode_set.names
    grids: list[Grid | Picture] = []
    for title, track in followed.tracks.items():
        seconds = confusion(track, followed.config.sure, names)
        answered = (seconds.sum(axis=0) > 0).nonzero()[0]
        columns = (*names, *NO_MODES)
        rows = [
            (name, *(f"{row[place]:.1f}" for place in answered))
            for name, row in zip(names, seconds, strict=True)
            if row.any()
        ]
        header = ("true mode", *(columns[place] for place in answered))
        grids += [Grid(header, rows, f"Seconds of each answer, by {title}.")] if rows else []
    return grids


def _settings(followed: Followed) -> Grid:
    mode_set, config = followed.mode_set, followed.config
    dwell = ", ".join(f"{value:g}" for value in dict.fromkeys(mode_set.dwell_s.tolist()))
    return Grid(
        ("", "value"),
        (
            ("kind of modes", mode_set.modes.kind),
            ("modes", ", ".join(mode_set.names)),
            ("where they come from", mode_set.source or "-"),
            ("mean time in a mode [s]", dwell),
            ("named from a probability of", f"{config.sure:g}"),
            ("least probability of a mode", f"{config.floor:g}"),
            ("a disagreement is reported from [s]", f"{config.lasting_s:g}"),
        ),
    )
