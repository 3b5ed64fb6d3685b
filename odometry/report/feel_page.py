"""Pages of terrain by feel: of a run, and of a model."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from odometry.feel.follow import Felt
from odometry.feel.model import FeelModel
from odometry.feel.words import sentences, shares
from odometry.report.feel_figure import feel_picture
from odometry.report.html import Grid, Listing, Paragraph, Section, write_page

HOW = (
    "Windows of the IMU's vibration, the yaw response and the motor currents are compared with "
    "those of known terrains; the effect of speed is removed. The answer combines the evidence of "
    "the last stretch. unknown: unlike every terrain of the model, or at a speed that its runs do "
    "not have. undetermined: several terrains are possible. stationary: without motion there is "
    "nothing to measure."
)
LENGTHS = {"window": "window", "stretch": "stretch of 10 s", "run": "run"}


def write_feel_report(felt: Felt, out: Path) -> list[Path]:
    """Write `figures/feel.png` and `report.html`; the files written are returned."""
    picture = feel_picture(felt, Path(out) / "figures")
    rows = [(name, f"{100 * share:.0f} %") for name, share in shares(felt).items()]
    sections = [
        Section("In short", [Listing(sentences(felt))]),
        Section("Over time", [picture, Grid(("answer", "share of the time"), rows)]),
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
