"""A figure as a PNG file: the same input gives the same bytes, and no global state is left."""

from collections.abc import Callable
from pathlib import Path

from matplotlib import style
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from odometry.io.files import atomic_write

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
        Width and height in inches.
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
            figure.savefig(part, dpi=dpi, metadata={"Software": None, "Source": source})
    return file
