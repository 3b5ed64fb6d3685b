"""Whether vibration can be that of the IMU which a model was identified with, by its spectrum."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.classifier.design import LEAST_STEPS, Design
from odometry.feel.recorded.spectra import LEAST_POWER, LOWEST_HZ, band_edges_hz, pair_rows
from odometry.feel.recorded.windows import FeelWindows
from odometry.recording.run import UNKNOWN

BANDS = 12
LEAST_RUNS = 8  # of fewer the usual shape is not known
LEAST_WINDOWS = 8  # that move; the mean of fewer is no shape of a run
LIKE_SHARE = 0.2  # of the parts of a run of another IMU: filters leave 0 to 0.11, its own 0.97


@dataclass(frozen=True)
class SensorShape:
    """The shape of the spectrum that the runs of a model share, whatever their terrain.

    A shape is the logarithm of the density in equally wide bands less its mean, and the mean of
    that over all axes. Terrains change it less than a filter, another sampling rate or a soft
    mounting of the IMU, which change all axes alike. With both kinds of axes there is one number
    more: the mean logarithm of the gyroscope less that of the accelerations. How much a robot
    rotates while it is shaken is its geometry, and another scale of one kind changes it.

    Attributes
    ----------
    edges_hz : (B + 1,)
    mean, deviation : (N,)
        Over runs; N is B, or with the ratio of both kinds of axes B + 1.
    limits : (1,) or (2,)
        Greatest distance (see `_distances`) of one of the runs from the others, of the shape and
        of the ratio.
    """

    edges_hz: FloatArray
    mean: FloatArray
    deviation: FloatArray
    limits: FloatArray

    @classmethod
    def of(
        cls, windows: Sequence[FeelWindows], design: Design, numbers: IntArray | None = None
    ) -> "SensorShape | None":
        """Of the R runs of a model; None where they are few, or no axis has bands.

        Those with the same number (R,) count as one.
        """
        bands = _bands(windows, design)
        edges_hz = band_edges_hz(bands, design.top_hz)
        numbers = np.arange(len(windows)) if numbers is None else numbers
        by_run: dict[int, list[FloatArray]] = {}
        for one, number in zip(windows, numbers.tolist(), strict=True):
            rows = one.felt & (one.labels != UNKNOWN)
            if bands:
                by_run.setdefault(number, []).extend(shapes(one, design.axes, edges_hz)[rows])
        runs = [np.mean(of, axis=0) for of in by_run.values() if len(of) >= LEAST_WINDOWS]
        if len(runs) < LEAST_RUNS:
            return None
        table = np.array(runs)
        others = [np.delete(table, row, axis=0) for row in range(len(table))]
        apart = [
            _distances(row, of.mean(axis=0), of.std(axis=0, ddof=1), bands)
            for row, of in zip(table, others, strict=True)
        ]
        mean, deviation = table.mean(axis=0), table.std(axis=0, ddof=1)
        return cls(edges_hz, mean, deviation, np.max(apart, axis=0))

    def of_windows(self, windows: FeelWindows, axes: Sequence[str]) -> FloatArray:
        """Shapes (W, N) of windows; files before version 0.16 hold no ratio."""
        return shapes(windows, axes, self.edges_hz)[:, : len(self.mean)]

    def excess(self, shape: FloatArray) -> FloatArray:
        """The larger distance of shapes (..., N), in units of its limit."""
        return np.asarray(self._excesses(shape).max(axis=-1))

    def _excesses(self, shape: FloatArray) -> FloatArray:
        apart = _distances(shape, self.mean, self.deviation, len(self.edges_hz) - 1)
        return np.asarray(apart / self.limits)

    def words(self, shape: FloatArray) -> str:
        """What of a shape (N,) is farthest off, and how."""
        bands = len(self.edges_hz) - 1
        if self._excesses(shape).argmax():
            times = np.exp((shape[bands] - self.mean[bands]) / 2)
            return (
                f"The vibration turns the robot {times:.2g} times as much, against how it moves "
                "it, as in the runs of the model: another scale or unit of the gyroscope or of the "
                "accelerations"
            )
        off = ((shape - self.mean) / self.deviation)[:bands]
        most = int(np.abs(off).argmax())
        low, high = self.edges_hz[most : most + 2]
        how = f"{'weaker' if off[most] < 0 else 'stronger'} from {low:.0f} to {high:.0f} Hz"
        return (
            "The shape of the vibration's spectrum, all axes together, is unlike that of every run "
            f"of the model ({how}): another filter, sampling rate or mounting of the IMU"
        )

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {
            "sensor_edges": self.edges_hz,
            "sensor_mean": self.mean,
            "sensor_deviation": self.deviation,
            "sensor_limit": self.limits,
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray]) -> "SensorShape | None":
        """Rebuild from what `arrays` gave; None of a file without.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "sensor_mean" not in arrays:
            return None
        edges, mean, deviation, limits = (
            arrays[f"sensor_{name}"] for name in ("edges", "mean", "deviation", "limit")
        )
        sizes = len(edges) - 2 + len(limits)
        if not mean.shape == deviation.shape == (sizes,) or limits.shape not in ((1,), (2,)):
            raise ValueError(f"shapes of spectra: {mean.shape}, {deviation.shape}, {edges.shape}")
        if not (deviation > 0).all() or not (limits > 0).all():
            raise ValueError("shapes of spectra without spread")
        return cls(edges, mean, deviation, limits)


