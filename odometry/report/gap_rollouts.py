"""Whole runs driven open loop: measured, by the model, and by the model with its effects."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.effects.base_model import Base
from odometry.effects.corrected import Added
from odometry.gap.result import GapResult
from odometry.gap.simulate import simulated_poses
from odometry.geometry import se2
from odometry.report.figure import save_figure
from odometry.report.gap_figures import RUNS, STAGES, WIDTH_IN
from odometry.report.html import Picture
from odometry.report.map_plots import plot_paths
from odometry.report.palette import REFERENCE_STYLE
from odometry.trajectory import Trajectory
from odometry.windows.dense import DenseWindows

MEASURED_NAME = "measured"
STYLES = {MEASURED_NAME: REFERENCE_STYLE, **STAGES}


def rollout_pictures(result: GapResult, folder: Path) -> list[Picture]:
    """One map for each held-out run, at most `RUNS`."""
    found = []
    for number, scene in enumerate(result.holdout_scenes[:RUNS], start=1):
        paths = rollouts(result, scene)
        spans = np.ptp(np.concatenate([path.poses[:, :2] for path in paths.values()]), axis=0)
        height_in = 0.9 + 5.0 * float(np.clip(spans[1] / max(spans[0], 1e-9), 0.4, 1.1))
        file = folder / f"gap_rollout_{number}.png"
        found.append(
            Picture(
                save_figure(file, (WIDTH_IN, height_in), _drawing(paths, height_in)),
                f"Paths of {scene.run.name}: measured, and open loop.",
                f"{scene.run.name}, open loop over the whole run of "
                f"{paths[MEASURED_NAME].stamps_s[-1]:.0f} s, starting at its first measured pose, "
                "without any correction: " + _ends(paths),
            )
        )
    return found


def rollouts(result: GapResult, scene: DenseWindows) -> dict[str, Trajectory]:
    """Paths by name at the stamps of the measured poses."""
    measured = {MEASURED_NAME: Trajectory(scene.pose_s, scene.poses)}
    stages = result.stages.items()
    return measured | {name: rollout(base, added, scene) for name, (base, added) in stages}


def rollout(base: Base, effects: Sequence[Added], scene: DenseWindows) -> Trajectory:
    """Simulated poses of a whole run, as the reference sensor measures them, from its first."""
    seen = simulated_poses(base, effects, scene)
    moved = se2.compose(scene.poses[:1], se2.between(seen[:1], seen))
    return Trajectory(scene.pose_s, moved)


def _drawing(paths: dict[str, Trajectory], height_in: float) -> Callable[[Figure], None]:
    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.1, 0.55 / height_in, 0.74, 1 - 0.7 / height_in))
        plot_paths(axes, paths, STYLES)

    return draw


def _ends(paths: dict[str, Trajectory]) -> str:
    true = paths[MEASURED_NAME].poses[:, :2]
    words = []
    for name, path in paths.items():
        if name == MEASURED_NAME:
            continue
        away = np.hypot(*(path.poses[:, :2] - true).T)
        words.append(
            f"{np.sqrt((away**2).mean()):.3g} m RMS and {away[-1]:.3g} m at the end {name}"
        )
    return f"{', '.join(words)}."
