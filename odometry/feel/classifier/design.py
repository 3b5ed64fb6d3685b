"""The columns that distinguish windows: bands, shape, how axes go together, and motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.feel.recorded.spectra import (
    LOWEST_HZ,
    band_edges_hz,
    band_powers,
    log_correlations,
    pair_rows,
    shapes,
)
from odometry.feel.recorded.windows import FeelWindows

BANDS = 8  # of an axis
LEAST_STEPS = 2  # of frequency in a band
SLOWER_SHARE = 0.96  # of the highest frequency: a run that carries a little less will do
SPECTRAL = ("gyro", "accel")
SHAPE, CROSS = "shape", "cross"
SHAPE_WORDS = ("flatness", "bandwidth")  # of the spectrum of an axis


@dataclass(frozen=True)
class Design:
    """Which columns there are.

    Attributes
    ----------
    window_s : float
    axes : tuple of str
        Of the IMU, whose bands are used.
    motion : tuple of str
        Of "yaw" and "currents".
    top_hz : float
        Upper edge of the highest band.
    layouts : tuple of int
        Numbers of bands, a table of columns each; 0 where no axis has a band. Files of older
        versions hold several.
    shaped : bool
        Whether the flatness and the bandwidth of each axis' spectrum are columns, too.
    crossed : bool
        Whether the correlations of axes in each band are columns, too.
    """

    window_s: float
    axes: tuple[str, ...]
    motion: tuple[str, ...]
    top_hz: float
    layouts: tuple[int, ...]
    shaped: bool
    crossed: bool = False

    @classmethod
    def shared(cls, windows: Sequence[FeelWindows]) -> "Design":
        """The columns that all runs have, up to the frequency that all carry."""
        axes = tuple(a for a in windows[0].axes if all(a in one.axes for one in windows))
        motion = tuple(m for m in windows[0].motion if all(m in one.motion for one in windows))
        top_hz = min(one.top_hz for one in windows)
        step_hz = max(one.step_hz for one in windows)
        most = int((top_hz - LOWEST_HZ) / (LEAST_STEPS * step_hz))
        bands = max(min(BANDS, most), 0)
        axes = axes if bands else ()
        crossed = len(axes) > 1
        return cls(windows[0].window_s, axes, motion, top_hz, (bands,), bool(axes), crossed)

    @property
    def groups(self) -> tuple[str, ...]:
        """Groups of columns: of SPECTRAL, SHAPE, CROSS, and motion."""
        spectral = [kind for kind in SPECTRAL if any(a.startswith(kind) for a in self.axes)]
        more = [SHAPE] * self.shaped + [CROSS] * self.crossed
        return (*spectral, *more, *self.motion)

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of imu.csv and odometry.csv that a run must have."""
        yaw = ("gyro_z",) if "yaw" in self.motion and "gyro_z" not in self.axes else ()
        currents = ("current_left", "current_right") if "currents" in self.motion else ()
        return (*self.axes, *yaw, *currents)

    def only(self, groups: Sequence[str]) -> "Design":
        """The same with some of the groups; without an axis, CROSS is not among them."""
        axes = tuple(axis for axis in self.axes if axis.partition("_")[0] in groups)
        motion = tuple(one for one in self.motion if one in groups)
        layouts = self.layouts if axes else (0,)
        shaped = self.shaped and bool(axes) and SHAPE in groups
        crossed = self.crossed and axes == self.axes and CROSS in groups
        return Design(self.window_s, axes, motion, self.top_hz, layouts, shaped, crossed)

    def places(self, of: "Design", layout: int) -> list[int]:
        """Where the columns of a smaller design stand among the columns of this one."""
        bands, found = self.layouts[layout], list[int]()
        width = bands + len(SHAPE_WORDS) * self.shaped
        for axis in of.axes:
            at = self.axes.index(axis) * width
            found += range(at, at + (width if of.shaped else bands))
        at = len(self.axes) * width
        width = bands * len(self.pairs)
        found += range(at, at + width) if of.crossed else []
        at += width
        for one in self.motion:
            width = WIDTHS[one]
            found += range(at, at + width) if one in of.motion else []
            at += width
        return found

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """Axes whose correlations are columns."""
        return tuple(combinations(self.axes, 2)) if self.crossed else ()

    def names(self, layout: int) -> tuple[str, ...]:
        """Each column as text."""
        edges = band_edges_hz(self.layouts[layout], self.top_hz) if self.axes else np.empty(0)
        words = [f"{a:.0f} to {b:.0f} Hz" for a, b in pairwise(edges)]
        shape = SHAPE_WORDS if self.shaped else ()
        spectral = [f"{axis} {word}" for axis in self.axes for word in (*words, *shape)]
        crossed = [f"{one} with {other} {word}" for one, other in self.pairs for word in words]
        return (*spectral, *crossed, *(word for one in self.motion for word in WORDS[one]))

    def check(self, windows: FeelWindows, where: str) -> None:
        """Raise RunFolderError unless a run has all columns, fast enough."""
        axes = [axis for axis in self.axes if axis not in windows.axes]
        lacks = axes + [one for one in self.motion if one not in windows.motion]
        if lacks:
            raise RunFolderError(
                f"{where}: no {', '.join(lacks)} that holds numbers which change; the model needs "
                f"the columns {', '.join(self.columns)}"
            )
        if self.axes and windows.top_hz < SLOWER_SHARE * self.top_hz:
            raise RunFolderError(
                f"{where}: recorded at {2 * windows.top_hz:.4g} Hz, which carries up to "
                f"{windows.top_hz:.4g} Hz; the model needs up to {self.top_hz:.4g} Hz"
            )

    def matrix(self, windows: FeelWindows, layout: int) -> FloatArray:
        """Columns (W, d) of the windows; a motor without current gives NaN."""
        parts = [windows.motion[one] for one in self.motion]
        if self.axes:
            rows = [windows.axes.index(axis) for axis in self.axes]
            edges = band_edges_hz(self.layouts[layout], self.top_hz)
            both = windows.densities[:, pair_rows(len(windows.axes), rows)]
            densities = both[:, np.equal(*np.triu_indices(len(rows)))]
            spectral = band_powers(densities, windows.step_hz, edges)
            if self.shaped:
                shape = shapes(densities, windows.step_hz, self.top_hz)
                spectral = np.concatenate([spectral, shape], axis=2)
            crossed = [log_correlations(both, windows.step_hz, edges)] if self.crossed else []
            parts = [*(one.reshape(len(windows), -1) for one in (spectral, *crossed)), *parts]
        return np.concatenate(parts, axis=1)


WORDS = {
    "yaw": ("yaw gain", "yaw residual", "yaw ratio"),
    "currents": ("current", "spread of the current"),
}
WIDTHS = {name: len(words) for name, words in WORDS.items()}
