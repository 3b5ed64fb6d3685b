"""One page and its figures from the modes of a run, and what is left of each signal."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import CheckReport
from odometry.modes.follow.detection import confusion
from odometry.modes.follow.followed import BOUND, Followed
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.modes.show.words import SIGNALS, in_short, percent, scale_word, sentences, signal_of
from odometry.report.drawing.before_use import before_use
from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page
from odometry.report.modes.mode_figures import modes_picture, path_picture
from odometry.report.modes.mode_panels import STATE_COLOUR, drawn_rows

HOW = (
    "Each mode is a filter with a model of its own; the filters' predictions are weighed by what "
    "was measured, and a Markov chain lets modes change. The true mode is that of truth.csv, else "
    "what the run names; it serves the scores alone. Time to detection counts from the beginning "
    "of a stretch of one true mode to the first answer that names it; the shares are of the time "
    "after that."
)


def write_modes_report(
    followed: Followed, out: Path, reports: Iterable[CheckReport] = ()
) -> list[Path]:
    """Write `figures/modes.png`, `innovations.png`, for traction modes `path.png`, `report.html`.

    `reports` are those of the check of the run: what it warns of stands first on the page.

    Returns
    -------
    list of Path
        The files written, the page last. Figures of an earlier run are removed.
    """
    folder = Path(out) / "figures"
    answer, how_sure, to_do = in_short(followed)
    short = [f"Answer: {answer}", f"How sure: {how_sure}", f"What to do: {to_do}"]
    _, *others = sentences(followed)
    over_time = modes_picture(followed, folder)
    others_drawn = {
        "innovations.png": innovations_picture(followed, folder),
        "path.png": path_picture(followed, folder),
    }
    for name, picture in others_drawn.items():
        if picture is None:
            (folder / name).unlink(missing_ok=True)
    innovations, path = ([] if one is None else [one] for one in others_drawn.values())
    pictures = [over_time, *innovations, *path]
    sections = [
        before_use(reports),
        Section("In short", [Listing(short)]),
        Section("Over time", [over_time]),
        Section("How the nearest mode fits", [*innovations, *_misfits(followed)]),
        Section("Where it drove", path),
        Section("Stretches", _detections(followed)),
        Section("Answers by true mode", _confusions(followed)),
        Section("Details", [Listing(others)] if others else []),
        Section("Settings", [_settings(followed)]),
        Section("How to read this", [Paragraph(HOW)]),
    ]
    page = write_page(out / "report.html", f"Modes of {followed.run.name}", "", sections)
    return [*(picture.file for picture in pictures), page]


def _misfits(followed: Followed) -> list[Grid | Picture]:
    header = ("signal that fits least", "from [s]", "to [s]", "standard deviations", "in words")
    rows = [
        (
            signal_of(followed, one),
            f"{one.from_s:.1f}",
            f"{one.to_s:.1f}",
            f"{one.sigmas:.0f}",
            scale_word(one.sigmas),
        )
        for one in followed.misfits
    ]
    return [Grid(header, rows, f"Where the answer is {NONE_OF_THESE}.")] if rows else []


def _detections(followed: Followed) -> list[Grid | Picture]:
    header = (
        *("mode", "from [s]", "to [s]", "detected after [s]", "right", "wrong"),
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


WIDTH_IN, PANEL_IN, AROUND_IN = 7.0, 1.15, 0.9
MOST = 10.0  # standard deviations that are drawn
MISFIT_COLOUR = "#D55E00"


def innovations_picture(followed: Followed, folder: Path) -> Picture | None:
    """A panel for each signal that was measured; None where nothing was tested."""
    track = followed.motion
    if track.fit is None:
        return None
    panels = _by_signal(followed, track.fit.best)
    if not panels:
        return None

    def draw(figure: Figure) -> None:
        every = np.ravel(figure.subplots(len(panels), 1, sharex=True))
        rows = drawn_rows(len(track.stamps_s))
        for axes, (name, left) in zip(every, panels.items(), strict=True):
            axes.axhspan(-BOUND, BOUND, color=STATE_COLOUR, alpha=0.15, linewidth=0)
            for one in followed.misfits:
                axes.axvspan(one.from_s, one.to_s, color=MISFIT_COLOUR, alpha=0.15, linewidth=0)
            shown = np.clip(left[rows], -MOST, MOST)
            axes.plot(track.stamps_s[rows], shown, color=STATE_COLOUR, linewidth=0.8)
            axes.set(ylim=(-1.1 * MOST, 1.1 * MOST), yticks=(-MOST, 0.0, MOST))
            axes.set_title(name, loc="left", pad=3.0, fontsize=9)
            axes.grid(visible=True, axis="y")
        every[-1].set(xlim=track.stamps_s[[0, -1]].tolist(), xlabel="time [s]")
        figure.supylabel("standard deviations", fontsize=9)
        figure.tight_layout()

    height_in = PANEL_IN * len(panels) + AROUND_IN
    return Picture(
        save_figure(folder / "innovations.png", (WIDTH_IN, height_in), draw),
        "What is left of each signal over time, in standard deviations, with bounds.",
        "What is left of each signal over half a second where the nearest mode is taken, in the "
        f"standard deviations that it has where that mode is true; at most {MOST:g} are drawn. "
        f"Blue band: {BOUND:g} of them, within which 95 % lie then. Orange: none of these.",
    )


def _by_signal(followed: Followed, best: FloatArray) -> dict[str, FloatArray]:
    """Lines (N, k) of each signal of which something was measured."""
    names = SIGNALS[followed.mode_set.modes.kind]
    found = {}
    for name in dict.fromkeys(names):
        columns = best[:, [place for place, own in enumerate(names) if own == name]]
        if np.isfinite(columns).any():
            found[name] = columns
    return found
