"""The terrain in the camera's image: a metric grid, the footprint and the region ahead."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from odometry.arrays import BoolArray, ByteImage, FloatArray
from odometry.outputs.output_file import picture_source
from odometry.recording.run import Robot
from odometry.report.drawing.figure import save_figure
from terrain.calibration.chessboard import BoardViews
from terrain.calibration.lens_from_boards import LensFit
from terrain.calibration.mount_from_points import MarkedPoints
from terrain.camera.camera import Camera
from terrain.checks.drawn_images import ShownImage
from terrain.region.region import Rectangle, Region
from terrain.region.whole_image import outline
from terrain.report.plots import draw_outline, plot_image

GRID = "#FFFFFF"
FOOTPRINT, REGION, ROBOT = "footprint", "region ahead", "robot_outlines"
_OUTLINES = {FOOTPRINT: "#99DDFF", REGION: "#EEDD88", ROBOT: "#FFAABB"}  # bright, with dark edges
NEAR_M = 4.0  # a region as near as this gets a grid of half metres
BEHIND_M, ASIDE_M, BEYOND_M = 1.0, 3.0, 2.0  # of the robot's middle, and beyond the region
FINE_M = 0.02
APART = 0.06  # of the image's height, between two distances that are written
_HALO = (withStroke(linewidth=2.5, foreground="black"),)

WIDTH_IN, MARGIN_IN = 9.0, 0.75
RIGHT, WRONG = "#0072B2", "#D55E00"
_BOX = {"facecolor": "#000000AA", "edgecolor": "none", "pad": 1.5}
SOURCE = picture_source("camera")


def draw_ground_grid(axes: Axes, camera: Camera, region: Region | None) -> float:
    """Draw a metric grid of robot-frame x and y on the raw image, with distances ahead.

    Parameters
    ----------
    axes : Axes
        That show the image.
    camera : Camera
    region : Region or None
        The grid goes beyond it.

    Returns
    -------
    float
        Between two lines [m].
    """
    farthest_m = (region.rectangle.x_max if region is not None else NEAR_M) + BEYOND_M
    step_m = 0.5 if farthest_m - BEYOND_M <= NEAR_M else 1.0
    across, along = np.arange(-ASIDE_M, ASIDE_M + 1e-9, FINE_M), np.arange(
        -BEHIND_M, farthest_m, FINE_M
    )  # fmt: skip
    for x in np.arange(-BEHIND_M, farthest_m, step_m):
        _line(axes, camera, np.stack([np.full(len(across), x), across], axis=-1))
    for y in np.arange(-ASIDE_M, ASIDE_M + 1e-9, step_m):
        _line(axes, camera, np.stack([along, np.full(len(along), y)], axis=-1), y == 0)
    _write_distances(axes, camera, np.arange(0.0, farthest_m, step_m))
    return step_m


def draw_footprint(axes: Axes, camera: Camera, robot: Robot) -> None:
    """Outline the robot's footprint."""
    length, width = robot.length or robot.track_width, robot.width or robot.track_width
    _outlined(axes, camera, Rectangle(-length / 2, length / 2, -width / 2, width / 2), FOOTPRINT)


def draw_region_ahead(axes: Axes, camera: Camera, region: Region) -> None:
    """Outline the region that vision would read."""
    _outlined(axes, camera, region.rectangle, REGION)


def ground_legend(axes: Axes, step_m: float) -> None:
    """Say below the image what the lines are that are drawn in it."""
    drawn = [patch.get_gid() for patch in axes.patches]
    lines = {f"grid of {step_m:g} m": GRID} if axes.lines else {}
    lines |= {name: colour for name, colour in _OUTLINES.items() if name in drawn}
    handles = [
        Line2D([], [], color=colour, linewidth=2.0, label=name, path_effects=[*_HALO])
        for name, colour in lines.items()
    ]
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, 0.0), ncols=3,
                frameon=False, fontsize=9, borderaxespad=0.3, columnspacing=1.2)  # fmt: skip


def _line(axes: Axes, camera: Camera, ground: FloatArray, thick: bool = False) -> None:
    pixels = camera.ground_to_pixels(ground)
    if not camera.in_image(pixels).any():
        return
    u, v = pixels.T
    axes.plot(u, v, color=GRID, linewidth=1.4 if thick else 0.7, alpha=0.8,
              path_effects=[withStroke(linewidth=2.2 if thick else 1.3, foreground="#00000066")],
              scalex=False, scaley=False)  # fmt: skip


def _write_distances(axes: Axes, camera: Camera, ahead_m: FloatArray) -> None:
    """Write distances on the line straight ahead, near ones first, where there is room."""
    pixels = camera.ground_to_pixels(np.stack([ahead_m, np.zeros(len(ahead_m))], axis=-1))
    last_v, room = np.inf, APART * camera.image_size[1]
    for x, pixel in zip(ahead_m, pixels, strict=True):
        if camera.in_image(pixel) and abs(last_v - pixel[1]) > room:
            last_v = float(pixel[1])
            axes.annotate(f"{x:g} m", (float(pixel[0]), last_v), (3.0, 2.0), fontsize=8,
                          textcoords="offset points", color="white",
                          path_effects=_HALO)  # fmt: skip


def _outlined(axes: Axes, camera: Camera, rectangle: Rectangle, name: str) -> None:
    """Draw the part of a rectangle that the image shows."""
    shape = camera.ground_to_pixels(outline(rectangle))
    if camera.in_image(shape).any():
        draw_outline(axes, shape, _OUTLINES[name], name)


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
    for robot_outline in shown.camera.robot_outlines:
        draw_outline(axes, robot_outline, _OUTLINES[ROBOT], ROBOT)
    if shown.region is not None:
        draw_region_ahead(axes, shown.camera, shown.region)
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    ground_legend(axes, step_m)


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
