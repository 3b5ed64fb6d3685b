"""A figure as a PNG file: the same input gives the same bytes, and no global state is left."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from matplotlib.transforms import Bbox

from odometry.io.files import atomic_write

_MARGIN_IN = 0.03  # white beside a text at an edge
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
            metadata = {"Software": None, "Source": source}
            figure.savefig(part, dpi=dpi, metadata=metadata, bbox_inches=_whole(figure))
    return file


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