@dataclass(frozen=True)
class ShapeSoFar:
    """The mean shape of windows that move, of all and by parts; every method gives a new one.

    An IMU stays the same through a run, terrains do not: it is another one only where the mean is
    unlike, and at most LIKE_SHARE of the parts of LEAST_WINDOWS, one after another, are like.

    Attributes
    ----------
    sensor : SensorShape or None
        Without one no IMU is another.
    axes : tuple of str
        Of the model.
    total, part : (N,)
        Sums over all windows, and over those of the part that goes on.
    count : int
        Of windows.
    like : int
        Of the parts that lie within the limit.
    """

    sensor: SensorShape | None
    axes: tuple[str, ...]
    total: FloatArray
    part: FloatArray
    count: int = 0
    like: int = 0

    @classmethod
    def none(cls, sensor: SensorShape | None, axes: tuple[str, ...]) -> "ShapeSoFar":
        """Of no window yet."""
        nothing = np.zeros(0 if sensor is None else len(sensor.mean))
        return cls(sensor, axes, nothing, nothing)

    def plus(self, windows: FeelWindows) -> "ShapeSoFar":
        """With more windows."""
        if self.sensor is None or not windows.felt.any():
            return self
        found = self
        for shape in self.sensor.of_windows(windows, self.axes)[windows.felt]:
            found = found._with(self.sensor, shape)
        return found

    def _with(self, sensor: SensorShape, shape: FloatArray) -> "ShapeSoFar":
        total, part, count, like = self.total + shape, self.part + shape, self.count + 1, self.like
        if count % LEAST_WINDOWS == 0:
            like += int(sensor.excess(part / LEAST_WINDOWS) <= 1)
            part = np.zeros_like(part)
        return ShapeSoFar(sensor, self.axes, total, part, count, like)

    @property
    def is_foreign(self) -> bool:
        """Whether it is of another IMU."""
        parts = self.count // LEAST_WINDOWS
        if self.sensor is None or not parts or self.like > LIKE_SHARE * parts:
            return False
        return bool(self.sensor.excess(self.total / self.count) > 1)

    @property
    def words(self) -> str:
        """Where it is farthest off."""
        return "" if self.sensor is None else self.sensor.words(self.total / max(self.count, 1))


def shapes(windows: FeelWindows, axes: Sequence[str], edges_hz: FloatArray) -> FloatArray:
    """The shape (W, B) of the spectrum of each window, and with both kinds of axes the ratio."""
    rows = [windows.axes.index(axis) for axis in axes]
    both = windows.densities[:, pair_rows(len(windows.axes), rows)]
    logs = np.log(both[:, np.equal(*np.triu_indices(len(rows)))] + LEAST_POWER)
    first = np.searchsorted(np.arange(logs.shape[-1]) * windows.step_hz, edges_hz - 1e-9)
    bands = np.stack([logs[..., a:b].mean(axis=-1) for a, b in pairwise(first)], axis=-1)
    levels = bands.mean(axis=-1)
    shape = (bands - levels[..., None]).mean(axis=1)
    gyro = np.array([axis.startswith("gyro") for axis in axes])
    if gyro.all() or not gyro.any():
        return np.asarray(shape)
    ratio = levels[:, gyro].mean(axis=1) - levels[:, ~gyro].mean(axis=1)
    return np.column_stack([shape, ratio])


def _bands(windows: Sequence[FeelWindows], design: Design) -> int:
    step_hz = max(one.step_hz for one in windows)
    most = int((design.top_hz - LOWEST_HZ) / (LEAST_STEPS * step_hz))
    return min(BANDS, most) if design.axes else 0


def _distances(
    shape: FloatArray, mean: FloatArray, deviation: FloatArray, bands: int
) -> FloatArray:
    """Mean square of the differences of shapes (..., N), in deviations, of the bands (..., 1).

    With the ratio, beside it the square of its difference (..., 2).
    """
    squares = ((shape - mean) / deviation) ** 2
    of_bands = squares[..., :bands].mean(axis=-1, keepdims=True)
    return np.concatenate([of_bands, squares[..., bands:]], axis=-1)
