"""Lens and mount of random cameras: how far they are from the truth, and what the intervals hold.

    python -m tests.studies.camera.camera_calibration [--cameras 8] [--first-seed 0] [--part PART]

Cameras of 640 x 480 pixels, fields of view of 60 to 95 degrees, distortion of real lenses, 0.3 to
1.6 m above the terrain, pitch 8 to 60 degrees down, roll and yaw of some degrees.
- lens: 14 rendered photographs of a board of 9 x 6 inner corners, tilted by up to 45 degrees.
- points: targets at random on terrain in view, at most 4 m away: 20 of them found to 0.1 px, ten
  marked by hand to 0.5 px, and the same with places measured to 2 mm.
- motion: runs of `synthesise` over two terrains of 4 m each, images at 4 Hz, with poses, gyroscope
  and wheel noise, by the verb's own functions; x and y of the mount as they are, then not given
  (zero), then with images stamped 0.1 s late.
"""

import argparse
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.calibration.chessboard import Chessboard, find_boards, photo_files
from terrain.calibration.lens_from_boards import lens_from_boards
from terrain.calibration.mount_from_points import MarkedPoints, mount_from_points
from terrain.calibration.mount_sources import mount_of_motion
from terrain.camera.camera import Camera
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError
from terrain.main_job import run_odometry
from terrain.synthetic import SynthesisConfig, synthesise
from tests.terrain.calibration.rendered import (
    board_photo,
    board_poses,
    ground_behind,
    marked,
    optical_rays,
)

SIZE = (640, 480)
INNER, SQUARE_M = (9, 6), 0.03
FARTHEST_M = 4.0
LATE_S = 0.1
MARKS = (  # how many, errors in the image [px] and on the terrain [m]
    ("20 targets, 0.1 px", 20, 0.1, 0.0),
    ("10 marks, 0.5 px", 10, 0.5, 0.0),
    ("10 marks, 0.5 px, places to 2 mm", 10, 0.5, 0.002),
)
UNITS = ("x", "y", "z", "roll", "pitch", "yaw")


