"""Make the pictures of the READMEs: `python notebooks/pictures.py [--out FOLDER]`.

`first_page.jpg` needs the folder `camera-frames` of the reference data, found through the
environment variable TERRAIN_ODOMETRY_DATA; without it only `frame.png` is made. The same versions
of the packages give the same bytes.
"""

import argparse
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Polygon, Rectangle
from matplotlib.patheffects import withStroke

import odometry
import terrain
from odometry.report.drawing.figure import terrain_colours
from terrain.calibration.look_ahead import look_ahead
from terrain.camera_files.read import read_calibration
from terrain.camera_files.transforms import mount_in, read_transforms
from terrain.demo import WITH, WITHOUT
from terrain.images import read_image
from terrain.result.switch_delay import true_stretches

Point = tuple[float, float]
OUT = Path(__file__).parent / "pictures"
SEEN, BLIND, TRUTH = "#0072B2", "#D55E00", "#000000"
STYLE = {"font.size": 15.0, "axes.spines.top": False, "axes.spines.right": False}
DPI = 200  # of 8.3 inches: twice the width at which a page shows them
SKY_PX = 470  # rows of the photograph that show no terrain
HALO = [withStroke(linewidth=4.0, foreground="black")]
HUSKY = odometry.Robot(track_width=0.55, length=0.99, width=0.67)


def first_page(file: Path, frames: Path, seen: terrain.RunResult, blind: terrain.RunResult) -> None:
    """Region ahead on the frame of a real robot; path and ICRs of the demo."""

    def draw(figure: Figure) -> None:
        draw_frame(figure.add_axes((0.0, 0.485, 1.0, 0.515)), frames)
        draw_path(figure.add_axes((0.085, 0.12, 0.4, 0.3)), seen)
        draw_icrs(figure.add_axes((0.595, 0.12, 0.395, 0.3)), seen, blind)

    save(file, (8.3, 6.1), draw)


def draw_frame(axes: Axes, frames: Path) -> None:
    """Where `run` would look on a frame of the Husky that drives straight on."""
    lens = read_calibration(frames / "camera_front.yaml").lens
    mount = mount_in(read_transforms(frames / "transformations.yaml"), "camera_front")
    camera = terrain.Camera.from_mount(lens.image_size, lens.matrix, lens.distortion, mount)
    ahead = look_ahead(camera, HUSKY)
    if isinstance(ahead, str):
        raise terrain.TerrainError(ahead)
    axes.imshow(read_image(frames / "camera_front.jpg"))
    x = np.linspace(0.0, ahead.region.rectangle.x_max, 200)
    for side in (-0.5, 0.5):
        tread = np.stack([x, np.full_like(x, side * HUSKY.track_width)], axis=-1)
        axes.plot(*camera.ground_to_pixels(tread).T, "--", color="white", linewidth=2.5,
                  path_effects=HALO)  # fmt: skip
    corners = ahead.region.rectangle.corners
    ground = np.concatenate(
        [np.linspace(a, b, 50) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)]
    )
    shape = camera.ground_to_pixels(ground)
    axes.add_patch(Polygon(shape, facecolor="#EEDD8855", edgecolor="black", linewidth=5.0))
    axes.add_patch(Polygon(shape, fill=False, edgecolor="#EEDD88", linewidth=3.0))
    near, far = ahead.region.rectangle.x_min, ahead.region.rectangle.x_max
    axes.annotate(
        f"region ahead:\n{near:.1f} to {far:.1f} m",
        (float(shape[:, 0].max()), float(shape[:, 1].mean())), (10.0, 0.0), va="center",
        textcoords="offset points", color="white", path_effects=HALO)  # fmt: skip
    axes.text(
        20, SKY_PX + 20, "frame of a Clearpath Husky", color="white", va="top", path_effects=HALO
    )
    width, height = lens.image_size
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, SKY_PX), aspect="auto")
    axes.set_axis_off()


