"""A figure as a PNG file, the same bytes from the same input, and colours for all readers."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import Bbox

from odometry.io.files import atomic_write
from odometry.recording.run import UNKNOWN

# Tints of P. Tol's "light" scheme: black text and dark lines stay readable on them.
TERRAIN_TINTS = (
    "#EEDD88",
    "#44BB99",
    "#99DDFF",
    "#FFAABB",
    "#BBCC33",
    "#77AADD",
    "#EE8866",
    "#AAAA00",
)
UNKNOWN_TINT = "#DDDDDD"


@dataclass(frozen=True)
class LineStyle:
    """Colour, dashes and width of a line: two lines never differ by colour alone."""

    colour: str
    dashes: str | tuple[float, tuple[float, ...]] = "solid"
    width_pt: float = 1.6


REFERENCE_STYLE = LineStyle("#000000", "solid", 2.2)
LINE_STYLES = (
    LineStyle("#0072B2"),
    LineStyle("#D55E00", "dashdot"),
    LineStyle("#00785A", "dotted", 2.0),
    LineStyle("#AA4499", "dashed"),
    LineStyle("#7A5C00", (0.0, (6.0, 1.5, 1.0, 1.5, 1.0, 1.5))),
    LineStyle("#555555", (0.0, (8.0, 2.0))),
    LineStyle("#332288", (0.0, (3.0, 1.0, 1.0, 1.0))),
    LineStyle("#C2185B", (0.0, (5.0, 1.0)), 1.8),
    LineStyle("#5B8E00", (0.0, (1.0, 2.5)), 2.0),
    LineStyle("#00838F", (0.0, (10.0, 2.0, 2.0, 2.0))),
)


def terrain_colours(names: Iterable[str]) -> dict[str, str]:
    """Give each terrain a tint, by the order of the alphabet; `unknown` is grey.

    Parameters
    ----------
    names : iterable of str
        All terrains of a page, so that each keeps its colour over all figures; "" is left out.
    """
    known = sorted({name for name in names if name} - {UNKNOWN})
    tints = {name: TERRAIN_TINTS[i % len(TERRAIN_TINTS)] for i, name in enumerate(known)}
    return tints | {UNKNOWN: UNKNOWN_TINT}


def mode_colours(names: Iterable[str]) -> dict[str, str]:
    """Give each mode a colour, in the order given: dark ones first, then tints."""
    colours = (*(style.colour for style in LINE_STYLES), *TERRAIN_TINTS)
    return {name: colours[i % len(colours)] for i, name in enumerate(names)}


def line_styles(names: Iterable[str]) -> dict[str, LineStyle]:
    """Give each line a style, in the order given; after the last style the first comes again."""
    return {name: LINE_STYLES[i % len(LINE_STYLES)] for i, name in enumerate(names)}


_MARGIN_IN = 0.03  # white beside a text at an edge
_COMPRESSION = 3  # of 9: files as small as by the usual 6, in less than half of the time
_STYLE = {
    "font.size": 10.0,
    "axes.titlesize": 10.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "axes.axisbelow": True,
    "grid.color": "#E4E4E4",
    "lines.solid_capstyle": "round",
}


def save_figure(
    file: Path,
    size_in: tuple[float, float],
    draw: Callable[[Figure], None],
    dpi: int = 150,
    *,
    source: str | None = None,
) -> Path:
    """Make a figure, let `draw` fill it, and write it.

    Parameters
    ----------
    file : Path
        Ends in .png.
    size_in : (float, float)
        Width and height in inches; it grows where a text would be cut at an edge.
    draw : callable
        Called once with the empty figure. Settings of the user's own matplotlib do not reach it.
    dpi : int
    source : str or None
        What made it, kept as text in the file.

    Returns
    -------
    Path
        `file`.
    """
    with style.context(["default", _STYLE]):
        figure = Figure(figsize=size_in, dpi=dpi)
        FigureCanvasAgg(figure)
        draw(figure)
        with atomic_write(file) as part:
            _write_png(part, figure, source)
    return file


def _write_png(file: Path, figure: Figure, source: str | None) -> None:
    figure.savefig(
        file,
        dpi=figure.dpi,
        metadata={"Software": None, "Source": source},
        bbox_inches=_whole(figure),
        pil_kwargs={"compress_level": _COMPRESSION},
    )


def _whole(figure: Figure) -> Bbox | None:
    """Edges in inches that cut no text; None where those of the figure do not."""
    drawn, page = figure.get_tightbbox().padded(_MARGIN_IN), figure.bbox_inches
    whole = Bbox.union([drawn, page])
    return None if np.array_equal(whole.extents, page.extents) else whole


class RunTimeLocator(MaxNLocator):
    """Ticks at round times of a run whose stamps begin elsewhere, such as at seconds since 1970."""

    def __init__(self, began_s: float) -> None:
        super().__init__(nbins=9, steps=[1, 2, 5, 10])
        self._began_s = began_s

    def tick_values(self, vmin: float, vmax: float) -> list[float]:
        """Places of the ticks between two stamps."""
        ticks = super().tick_values(vmin - self._began_s, vmax - self._began_s)
        return [tick + self._began_s for tick in ticks]


def show_run_time(axes: Axes, began_s: float) -> None:
    """Label the x axis, whose values are stamps, by seconds since a stamp."""
    axes.xaxis.set_major_locator(RunTimeLocator(began_s))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda stamp_s, _: f"{stamp_s - began_s:g}"))
    axes.set_xlabel("run time [s]")
