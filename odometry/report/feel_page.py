"""Pages of terrain by feel: of a run, with its figure over time, and of a model."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from odometry.arrays import AnyArray
from odometry.checks.findings.finding import CheckReport
from odometry.feel.labels.felt import SILENT
from odometry.feel.labels.files import sentences
from odometry.feel.labels.follow import Felt
from odometry.feel.model import FeelModel
from odometry.modes.models.mode_set import NONE_OF_THESE
from odometry.recording.run import UNKNOWN
from odometry.report.drawing.before_use import before_use
from odometry.report.drawing.figure import mode_colours, save_figure
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page
from odometry.report.modes.mode_panels import GREYS, draw_strips, drawn_rows

WIDTH_IN, STRIP_IN, ROW_IN, HEAD_IN = 7.0, 0.26, 0.24, 1.0

ALT = "Answers and the probability of each terrain over time."
CAPTION = (
    "Answers by the last stretch and by single windows, the terrain that the run names, and the "
    "probability of each terrain by the last stretch (black is certain). Hatched: unlike every "
    "terrain of the model. Grey: a terrain that the model does not have. Blank: undetermined, "
    "stationary or not measured."
)


def feel_picture(felt: Felt, folder: Path) -> Picture:
    """Write `feel.png`."""
    names = felt.model.names
    strips = {"answer": _shown(felt.lasting_answers), "by window": _shown(felt.answers)}
    if (felt.windows.labels != UNKNOWN).any():
        strips["named"] = felt.windows.labels
    height_in = HEAD_IN + STRIP_IN * len(strips) + ROW_IN * len(names)

    def draw(figure: Figure) -> None:
        top, lower = figure.subplots(
            2,
            sharex=True,
            gridspec_kw={"height_ratios": [STRIP_IN * len(strips), ROW_IN * len(names)]},
        )
        draw_strips(top, felt.stamps_s, strips, mode_colours(names))
        rows = drawn_rows(len(felt.stamps_s))
        edges = np.append(felt.stamps_s[rows] - felt.model.design.window_s, felt.stamps_s[-1])
        lower.pcolormesh(
            edges,
            np.arange(len(names) + 1) - 0.5,
            felt.lasting_probabilities[rows].T,
            cmap=GREYS,
            vmin=0.0,
            vmax=1.0,
            rasterized=True,
        )
        lower.set_yticks(range(len(names)), names, parse_math=False, fontsize=9)
        lower.tick_params(axis="y", length=0)
        lower.set_ylim(len(names) - 0.5, -0.5)
        for axis_label, colour in zip(
            lower.get_yticklabels(), mode_colours(names).values(), strict=True
        ):
            axis_label.set_color(colour)
        lower.set_xlim(edges[0], edges[-1])
        lower.set_xlabel("time [s]")
        figure.tight_layout()

    file = save_figure(folder / "feel.png", (WIDTH_IN, height_in), draw)
    return Picture(file, ALT, CAPTION)


def _shown(answers: AnyArray) -> AnyArray:
    """Answers (W,) for a strip: blank where nothing is said, hatched where nothing fits."""
    shown = np.where(answers == UNKNOWN, NONE_OF_THESE, answers)
    return np.where(np.isin(answers.astype(str), SILENT), UNKNOWN, shown)


HOW = (
    "Windows of the IMU's vibration, the yaw response and the motor currents are compared with "
    "those of known terrains; the effect of speed is removed. The answer combines the evidence of "
    "the last stretch. unknown: unlike every terrain of the model, or at a speed that its runs do "
    "not have. undetermined: several terrains are possible. stationary: without motion there is "
    "nothing to measure."
)
LENGTHS = {"window": "window", "stretch": "stretch of 10 s", "run": "run"}


def write_feel_report(felt: Felt, out: Path, reports: Iterable[CheckReport] = ()) -> list[Path]:
    """Write `figures/feel.png` and `report.html`; the files written are returned.

    `reports` are those of the check of the run: what it warns of stands first on the page.
    """
    picture = feel_picture(felt, Path(out) / "figures")
    sections = [
        before_use(reports),
        Section("In short", [Listing(sentences(felt))]),
        Section("Over time", [picture]),
        Section("The model, on runs held out from training", accuracy_blocks(felt.model)),
        Section("Settings", [_settings(felt)]),
        Section("How to read this", [Paragraph(HOW)]),
    ]
    page = write_page(
        Path(out) / "report.html", f"Terrain by feel of {felt.run.name}", "", sections
    )
    return [picture.file, page]


def accuracy_blocks(model: FeelModel) -> list[Grid | Paragraph | Listing]:
    """Tables of the figures of a model; nothing where it has none."""
    report = model.report
    if not all(name in report for name in LENGTHS):
        return []
    header = ("held out", "balanced accuracy", "5 to 95 %", "calibration error", "refused")
    rows = [(word, *figures(report[name])) for name, word in LENGTHS.items()]
    table = report["window"]["confusion"]
    confused = [
        (name, *(str(line.get(label, 0)) for label in model.names)) for name, line in table.items()
    ]
    groups = [(name, f"{of:.3f}") for name, of in report["window_by_groups"].items()]
    return [
        Grid(header, rows, f"Whole {report['held_out']} held out; each terrain has equal weight."),
        Grid(("true terrain", *model.names), confused, "Windows by answer."),
        Grid(("features", "balanced accuracy"), groups, "Windows by other sets of features."),
        Listing(report["notes"]),
    ]


def figures(of: Mapping[str, Any]) -> tuple[str, ...]:
    """Cells of one length of answers."""
    low, high = of["interval"]
    return (
        f"{of['balanced_accuracy']:.3f}",
        f"{low:.3f} to {high:.3f}",
        f"{of['calibration_error']:.3f}",
        f"{100 * of['refused']:.0f} %",
    )


def _settings(felt: Felt) -> Grid:
    design = felt.model.design
    return Grid(
        ("", "value"),
        (
            ("terrains", ", ".join(felt.model.names)),
            ("identified from", felt.model.source or "-"),
            ("columns", ", ".join(design.columns)),
            ("window [s]", f"{design.window_s:g}"),
            ("vibration up to [Hz]", f"{design.top_hz:.4g}"),
            ("stretch [s]", f"{felt.config.stretch_s:g}"),
            ("named from a probability of", f"{felt.config.sure:g}"),
        ),
    )
