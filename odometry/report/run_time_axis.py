"""An axis of stamps that shows run time."""

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator


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
