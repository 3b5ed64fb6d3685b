"""A drive of wide curves with images of a random texture, and faulty copies of it."""

import shutil

import cv2
import numpy as np
import pytest

import odometry
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks import fixed_parts
from terrain.checks.recording import check_run
from terrain.checks.terrain_views import TerrainViews

COUNT = 24


@pytest.fixture(scope="session")
def drive():
    """The shipped drive with images; read only."""
    return Run.read(odometry.shipped_data() / "runs" / "demo")


@pytest.fixture(scope="session")
def camera(drive):
    """The camera of `drive`."""
    return Camera.from_table(drive.settings["camera"])


@pytest.fixture(scope="session", autouse=True)
def looked_at_once(drive):
    """The images of `drive` are looked at once, whatever run and camera they are given.

    What stays in the same images is looked for once on the same terrain.
    """
    look, views, read, images = TerrainViews._seen, {}, TerrainViews.grey, {}
    find, found = fixed_parts._fixed, {}

    def seen(self, name):
        if self.run.folder != drive.folder:
            return look(self, name)
        return look(views.setdefault(self.size, TerrainViews(drive, self.size)), name)

    def grey(self, name):
        if self.run.folder != drive.folder:
            return read(self, name)
        if (self.size, name) not in images:
            images[self.size, name] = read(self, name)
        return images[self.size, name]

    def fixed(grey, details, near):
        content = tuple((of.shape, of.tobytes()) for of in (grey, near))
        if content not in found:
            found[content] = find(grey, details, near)
        return found[content]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TerrainViews, "_seen", seen)
        patch.setattr(TerrainViews, "grey", grey)
        patch.setattr(fixed_parts, "_fixed", fixed)
        yield


@pytest.fixture(scope="session")
def clean_run(world, tmp_path_factory):
    """12 s at 20 Hz with poses at 5 Hz, an image every half second; read only."""
    folder = tmp_path_factory.mktemp("runs") / "clean"
    (folder / "images").mkdir(parents=True)
    stamps_s = np.arange(0.0, 12.001, 0.05)
    left, right = 0.5 + 0.07 * np.sin(1.3 * stamps_s), 0.5 + 0.07 * np.cos(0.9 * stamps_s)
    poses = [np.array([1.0, 2.0, 0.5])]
    for speeds in zip(left[:-1], right[:-1], strict=True):
        v_x, v_y, omega = 0.05 * np.array(world.twist(*speeds, 0.26, -0.24, 0.03))
        x, y, yaw = poses[-1]
        c, s = np.cos(yaw + omega / 2), np.sin(yaw + omega / 2)
        poses.append(np.array([x + c * v_x - s * v_y, y + s * v_x + c * v_y, yaw + omega]))
    measured = np.array(poses) + np.random.default_rng(6).normal(0, 0.002, (len(poses), 3))
    rows = np.column_stack([stamps_s, measured])[::4]
    world.write_csv(folder / "pose.csv", "t,x,y,yaw", rows)
    treads = zip(stamps_s, left, right, strict=True)
    world.write_csv(folder / "odometry.csv", "t,v_left,v_right", treads)
    world.write_toml(folder / "run.toml", robot=world.robot, camera=world.camera)
    rng, rows = np.random.default_rng(5), ["t,file"]
    width, height = world.camera["image_size"]
    for k in range(COUNT):
        image = np.clip(rng.normal(120, 30, (height, width, 3)), 0, 255).astype(np.uint8)
        assert cv2.imwrite(str(folder / f"images/{k:02d}.jpg"), image)
        rows.append(f"{0.5 * k:.3f},images/{k:02d}.jpg")
    (folder / "images.csv").write_text("\n".join(rows) + "\n")
    return folder


@pytest.fixture
def faulty(clean_run, world, tmp_path):
    """A copy of the clean run that a test may spoil, with ways to do so."""
    folder = tmp_path / "faulty"
    shutil.copytree(clean_run, folder)
    return Faulty(folder, world)


class Faulty:
    """A run folder to be spoilt."""

    def __init__(self, folder, world):
        self.folder = folder
        self.camera = dict(world.camera)
        self.robot = dict(world.robot)
        self._world = world

    def settings(self, camera=None, robot=None):
        """Change keys of [camera] and [robot]; a key of None is left out."""
        self.camera |= camera or {}
        self.robot |= robot or {}
        table = {key: value for key, value in self.camera.items() if value is not None}
        self._world.write_toml(self.folder / "run.toml", robot=self.robot, camera=table)

    @property
    def files(self):
        return sorted((self.folder / "images").iterdir())

    def images(self, change, suffix=".jpg"):
        """Change the pixels of all images; the names stay, whatever the format."""
        for file in self.files:
            encoded = cv2.imencode(suffix, change(cv2.imread(str(file))))[1]
            file.write_bytes(encoded.tobytes())

    def found(self, model=None):
        """Findings by name, those of the clean run (there are none) left out."""
        return {finding.name: finding for finding in check_run(self.folder, model).findings}
