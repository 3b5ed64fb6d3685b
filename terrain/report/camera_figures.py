"""The terrain in a camera's image, and how well its calibration fits, as PNG files."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from odometry.arrays import BoolArray, ByteImage, FloatArray
from odometry.outputs.output_file import picture_source
from odometry.report.figure import save_figure
from odometry.run import Robot
from terrain.calibration.chessboard import BoardViews
from terrain.calibration.lens_from_boards import LensFit
from terrain.calibration.marked_points import MarkedPoints
from terrain.camera import Camera
from terrain.checks.drawn_images import ShownImage
from terrain.report.ground_plots import draw_ground_grid, plot_ground
from terrain.report.plots import plot_image

WIDTH_IN, MARGIN_IN = 9.0, 0.75
RIGHT, WRONG = "#0072B2", "#D55E00"
_BOX = {"facecolor": "#000000AA", "edgecolor": "none", "pad": 1.5}
SOURCE = picture_source("camera")


def write_ground_figures(folder: Path, robot: Robot, shown: Sequence[ShownImage]) -> list[Path]:
    """Draw each image with grid, footprint and region ahead, as terrain_1.png and so on."""
    return [
        _image_figure(folder / f"terrain_{number}.png", one.image, _ground(robot, one))
        for number, one in enumerate(shown, start=1)
    ]


def write_points_figure(file: Path, image: ByteImage, camera: Camera, points: MarkedPoints) -> Path:
    """Draw marked points on an image (crosses) and where the mount puts them (rings)."""
    put = camera.ground_to_pixels(points.ground_m)
    errors_px = np.linalg.norm(put - points.pixels, axis=1)

    def draw(axes: Axes) -> None:
        plot_image(axes, image, "")
        draw_ground_grid(axes, camera, None)
        axes.plot(*points.pixels.T, "+", color=WRONG, markersize=12, markeredgewidth=2.0)
        axes.plot(*put.T, "o", color="white", markersize=11, fillstyle="none", markeredgewidth=1.6)
        for line, pixel, error in zip(points.lines, points.pixels, errors_px, strict=True):
            inwards = ("left", 9) if pixel[0] < 0.8 * camera.image_size[0] else ("right", -9)
            axes.annotate(f"row {line}: {error:.1f} px", tuple(pixel), (inwards[1], 5),
                          fontsize=8.5, ha=inwards[0],
                          textcoords="offset points", color="white",
                          bbox=_BOX)  # fmt: skip
        height, width = image.shape[:2]
        axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
        axes.set_title("marked points (+) and where the mount puts them (o)", fontsize=9.5,
                       loc="left")  # fmt: skip

    return _image_figure(file, image, draw)


def write_flow_figure(
    file: Path, image: ByteImage, camera: Camera, features: FloatArray, agrees: BoolArray
) -> Path:
    """Draw on one image where features (N, 2) were followed and which moved as terrain (N,)."""

    def draw(axes: Axes) -> None:
        plot_image(axes, image, "")
        draw_ground_grid(axes, camera, None)
        for chosen, colour, marker in ((~agrees, WRONG, "x"), (agrees, RIGHT, ".")):
            axes.plot(*features[chosen].T, marker, color=colour, markersize=4, markeredgewidth=1.0)
        height, width = image.shape[:2]
        axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
        axes.set_title(
            f"features of all images: {np.count_nonzero(agrees)} move as terrain does (dots), "
            f"{np.count_nonzero(~agrees)} do not (crosses)", fontsize=9.5, loc="left")  # fmt: skip

    return _image_figure(file, image, draw)


def write_board_figure(file: Path, seen: BoardViews, fit: LensFit) -> Path:
    """Draw where corners were found in the image, and the error of each photograph."""

    def draw(figure: Figure) -> None:
        image, errors = figure.subplots(1, 2, width_ratios=[1.5, 1.0])
        width, height = seen.image_size
        for view in seen.views:
            image.plot(*view.corners_px.T, ".", markersize=3)
        for share in (1 / 3, 2 / 3):
            image.axvline(share * width, color="#CCCCCC", linewidth=0.8, zorder=0)
            image.axhline(share * height, color="#CCCCCC", linewidth=0.8, zorder=0)
        image.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5), aspect="equal",
                  xlabel="u [px]", ylabel="v [px]", title="corners in the image")  # fmt: skip
        names = [view.file.name for view in seen.views]
        errors.barh(range(len(names)), fit.photo_rms_px, color=RIGHT)
        errors.axvline(fit.rms_px, color="black", linestyle="dashed", linewidth=1.0)
        errors.set_yticks(range(len(names)), [name[-24:] for name in names], fontsize=7,
                          parse_math=False)  # fmt: skip
        errors.invert_yaxis()
        errors.set(xlabel="reprojection error, RMS [px]", title=f"all: {fit.rms_px:.2f} px")
        figure.tight_layout()

    height_in = max(4.0, 0.18 * len(seen.views) + 1.2)
    return save_figure(file, (11.0, height_in), draw, source=SOURCE)


def _ground(robot: Robot, shown: ShownImage) -> Callable[[Axes], None]:
    def draw(axes: Axes) -> None:
        plot_ground(axes, robot, shown)

    return draw


def _image_figure(file: Path, image: ByteImage, draw_on: Callable[[Axes], None]) -> Path:
    height, width = image.shape[:2]
    height_in = WIDTH_IN * height / width + MARGIN_IN

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.01, 0.42 / height_in, 0.98, 1 - MARGIN_IN / height_in))
        draw_on(axes)

    return save_figure(file, (WIDTH_IN, height_in), draw, source=SOURCE)
