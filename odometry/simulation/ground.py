"""A flat ground of terrain strips, and the share of each strip under a footprint."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class GroundMap:
    """Strips of terrain laid across the way, which leads along world x.

    The first strip reaches back and the last one ahead without end. All edges follow one wave
    along world y, so that they are not quite straight.

    Attributes
    ----------
    edges_m : (n - 1,) array
        World x of the edges between strips, increasing [m].
    terrains : (n,) tuple of str
        Terrain of each strip; strips may share one.
    wave_amplitude_m : float
        Amplitude of the longer of the two waves in each edge [m]; 0 gives straight edges.
    wave_phases_rad : (float, float)
        Phases of the two waves.
    """

    edges_m: FloatArray
    terrains: tuple[str, ...]
    wave_amplitude_m: float = 0.0
    wave_phases_rad: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        edges = np.asarray(self.edges_m, dtype=np.float64)
        if edges.shape != (len(self.terrains) - 1,) or (np.diff(edges) <= 0).any():
            raise ValueError(
                f"{len(self.terrains)} strips need {len(self.terrains) - 1} increasing edges, "
                f"found {edges.tolist()}"
            )
        object.__setattr__(self, "edges_m", edges)

    def edge_offset_m(self, y_world: FloatArray) -> FloatArray:
        """How far the edges bulge towards +x at world y; any shape."""
        long_phase, short_phase = self.wave_phases_rad
        long = np.sin(y_world * (2 * np.pi / 1.7) + long_phase)
        short = np.sin(y_world * (2 * np.pi / 0.43) + short_phase)
        return np.asarray(self.wave_amplitude_m * (long + 0.4 * short))

    def strip_at(self, points_world: FloatArray) -> IntArray:
        """Index of the strip at world points (..., 2), as (...) integers."""
        along = points_world[..., 0] - self.edge_offset_m(points_world[..., 1])
        return np.asarray(np.searchsorted(self.edges_m, along, side="right"), dtype=np.int64)

    def strip_shares(self, points_world: FloatArray) -> FloatArray:
        """Share of each strip (n,) among world points (m, 2); they add up to 1."""
        counts = np.bincount(self.strip_at(points_world), minlength=len(self.terrains))
        return np.asarray(counts / len(points_world))


def footprint_points(length_m: float, width_m: float) -> FloatArray:
    """Body points (m, 2) spread evenly over the rectangle on which the robot stands."""
    along = _cell_centres(length_m, 15)
    across = _cell_centres(width_m, 5)
    return np.stack(np.meshgrid(along, across), axis=-1).reshape(-1, 2)


def to_world(pose_world: FloatArray, points_body: FloatArray) -> FloatArray:
    """Carry body points (..., 2) to the world by a pose (x, y, yaw)."""
    cosine, sine = np.cos(pose_world[2]), np.sin(pose_world[2])
    x = cosine * points_body[..., 0] - sine * points_body[..., 1] + pose_world[0]
    y = sine * points_body[..., 0] + cosine * points_body[..., 1] + pose_world[1]
    return np.stack([x, y], axis=-1)


def _cell_centres(length_m: float, cells: int) -> FloatArray:
    return np.asarray(((np.arange(cells) + 0.5) / cells - 0.5) * length_m)
