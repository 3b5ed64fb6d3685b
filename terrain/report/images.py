"""The figures of a report about the camera: labels along time, regions, whole images."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from odometry.report.drawing.figure import save_figure, show_run_time
from odometry.report.drawing.html import Picture
from terrain.camera.camera import Camera
from terrain.classification.answer import Classifier
from terrain.image_labels.image_label import ImageLabel
from terrain.images import read_image
from terrain.region.whole_image import classify_ground
from terrain.report.figures import Tints, in_force
from terrain.report.labels_and_truth import Confusion, around_switches
from terrain.report.plots import draw_cells, draw_region, plot_confusion, plot_image, plot_labels
from terrain.result.run_result import RunResult
from terrain.result.switch_delay import true_stretches
from terrain.sources.watcher import TerrainWatcher

_WIDTH_IN = 7.0
_PHOTO_DPI = 120
_IMAGES_APART = 4  # at least, as in Fig. 6 of Chen 2023: pictures 193, 197, 201


def labels_picture(
    result: RunResult, watcher: TerrainWatcher, tints: Tints, folder: Path
) -> Picture:
    """Labels and the terrain in force along time."""
    truth = true_stretches(result)

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.13, 0.17, 0.84, 0.8))
        plot_labels(axes, watcher.image_labels, in_force(result), truth, tints)
        show_run_time(axes, result.run.began_s)

    labelled = sum(bool(image_label.label) for image_label in watcher.image_labels)
    return Picture(
        save_figure(folder / "labels.png", (_WIDTH_IN, 1.6 + 0.3 * len(tints)), draw),
        "What each image was taken for, over time, above the terrain in force.",
        f"What each of {len(watcher.image_labels)} images was taken for ({labelled} had a label); "
        "the paler, the less sure. A label is of the terrain ahead and comes into force on "
        "arrival.",
    )


def confusion_picture(found: Confusion, folder: Path) -> Picture:
    """Labels against the true terrain of their places."""

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((0.3, 0.2, 0.62, 0.75))
        plot_confusion(axes, found.counts, found.names, found.said)

    right = sum(
        int(found.counts[row, found.names.index(name)])
        for row, name in enumerate(found.said)
        if name in found.names
    )
    total = int(found.counts.sum())
    size_in = (1.6 + 1.1 * len(found.names), 1.0 + 0.6 * len(found.said))
    return Picture(
        save_figure(folder / "confusion.png", size_in, draw),
        f"Confusion matrix: {right} of {total} labels are right.",
        f"{right} of {total} labels name the terrain under the robot when it gets to the middle of "
        "the region. A column is a true terrain.",
    )


def regions_picture(
    result: RunResult, watcher: TerrainWatcher, tints: Tints, folder: Path
) -> Picture | None:
    """The classified region on images around the switches; None if no image has a label."""
    chosen = around_switches(watcher.image_labels, watcher.events)
    if not chosen:
        return None
    camera = camera_of(result)
    rows = -(-len(chosen) // 2)

    def draw(figure: Figure) -> None:
        for axes, image_label in zip(figure.subplots(rows, 2).flat, chosen, strict=False):
            _draw_image_label(axes, result, camera, image_label, tints)
        for axes in figure.axes[len(chosen) :]:
            axes.remove()
        figure.subplots_adjust(0.01, 0.01, 0.99, 1 - 0.1 / rows, wspace=0.03, hspace=0.13)

    return Picture(
        save_figure(folder / "regions.png", _grid_size(camera, rows), draw, _PHOTO_DPI),
        f"{len(chosen)} images with the classified region outlined: "
        + ", ".join(f"{s.label} at {s.stamp_s - result.run.began_s:.1f} s" for s in chosen)
        + ".",
        "The region that the robot will stand on, with its label and confidence, "
        + ("around the switches." if watcher.events else "over the run."),
    )


def whole_image_picture(
    result: RunResult,
    watcher: TerrainWatcher,
    classifier: Classifier,
    tints: Tints,
    folder: Path,
) -> Picture | None:
    """Images around the first switch, all visible terrain classified beside the region alone."""
    chosen = _about_first_switch(watcher)
    if not chosen or classifier.metres_per_pixel is None:
        return None
    camera = camera_of(result)
    rows = len(chosen)

    def draw(figure: Figure) -> None:
        for (left, right), image_label in zip(
            figure.subplots(rows, 2, squeeze=False), chosen, strict=True
        ):
            image = read_image(result.run.folder / image_label.image)
            at_s = image_label.stamp_s - result.run.began_s
            plot_image(left, image, f"{at_s:.2f} s: all visible terrain")
            draw_cells(left, camera, classify_ground(image, camera, classifier), tints)
            _draw_image_label(right, result, camera, image_label, tints)
        figure.subplots_adjust(0.01, 0.01, 0.99, 1 - 0.1 / rows, wspace=0.03, hspace=0.13)

    size_in = _grid_size(camera, rows)
    return Picture(
        save_figure(folder / "whole_image.png", size_in, draw, _PHOTO_DPI),
        "Images with all visible terrain cut into classified cells, beside the predicted region.",
        "Left: all the terrain that the image resolves finely enough, cut into cells of the size "
        "of a training patch. Right: only the region where the robot will be.",
    )


def camera_of(result: RunResult) -> Camera:
    """The camera of the run."""
    return Camera.from_table(result.run.settings["camera"], str(result.run.folder / "run.toml"))


def _draw_image_label(
    axes: Axes, result: RunResult, camera: Camera, image_label: ImageLabel, tints: Tints
) -> None:
    ahead = f"{image_label.region.distance_ahead_m:.1f} m ahead" if image_label.region else ""
    at_s = image_label.stamp_s - result.run.began_s
    title = f"{at_s:.2f} s: {image_label.reason or ahead}"
    plot_image(axes, read_image(result.run.folder / image_label.image), title)
    draw_region(axes, camera, image_label, tints)


def _about_first_switch(watcher: TerrainWatcher) -> list[ImageLabel]:
    """The first first label of the first change and a labelled image on either side of it.

    Without a change, the middle labelled image of the run.
    """
    labelled = [
        place for place, image_label in enumerate(watcher.image_labels) if image_label.label
    ]
    if not watcher.events:
        places = labelled[len(labelled) // 2 :][:1]
    else:
        seen_s = watcher.events[0].first_label.stamp_s
        first = [image_label.stamp_s for image_label in watcher.image_labels].index(seen_s)
        before = [place for place in labelled if place <= first - _IMAGES_APART]
        after = [place for place in labelled if place >= first + _IMAGES_APART]
        places = [*before[-1:], first, *after[:1]]
    return [watcher.image_labels[place] for place in places]


def _grid_size(camera: Camera, rows: int) -> tuple[float, float]:
    width, height = camera.image_size
    return _WIDTH_IN, rows * (_WIDTH_IN / 2 * height / width + 0.32)
