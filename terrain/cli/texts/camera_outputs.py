"""The files of `camera`: the table [camera], and pictures."""

from pathlib import Path
from typing import TYPE_CHECKING

import tomli_w

from odometry.arrays import FloatArray
from odometry.io.files import atomic_write
from odometry.outputs.provenance import Made
from odometry.recording.run import Run
from terrain.calibration.camera_table import camera_text
from terrain.calibration.lens_sources import first_image
from terrain.calibration.look_ahead import run_region
from terrain.camera.distortion import distort
from terrain.checks.drawn_images import shown_images
from terrain.region.region import NoRegion, Region
from terrain.report.ground_plots import (
    write_board_figure,
    write_flow_figure,
    write_ground_figures,
    write_points_figure,
)

if TYPE_CHECKING:
    from terrain.calibration.lens_sources import LensSource
    from terrain.calibration.mount_sources import MountSource
    from terrain.classification.classifier import TerrainClassifier

PICTURES = 4


def write_tables(
    out: Path, run: Run, lens: "LensSource", mount: "MountSource | None", made: Made
) -> list[Path]:
    """camera.toml, and the [camera] that the run has now, so that it can be put back."""
    table = lens.lens.to_table() if mount is None else mount.camera.to_table()
    files = [out / "camera.toml"]
    with atomic_write(files[0]) as part:
        part.write_text(made.to_comment() + camera_text(table), encoding="utf-8")
    before = run.settings.get("camera")
    if isinstance(before, dict):
        files.append(out / "camera_before.toml")
        with atomic_write(files[1]) as part:
            part.write_text(tomli_w.dumps({"camera": before}), encoding="utf-8")
    return files


def draw(
    out: Path,
    run: Run,
    lens: "LensSource",
    mount: "MountSource | None",
    classifier: "TerrainClassifier | None",
) -> list[Path]:
    """All pictures that there is something for."""
    folder, files = out / "figures", []
    if lens.boards is not None:
        files.append(write_board_figure(folder / "chessboard.png", *lens.boards))
    if mount is None:
        return files
    camera = mount.camera

    def region_at(twist: FloatArray, wheel_speed_m_s: float) -> Region | NoRegion:
        return run_region(camera, run.robot, classifier, (twist, wheel_speed_m_s))

    shown = shown_images(run, camera, PICTURES, region_at)
    files = [*write_ground_figures(folder, run.robot, shown), *files]
    image = first_image(run)
    if image is not None and mount.points is not None:
        files.append(write_points_figure(folder / "points.png", image, camera, mount.points))
    if shown and mount.fit is not None and mount.tracks is not None:
        rays, middle = mount.tracks.before, camera.matrix[:2, 2]
        pixels = distort(rays, camera.distortion) * camera.matrix[[0, 1], [0, 1]] + middle
        image = shown[len(shown) // 2].image
        files.append(
            write_flow_figure(folder / "flow.png", image, camera, pixels, mount.fit.agrees)
        )
    return files
