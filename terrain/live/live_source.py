"""The source of terrain of the live main job: images, feel, both, or one terrain."""

from pathlib import Path

from odometry.errors import ConfigError
from odometry.feel.labels.live import LiveFeel
from odometry.feel.model import FeelModel
from odometry.feel.model_file import read_feel_model
from odometry.recording.run import Robot
from odometry.replays.pipeline import ConstantTerrain, TerrainSource
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.own_statistics import used_as
from terrain.config import Config
from terrain.live.live_feel import LiveFeelLabels, LiveFeelTerrain
from terrain.sources.sources import check_weighed
from terrain.sources.watcher import TerrainWatcher

KEPT = 1  # image label and event that the watcher remembers


def live_feel(
    feel: FeelModel | str | Path, robot: Robot, imu_rad: tuple[float, float, float] | None
) -> LiveFeel:
    """Feel of a robot, by a model or its file."""
    model = feel if isinstance(feel, FeelModel) else read_feel_model(feel)
    return LiveFeel(model, robot, imu_rad=imu_rad)


def live_source(
    robot: Robot,
    initial: str,
    config: Config,
    *,
    camera: Camera | None,
    model: TerrainClassifier | str | Path | None,
    live: LiveFeel | None,
) -> tuple[TerrainSource, LiveFeelTerrain | LiveFeelLabels | None]:
    """The source of terrain, and what windows of feel go to."""
    if model is None:
        named = LiveFeelTerrain(initial)
        return (ConstantTerrain(initial), None) if live is None else (named, named)
    if camera is None:
        raise ConfigError("a model was given and no camera; expected both, or neither")
    if isinstance(model, str | Path):
        model = TerrainClassifier.load(model)
    felt = None
    if live is not None:
        check_weighed(config)
        felt = LiveFeelLabels(live.names, tuple(map(str, model.classes_)))
    watcher = TerrainWatcher(
        robot,
        camera,
        used_as(model, config.classifier),
        initial,
        region=config.region,
        switch=config.switch,
        keep=KEPT,
        felt=felt,
    )
    return watcher, felt
