"""Images with their regions and labels, each figure drawn on given axes."""

from collections.abc import Mapping, Sequence
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke

from odometry.arrays import ByteImage, FloatArray, IntArray
from odometry.evaluation.stretches import Stretch
from odometry.recording.run import UNKNOWN
from terrain.camera.camera import Camera
from terrain.image_labels.image_label import ImageLabel
from terrain.region.whole_image import Cell, outline

NO_LABEL = "no label"
_TITLE_LETTERS = 50  # of a line above an image in two columns
_SHORTEST_NAMED = 0.05  # of the time axis: the name would not fit
_HALO = (withStroke(linewidth=3.0, foreground="black"),)


def plot_image(axes: Axes, image: ByteImage, title: str) -> None:
    """Draw an image (H, W, 3) or (H, W) with no frame, pixel (0, 0) centred at the origin.

    A long title is set in smaller lines, so that it stays above its image.
    """
    axes.imshow(image, cmap="gray", vmin=0, vmax=255, interpolation="antialiased")
    axes.set_axis_off()
    lines = fill(title, _TITLE_LETTERS)
    axes.set_title(lines, fontsize=8.0 if "\n" in lines else 9.5, parse_math=False)


def draw_region(
    axes: Axes, camera: Camera, image_label: ImageLabel, tints: Mapping[str, str]
) -> None:
    """Outline the region of an image label on the raw image, with its label and confidence.

    That of `unknown` is not written: it is the probability of a known terrain.

    Parameters
    ----------
    axes : Axes
        That show the image.
    camera : Camera
    image_label : ImageLabel
        Nothing is drawn if it has no region.
    tints : Mapping of terrain to colour
    """
    if image_label.region is None:
        return
    colour = tints.get(image_label.label, "#FFFFFF")
    shape = camera.ground_to_pixels(outline(image_label.region.rectangle))
    draw_outline(axes, shape, colour)
    name = image_label.label or NO_LABEL
    sure = image_label.confidence if image_label.label != UNKNOWN else np.nan  # of a known terrain
    percent = f" {100 * sure:.0f} %" if np.isfinite(sure) else ""
    _write_inside(axes, shape, f"{name}{percent}", 10.0)


def draw_cells(axes: Axes, camera: Camera, cells: Sequence[Cell], tints: Mapping[str, str]) -> None:
    """Tint every classified cell of terrain on the raw image, as in Fig. 6 of Chen 2023.

    Parameters
    ----------
    axes : Axes
        That show the image.
    camera : Camera
    cells : sequence of Cell
    tints : Mapping of terrain to colour
    """
    for cell in cells:
        label = cell.classification.label
        shape = camera.ground_to_pixels(outline(cell.rectangle))
        axes.add_patch(
            Polygon(shape, facecolor=tints[label], alpha=0.45, edgecolor="none", gid=label)
        )
        axes.add_patch(Polygon(shape, fill=False, edgecolor="white", linewidth=0.7))
        _write_inside(axes, shape, label, 6.0)


def plot_labels(
    axes: Axes,
    image_labels: Sequence[ImageLabel],
    in_force: Sequence[Stretch],
    truth: Sequence[Stretch],
    tints: Mapping[str, str],
) -> None:
    """Draw along time what each image was taken for, and the terrain in force.

    Parameters
    ----------
    axes : Axes
    image_labels : sequence of ImageLabel
        A point each, the paler the less sure; without a label a cross in a row of its own.
    in_force, truth : sequences of Stretch
        Drawn as bars; `truth` may be empty.
    tints : Mapping of terrain to colour
    """
    names = [name for name in tints if name != UNKNOWN]
    labels = [image_label.label or NO_LABEL for image_label in image_labels]
    names += [name for name in (UNKNOWN, NO_LABEL) if name in labels]
    for row, name in enumerate(names):
        shown = [s for s, label in zip(image_labels, labels, strict=True) if label == name]
        sure = np.nan_to_num([s.confidence for s in shown], nan=1.0)
        axes.scatter(
            [s.stamp_s for s in shown],
            [row] * len(shown),
            s=26,
            c=np.column_stack([np.zeros((len(shown), 3)), 0.15 + 0.75 * np.clip(sure, 0, 1)]),
            marker="x" if name == NO_LABEL else "o",
            linewidths=1.2 if name == NO_LABEL else 0.0,
            clip_on=False,  # the first image may be that of the left edge
            zorder=3,
            gid=name,
        )
    bars = {"in force": in_force, "truth": truth} if truth else {"in force": in_force}
    for row, stretches in enumerate(bars.values(), start=len(names)):
        whole_s = stretches[-1].end_s - stretches[0].start_s
        for s in stretches:
            axes.barh(row, s.end_s - s.start_s, 0.62, s.start_s, color=tints[s.terrain])
            if s.end_s - s.start_s < _SHORTEST_NAMED * whole_s:
                continue
            axes.text((s.start_s + s.end_s) / 2, row, s.terrain, ha="center", va="center",
                      fontsize=9, parse_math=False, clip_on=True)  # fmt: skip
    rows = [*names, *bars]
    axes.axhline(len(names) - 0.5, color="#BBBBBB", linewidth=0.8)
    axes.set_yticks(range(len(rows)), rows, parse_math=False)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlabel("time [s]")


def plot_confusion(axes: Axes, counts: IntArray, names: Sequence[str], said: Sequence[str]) -> None:
    """Draw a confusion matrix: a column is a true terrain, as in Table 1 of Chen 2023.

    Parameters
    ----------
    axes : Axes
    counts : (len(said), len(names))
        How often each label was given on each true terrain.
    names, said : sequences of str
        True terrains, and labels.
    """
    totals = np.maximum(counts.sum(axis=0, keepdims=True), 1)
    axes.imshow(counts / totals, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    for (row, column), count in np.ndenumerate(counts):
        share = count / totals[0, column]
        axes.text(
            column,
            row,
            f"{100 * share:.0f} %\n{count}",
            ha="center",
            va="center",
            fontsize=9,
            color="white" if share > 0.55 else "black",
        )
    axes.set_xticks(range(len(names)), names, parse_math=False)
    axes.set_yticks(range(len(said)), said, parse_math=False)
    axes.set(xlabel="true terrain", ylabel="label")
    axes.tick_params(length=0)


def draw_outline(axes: Axes, shape: FloatArray, colour: str, name: str | None = None) -> None:
    """Draw a polygon (N, 2) [px] in a colour, with a black edge that shows on any image."""
    for of, width_pt in (("black", 3.6), (colour, 2.2)):
        axes.add_patch(Polygon(shape, fill=False, edgecolor=of, linewidth=width_pt, gid=name))


def _write_inside(axes: Axes, shape: FloatArray, text: str, size_pt: float) -> None:
    u, v = np.mean(shape, axis=0)
    axes.text(
        float(u),
        float(v),
        text,
        ha="center",
        va="center",
        fontsize=size_pt,
        color="white",
        path_effects=_HALO,
        parse_math=False,
        clip_on=True,
    )