def draw_path(axes: Axes, seen: terrain.RunResult) -> None:
    """The shipped run from above: terrain, truth, odometer, ideal differential drive."""
    truth, stretches = seen.reference, true_stretches(seen)
    tints = terrain_colours(stretch.terrain for stretch in stretches)
    for stretch in stretches:
        there = (truth.stamps_s >= stretch.start_s) & (truth.stamps_s <= stretch.end_s)
        x, y = truth.poses[there, :2].T
        axes.plot(x, y, color=tints[stretch.terrain], linewidth=16, solid_capstyle="butt", zorder=0)
        axes.annotate(stretch.terrain, (float(x.mean()), -2.0), ha="center", va="top", fontsize=14)
    lines = seen.replay.open_loop(seen.run.robot.track_width)
    ideal, odometer = lines["differential_drive"].poses, lines["odometer"].poses
    axes.plot(*truth.poses[:, :2].T, color=TRUTH, linewidth=4.0)
    axes.plot(*odometer[:, :2].T, "--", color="white", linewidth=1.6)
    axes.plot(*ideal[:, :2].T, "-.", color=BLIND, linewidth=2.5)
    off_m = np.linalg.norm(ideal[-1, :2] - truth.poses[-1, :2])
    axes.annotate(f"ideal drive:\n{off_m:.0f} m off", (0.0, 10.5), color=BLIND, va="top")
    axes.annotate("truth, odometer", (36.9, 2.7), ha="right", va="center", fontsize=12)
    axes.set(xlim=(-1.0, 37.0), ylim=(-5.5, 12.0), xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal")
    axes.set_yticks([0, 5, 10])
    axes.set_title("simulated run: path", loc="left", fontsize=15)


def draw_icrs(axes: Axes, seen: terrain.RunResult, blind: terrain.RunResult) -> None:
    """Lateral ICRs over time: truth, with the terrain seen ahead and without."""
    truth = seen.run.truth
    for row, name in ((3, "y_left"), (4, "y_right")):
        axes.plot(blind.replay.stamps_s, blind.replay.means[:, row], "-.", color=BLIND, linewidth=3)
        axes.plot(seen.replay.stamps_s, seen.replay.means[:, row], color=SEEN, linewidth=3)
        axes.plot(truth.stamps_s, truth[name], "--", color=TRUTH, linewidth=1.8)
        axes.annotate(name, (0.0, 0.55 * truth[name][0]), va="center", fontsize=14)
    axes.annotate("camera", (28.0, 0.6), color=SEEN, ha="center", va="center")
    axes.annotate("no camera", (28.0, 0.15), color=BLIND, ha="center", va="center")
    axes.annotate("truth (dashed)", (56.0, 0.0), color=TRUTH, ha="right", va="center")
    axes.set(xlabel="time [s]", ylabel="ICRs [m]", ylim=(-0.6, 0.72), yticks=(-0.5, 0.0, 0.5))
    axes.set_title("its centres of rotation", loc="left", fontsize=15)


def frame(file: Path) -> None:
    """Axes, tread speeds, turn rate and tread ICRs of a left turn, seen from above."""
    y_left, y_right, x_icr, half_m = 0.75, -0.65, -0.15, 0.3

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.axhline(x_icr, color=SEEN, linestyle="dotted", zorder=0)
        axes.add_patch(Rectangle((-0.3, -0.5), 0.6, 1.0, facecolor="#DDDDDD", edgecolor="black"))
        for y, speed in ((half_m, 0.35), (-half_m, 0.75)):
            axes.add_patch(Rectangle((-y - 0.08, -0.45), 0.16, 0.9, facecolor="#777777"))
            arrow(axes, (-y, 0.0), (-y, speed), BLIND)
        arrow(axes, (0.0, 0.0), (0.0, 0.95), TRUTH)
        arrow(axes, (0.0, 0.0), (-1.0, 0.0), TRUTH)
        arrow(axes, (0.14, 0.6), (-0.14, 0.6), TRUTH, "arc3,rad=0.5")
        axes.plot([-y_left, -y_right], [x_icr, x_icr], "o", color=SEEN, markersize=11)
        for place, text, colour in (
            ((0.0, 1.03), "x", TRUTH),
            ((-1.07, 0.0), "y", TRUTH),
            ((-0.42, 0.62), "omega", TRUTH),
            ((-0.6, 0.3), "v_left", BLIND),
            ((0.56, 0.7), "v_right", BLIND),
            ((-y_left, x_icr - 0.16), "x_icr, y_left", SEEN),
            ((-y_right + 0.1, x_icr - 0.16), "x_icr, y_right", SEEN),
        ):
            axes.annotate(text, place, color=colour, ha="center", va="center")
        axes.set(xlim=(-1.35, 1.35), ylim=(-0.65, 1.2), aspect="equal")
        axes.set_axis_off()

    save(file, (6.0, 4.1), draw)


def arrow(axes: Axes, start: Point, end: Point, colour: str, curve: str = "arc3") -> None:
    """Draw an arrow from start to end."""
    axes.add_patch(
        FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=22, linewidth=2.5, shrinkA=0,
                        shrinkB=0, color=colour, connectionstyle=curve, zorder=3))  # fmt: skip


def save(file: Path, size_in: tuple[float, float], draw: Callable[[Figure], None]) -> None:
    """Draw a figure and write it, without the settings of the user's own matplotlib."""
    with style.context(["default", STYLE]):
        figure = Figure(figsize=size_in, dpi=DPI, facecolor="white")
        FigureCanvasAgg(figure)
        draw(figure)
        if file.suffix == ".jpg":
            figure.savefig(file, pil_kwargs={"quality": 85, "subsampling": 0})
        else:
            figure.savefig(file, metadata={"Software": None})


def main() -> None:
    """Make all pictures that the reference data allows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=OUT)
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    frame(out / "frame.png")
    data = os.environ.get("TERRAIN_ODOMETRY_DATA")
    if data is None:
        print("TERRAIN_ODOMETRY_DATA is not set: first_page.jpg needs its folder camera-frames")
        return
    with tempfile.TemporaryDirectory() as folder:
        results, _ = terrain.run_demo(folder)
    frames = Path(data) / "camera-frames/husky"
    first_page(out / "first_page.jpg", frames, results[WITH], results[WITHOUT])


if __name__ == "__main__":
    main()
