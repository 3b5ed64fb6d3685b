"""One image with what the camera sees of the ground drawn in it."""

from matplotlib.axes import Axes

from odometry.run import Robot
from terrain.checks.shown_image import ShownImage
from terrain.report.ground_plots import (
    draw_footprint,
    draw_ground_grid,
    draw_region_ahead,
    ground_legend,
)
from terrain.report.plots import plot_image


def plot_ground(axes: Axes, robot: Robot, shown: ShownImage) -> None:
    """Draw an image with grid, footprint and region ahead, where there is a camera for it.

    Parameters
    ----------
    axes : Axes
    robot : Robot
    shown : ShownImage
    """
    ahead = f"region {shown.region.distance_ahead_m:.2g} m ahead" if shown.region else shown.reason
    plot_image(axes, shown.image, "")
    axes.set_title(f"image at {shown.run_time_s:.1f} s: {ahead}", fontsize=9.5, loc="left",
                   parse_math=False)  # fmt: skip
    if shown.camera is None:
        return
    height, width = shown.image.shape[:2]
    step_m = draw_ground_grid(axes, shown.camera, shown.region)
    draw_footprint(axes, shown.camera, robot)
    if shown.region is not None:
        draw_region_ahead(axes, shown.camera, shown.region)
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    ground_legend(axes, step_m)
