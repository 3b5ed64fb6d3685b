"""A tiny world of two grounds: rays are cast here, with no code of the packages."""

import pickle
from hashlib import sha256
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from matplotlib.figure import Figure

from odometry.report.drawing import figure
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.features import feature_jobs
from terrain.classification.features.features import feature_matrix
from terrain.main_job import run_odometry
from terrain.results import write_results
from tests.terrain.written_runs import ROBOT, drive_curves, twist, write_csv, write_toml

EDGES_M = (1.6, 3.0)  # gravel, then boards from the first edge on, then gravel again
SPEED_M_S = 0.5
CAMERA = {
    "image_size": [160, 120],
    "matrix": [[120.0, 0.0, 80.0], [0.0, 118.0, 58.0], [0.0, 0.0, 1.0]],
    "distortion": [-0.12, 0.03, 0.001, -0.001],
    "mount": [0.2, 0.0, 0.55, 0.01, 0.85, 0.02],
}
METRES_PER_PIXEL = 0.006
PATCH_PX = 32


def rotation(roll, pitch, yaw):
    """R = Rz(yaw) Ry(pitch) Rx(roll), by Rodrigues' formula."""
    about = [[0, 0, yaw], [0, pitch, 0], [roll, 0, 0]]
    rz, ry, rx = (cv2.Rodrigues(np.array(vector, float))[0] for vector in about)
    return rz @ ry @ rx