def main() -> None:
    """Print one row a camera, and what all of them make."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cameras", type=int, default=8)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--part", action="append", choices=list(PARTS))
    arguments = parser.parse_args()
    for part in arguments.part or PARTS:
        print(f"== {part}")
        rows = []
        for seed in range(arguments.first_seed, arguments.first_seed + arguments.cameras):
            rng = np.random.default_rng(seed)
            rows += list(PARTS[part](random_camera(rng), seed, rng))
        summarise(rows)


def random_camera(rng: np.random.Generator) -> dict[str, Any]:
    """A camera as a table of run.toml."""
    focus = SIZE[0] / 2 / np.tan(np.radians(rng.uniform(60, 95)) / 2)
    middle = np.array([319.5, 239.5]) + rng.normal(0, 8, 2)
    matrix = [[focus, 0, middle[0]], [0, focus * rng.uniform(0.995, 1.005), middle[1]], [0, 0, 1]]
    lens = [rng.uniform(-0.28, -0.05), rng.uniform(0.02, 0.08), *rng.normal(0, 4e-4, 2)]
    angles = np.radians([rng.normal(0, 1.5), rng.uniform(8, 60), rng.normal(0, 3)])
    mount = [rng.uniform(0, 0.3), rng.uniform(-0.1, 0.1), rng.uniform(0.3, 1.6), *angles]
    return {"image_size": SIZE, "matrix": matrix, "distortion": lens, "mount": mount}


def lens_row(camera: dict[str, Any], seed: int, rng: np.random.Generator) -> Iterator[Any]:
    """Focal length and centre from photographs [px], and rays over the image."""
    rays = optical_rays(camera)
    with tempfile.TemporaryDirectory() as folder:
        for number, pose in enumerate(board_poses(camera, 14, INNER, SQUARE_M, rng)):
            photo = board_photo(rays, pose, INNER, SQUARE_M, rng)
            cv2.imwrite(f"{folder}/{number:02d}.png", photo)
        board = Chessboard(*INNER, SQUARE_M)
        seen = find_boards(photo_files(Path(folder)), board)
        fit = lens_from_boards(seen, board)
    true = np.array(camera["matrix"])[[0, 1, 0, 1], [0, 1, 2, 2]]
    error = fit.lens.matrix[[0, 1, 0, 1], [0, 1, 2, 2]] - true
    step = 3 * 20  # parts of pixels, of which rays were cast
    x, y = (part[1::step, 1::step].ravel() for part in rays)
    pixels = np.stack(np.meshgrid(np.arange(0, SIZE[0], 20), np.arange(0, SIZE[1], 20)), axis=-1)
    apart = fit.lens.rays(pixels.reshape(-1, 2).astype(float)) - np.column_stack([x, y])
    off = np.degrees(np.hypot(*apart.T))
    print(f"{seed:4d} {len(seen.views):2d} photos, reprojection {fit.rms_px:.3f} px; error of fx, "
          f"fy, cx, cy {np.round(error, 2)} +- {np.round(fit.half_interval, 2)} px; rays off by "
          f"{np.sqrt(np.nanmean(off**2)):.3f} degrees, {np.nanmax(off):.3f} at worst")  # fmt: skip
    yield "chessboard: fx fy cx cy", error, fit.half_interval


def points_row(camera: dict[str, Any], seed: int, rng: np.random.Generator) -> Iterator[Any]:
    """The mount from targets that a program found, and from marks by hand."""
    pixels = rng.uniform([20, 20], [SIZE[0] - 20, SIZE[1] - 20], (4000, 2))
    ground = ground_behind(camera, pixels)
    ground, lens = ground[np.hypot(*ground.T) < FARTHEST_M], lens_of(camera)
    for name, count, noise_px, sigma_m in MARKS:
        rows = marked(camera, ground[:count], noise_px, rng)
        places = rows[:, 2:] + rng.normal(0, sigma_m, (len(rows), 2))
        points = MarkedPoints(rows[:, :2], places, np.arange(len(rows)) + 2)
        yield from report(name, camera, seed, lambda p=points: mount_from_points(lens, p))


def motion_rows(camera: dict[str, Any], seed: int, rng: np.random.Generator) -> Iterator[Any]:  # noqa: ARG001
    """The mount from a synthesised run."""
    made = Camera.from_mount(SIZE, camera["matrix"], camera["distortion"], camera["mount"])
    lens = lens_of(camera)
    place = np.array(camera["mount"]) * [1, 1, 0, 0, 0, 0]
    with tempfile.TemporaryDirectory() as folder:
        config = SynthesisConfig(seed=seed, zones=("gravel", "grass"), zone_length_m=4.0,
                                 camera=made, patches_per_terrain=1)  # fmt: skip
        run = Run.read(synthesise(Path(folder) / "run", config))
        for name, used, known in (
            ("motion, x and y given", run, place),
            ("motion, x and y not given", run, None),
            ("motion, images late by 0.1 s", late(run), place),
        ):
            result = run_odometry(used, vision=False)
            odometer = result.replay.odometer()
            yield from report(
                name,
                camera,
                seed,
                lambda u=result.run, o=odometer, k=known: mount_of_motion(u, o, lens, k).fit,
            )


def late(run: Run) -> Run:
    """The same run with images stamped late."""
    images = run.images
    assert images is not None
    columns = dict(images.columns) | {"t": images.columns["t"] + LATE_S}
    return replace(run, images=Table(images.file, columns, images.lines))


def lens_of(camera: dict[str, Any]) -> Lens:
    """The true lens."""
    return Lens.of(SIZE, camera["matrix"], camera["distortion"])


def report(name: str, camera: dict[str, Any], seed: int, fit: Callable[[], Any]) -> Iterator[Any]:
    """Print and give errors and half intervals, in metres and degrees."""
    try:
        found = fit()
    except CalibrationError as error:
        print(f"{seed:4d} {name}: {error}")
        yield name, None, None
        return
    scale = np.array([1, 1, 1, *[np.degrees(1)] * 3])
    error, half = (found.mount - camera["mount"]) * scale, found.half_interval * scale
    pitch = np.degrees(camera["mount"][4])
    print(f"{seed:4d} {name}: z {camera['mount'][2]:.2f} m, pitch {pitch:.0f}: error "
          f"{np.round(error, 3)} +- {np.round(half, 3)}; {found.rms_px:.2f} px")  # fmt: skip
    yield name, error, half


def summarise(rows: list[Any]) -> None:
    """Median and worst error, and the share of intervals that hold the truth."""
    for name in dict.fromkeys(row[0] for row in rows):
        told = [(error, half) for one, error, half in rows if one == name and error is not None]
        refused = sum(one == name and error is None for one, error, _ in rows)
        print(f"-- {name}: {len(told)} calibrated, {refused} refused")
        if not told:
            continue
        errors, halves = (np.abs(np.array(part)) for part in zip(*told, strict=True))
        columns = UNITS if errors.shape[1] == len(UNITS) else ("fx", "fy", "cx", "cy")
        for place, column in enumerate(columns):
            fitted = np.isfinite(halves[:, place])
            if not fitted.any():
                continue
            held = (errors[fitted, place] <= halves[fitted, place]).mean()
            part = errors[:, place]
            print(f"   {column:5s} median {np.median(part):.4f} worst {part.max():.4f}, in the "
                  f"interval {held:.2f} of {fitted.sum()}")  # fmt: skip


PARTS: dict[str, Callable[..., Iterator[Any]]] = {
    "lens": lens_row,
    "points": points_row,
    "motion": motion_rows,
}

if __name__ == "__main__":
    main()
