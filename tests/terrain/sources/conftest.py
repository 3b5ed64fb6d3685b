"""A watcher on a run of a few frames."""

from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.region.region import RegionConfig
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.switch import SwitchConfig
from tests.terrain.sources.watched import ByBrightness


def encoded(image, number):
    """PNG of an image whose first pixel is its own: a camera shows no two that are equal."""
    marked = image.copy()
    marked.flat[0] = number
    return cv2.imencode(".png", marked)[1].tobytes()


@pytest.fixture
def watch(tmp_path, world):
    """A watcher over a run whose images, one a second, are given; and its classifier."""

    def make(images, classifier=None, per_tread=False, **settings):
        folder = tmp_path / "run"
        folder.mkdir()
        world.write_toml(folder / "run.toml", robot=world.robot, camera=world.camera)
        stamps_s = np.arange(0.0, len(images) + 1.0, 0.5)
        speeds = np.full(len(stamps_s), world.speed_m_s)
        world.write_csv(
            folder / "odometry.csv", "t,v_left,v_right", zip(stamps_s, speeds, speeds, strict=True)
        )
        rows = ["t,file"]
        for k, image in enumerate(images):
            file = folder / f"{k}.png"
            file.write_bytes(image if isinstance(image, bytes) else encoded(image, k))
            rows.append(f"{k + 0.4},{file.name}")
        (folder / "images.csv").write_text("\n".join(rows) + "\n")
        run = Run.read(folder)
        classifier = classifier or ByBrightness()
        watcher = TerrainWatcher(
            run.robot,
            Camera.from_table(world.camera),
            classifier,
            "mud",
            region=RegionConfig(per_tread=per_tread, **settings),
            switch=SwitchConfig(),
            folder=folder,
        )
        return SimpleNamespace(run=run, watcher=watcher, classifier=classifier, folder=folder)

    return make