def without_lens(bent, lens):
    """Undo k1, k2, p1, p2 by fixed-point iteration: x and y before the lens bent them."""
    k1, k2, p1, p2 = lens
    bent_x, bent_y = np.moveaxis(bent, -1, 0)
    x, y = bent_x, bent_y
    for _ in range(60):
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2 * r2
        x, y = (
            (bent_x - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial,
            (bent_y - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial,
        )
    return x, y


def ground_seen(camera, oversampling=1):
    """Robot-frame ground points (H n, W n, 2) seen through each part of each pixel, NaN if none."""
    width, height = camera["image_size"]
    offset = (np.arange(oversampling) + 0.5) / oversampling - 0.5
    u = (np.arange(width)[:, None] + offset).ravel()
    v = (np.arange(height)[:, None] + offset).ravel()
    pixels = np.stack(np.meshgrid(u, v), axis=-1)
    (fx, _, cx), (_, fy, cy), _ = camera["matrix"]
    x, y = without_lens((pixels - [cx, cy]) / [fx, fy], camera["distortion"])
    forward_left_up = np.stack([np.ones_like(x), -x, -y], axis=-1)
    mount = np.array(camera["mount"])
    direction = forward_left_up @ rotation(*mount[3:]).T
    down = np.where(direction[..., 2] < -1e-6, -direction[..., 2], np.nan)
    return mount[:2] + direction[..., :2] * (mount[2] / down)[..., None]


def shrink(image, oversampling):
    """Mean of each block of pixels, as bytes."""
    rows, columns = image.shape[0] // oversampling, image.shape[1] // oversampling
    blocks = image.reshape(rows, oversampling, columns, oversampling, *image.shape[2:])
    return np.rint(blocks.mean(axis=(1, 3))).astype(np.uint8)


def gravel(points, seed):
    """Grey stones of 12 mm, each of its own brightness."""
    stones = np.random.default_rng(seed).integers(30, 226, (512, 512))
    i, j = np.moveaxis(np.floor(np.nan_to_num(points) / 0.012).astype(int), -1, 0)
    return stones[i % 512, j % 512].astype(float)


def boards(points, seed):
    """Bright boards of 60 mm with dark gaps, askew, and a little grain."""
    angle = np.random.default_rng(seed).uniform(0, np.pi)
    across = np.nan_to_num(points) @ [np.cos(angle), np.sin(angle)]
    return np.where(across % 0.06 < 0.035, 190.0, 60.0) + (gravel(points, seed + 1) - 128) / 12


def astride(points):
    """Gravel on the left of y = 0, boards on the right."""
    return np.where(points[..., 1] > 0, gravel(points, 1), boards(points, 2))


def across(points):
    """Gravel, boards, gravel along x."""
    on_boards = (points[..., 0] > EDGES_M[0]) & (points[..., 0] < EDGES_M[1])
    return np.where(on_boards, boards(points, 2), gravel(points, 1))


def drive_straight(folder, world, length_m, every_m=0.12, camera=CAMERA):
    """Run folder of a robot that drives along x at SPEED_M_S, an image every so often."""
    (folder / "images").mkdir(parents=True)
    write_toml(folder / "run.toml", robot=ROBOT, camera=camera)
    end_s = length_m / SPEED_M_S
    stamps_s = np.arange(0.0, end_s + 1e-9, 0.1)
    speeds = np.full(len(stamps_s), SPEED_M_S)
    write_csv(
        folder / "odometry.csv", "t,v_left,v_right", zip(stamps_s, speeds, speeds, strict=True)
    )
    zeros = np.zeros(len(stamps_s))
    poses = np.column_stack([stamps_s, SPEED_M_S * stamps_s, zeros, zeros])
    write_csv(folder / "pose.csv", "t,x,y,yaw", poses)
    seen = ground_seen(camera, 3)
    rows = ["t,file"]
    for k, stamp_s in enumerate(np.arange(0.07, end_s, every_m / SPEED_M_S)):
        grey = np.where(
            np.isnan(seen[..., 0]), 255.0, world(seen + np.array([SPEED_M_S * stamp_s, 0]))
        )
        assert cv2.imwrite(str(folder / f"images/{k:03d}.png"), shrink(grey, 3))
        rows.append(f"{stamp_s:.6f},images/{k:03d}.png")
    (folder / "images.csv").write_text("\n".join(rows) + "\n")
    return folder


@pytest.fixture(autouse=True)
def _undrawn_figures(request, monkeypatch):
    """Figures are made, and written as one grey pixel: drawing them takes a quarter of a command.

    Tests of `report` draw them, and those with the mark `drawn`.
    """
    if request.path.parent.name == "report" or request.node.get_closest_marker("drawn"):
        return
    pixel = Figure(figsize=(0.01, 0.01), dpi=100)
    write = figure._write_png
    monkeypatch.setattr(figure, "_write_png", lambda file, _, source: write(file, pixel, source))


FEATURES = {}


@pytest.fixture(autouse=True)
def _features_once(monkeypatch):
    """Features of the same patches, as a test before computed them: models learn the same ones.

    What a test asks for again is computed, so that it can compare.
    """
    asked = set()

    def features(patches, settings):
        content = sha256(pickle.dumps((list(patches), settings))).digest()
        if content in asked or content not in FEATURES:
            FEATURES[content] = feature_matrix(patches, settings)
        asked.add(content)
        return FEATURES[content].copy()

    monkeypatch.setattr(feature_jobs, "feature_matrix", features)


@pytest.fixture(scope="session")
def world():
    """The functions and numbers above, for tests that cast rays of their own."""
    return SimpleNamespace(
        camera=CAMERA,
        robot=ROBOT,
        speed_m_s=SPEED_M_S,
        edges_m=EDGES_M,
        metres_per_pixel=METRES_PER_PIXEL,
        patch_px=PATCH_PX,
        ground_seen=ground_seen,
        shrink=shrink,
        rotation=rotation,
        twist=twist,
        drive_straight=drive_straight,
        drive_curves=drive_curves,
        across=across,
        write_csv=write_csv,
        write_toml=write_toml,
    )


@pytest.fixture(scope="session")
def across_run(tmp_path_factory):
    """Over gravel, boards and gravel again; read only."""
    return drive_straight(tmp_path_factory.mktemp("runs") / "across", across, 4.6)


@pytest.fixture(scope="session")
def astride_run(tmp_path_factory):
    """Along the edge of gravel, on the left, and boards; read only."""
    return drive_straight(tmp_path_factory.mktemp("runs") / "astride", astride, 1.0)


@pytest.fixture(scope="session")
def training_patches():
    """Images, labels and groups of ground that lies in no run, seen from straight above."""
    size = 2 * PATCH_PX
    side = (np.arange(3 * size) + 0.5) * METRES_PER_PIXEL / 3
    square = np.stack(np.meshgrid(-side, -side, indexing="ij"), axis=-1)
    images, labels, groups = [], [], []
    for label, texture in (("boards", boards), ("gravel", gravel)):
        for photo in range(12):
            view = shrink(texture(square, 1000 + 10 * photo), 3)
            view = cv2.GaussianBlur(view, (0, 0), 0.3 + 0.1 * photo)
            for row in (0, PATCH_PX):
                for column in (0, PATCH_PX):
                    images.append(view[row : row + PATCH_PX, column : column + PATCH_PX])
                    labels.append(label)
                    groups.append(f"{label} {photo}")
    return images, labels, groups


@pytest.fixture(scope="session")
def classifier(training_patches):
    """Small trained classifier of metric patches."""
    return TerrainClassifier(metres_per_pixel=METRES_PER_PIXEL).fit(*training_patches)


@pytest.fixture(scope="session")
def model_file(classifier, tmp_path_factory):
    """The same classifier as a file."""
    file = tmp_path_factory.mktemp("model") / "terrain.model"
    classifier.save(file)
    return file


@pytest.fixture(scope="session")
def across_result(across_run, classifier):
    """The main job over gravel, boards and gravel; not to be changed."""
    return run_odometry(across_run, model=classifier, terrain="gravel")


@pytest.fixture(scope="session")
def curvy_run(tmp_path_factory):
    """A winding drive with poses and without images; read only."""
    return drive_curves(tmp_path_factory.mktemp("runs") / "curvy")


@pytest.fixture(scope="module")
def across_out(across_result, tmp_path_factory):
    out = tmp_path_factory.mktemp("out") / "across"
    write_results(across_result, out)
    return out
