"""The main job frame by frame, as on a robot."""

from dataclasses import dataclass
from pathlib import Path

from odometry.arrays import FloatArray
from odometry.errors import ConfigError, EstimationError
from odometry.estimation.estimate import Estimate
from odometry.estimation.icr_ekf import IcrEkf
from odometry.frames import Frame
from odometry.live_frames import RunningOdometer
from odometry.parameters import ParameterSet, read_parameters
from odometry.pipeline import ConstantTerrain, TerrainSource, can_start, started, stepped
from odometry.run import Robot
from odometry.windows.gaps import GapsSoFar
from terrain.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness import Likeness
from terrain.classification.own_statistics import used_as
from terrain.config import Config
from terrain.image_label import ImageLabel
from terrain.sources import initial_terrain
from terrain.switch import SwitchEvent
from terrain.watcher import TerrainWatcher

KEPT = 1  # image label and event that the watcher remembers


@dataclass(frozen=True)
class LiveStep:
    """What is known after one frame.

    Attributes
    ----------
    estimate : Estimate
        Pose corrected by measured poses, ICRs, covariance, and what the filter noticed.
    odometer : (3,)
        x, y [m], yaw [rad] of the odometer, which no measured pose corrects after the start.
    terrain : str
        In force; `unknown` where for long no label supported it.
    image_label : ImageLabel or None
        Label of the frame's image; None where it has no image, or there is no model.
    switch : SwitchEvent or None
        The terrain that came into force at this frame.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> import terrain
    >>> live = terrain.LiveOdometry(odometry.Robot(track_width=0.4), terrain="grass")
    >>> step = live.step(odometry.Frame(0.0, np.array([0.5, 0.5]), 0, None, None))
    >>> step.terrain, step.switch is None
    ('grass', True)
    """

    estimate: Estimate
    odometer: FloatArray
    terrain: str
    image_label: ImageLabel | None = None
    switch: SwitchEvent | None = None

    @property
    def sighting(self) -> ImageLabel | None:
        """`image_label` under its old name, for one version."""
        return self.image_label


class LiveOdometry:
    """Terrain-aware odometry of frames that come one by one: `run_odometry` as on a robot.

    Parameters
    ----------
    robot : Robot
    camera : Camera, optional
    model : TerrainClassifier or path, optional
        With one, images are read, which needs a camera.
    parameters : ParameterSet or path, optional
        Without effects: those are known along a whole run only.
    terrain : str, optional
        In force until the first switch; by default the first of `parameters`.
    config : Config, optional
        `[filter] causal` counts as set.
    source : TerrainSource, optional
        Gives the terrain instead of the images.
    lever_m : (x, y)
        Place in the robot frame of the point whose position is measured, `[sensors] pose`.
    at_pose : bool
        Whether to wait for the first measured position, and to start there; else the start is
        the origin.

    Raises
    ------
    OdometryError
        If an input does not have its documented format, or a model has no camera.

    Notes
    -----
    The frames of a run (`Run.frames`) give the estimates of `run_odometry` with
    `[filter] causal = true` to the last bit; `odometry.LiveFrames` makes frames of messages.
    Memory does not grow with the number of frames.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> import terrain
    >>> live = terrain.LiveOdometry(odometry.Robot(track_width=0.4))
    >>> for i, stamp_s in enumerate([0.0, 0.1, 0.2]):
    ...     step = live.step(odometry.Frame(stamp_s, np.array([0.5, 0.5]), i, None, None))
    >>> print(step.odometer.round(3))  # x, y [m], yaw [rad]
    [0.1 0.  0. ]
    """

    def __init__(
        self,
        robot: Robot,
        *,
        camera: Camera | None = None,
        model: TerrainClassifier | str | Path | None = None,
        parameters: ParameterSet | str | Path | None = None,
        terrain: str | None = None,
        config: Config | None = None,
        source: TerrainSource | None = None,
        lever_m: tuple[float, float] = (0.0, 0.0),
        at_pose: bool = False,
    ) -> None:
        config = config or Config()
        if not isinstance(parameters, ParameterSet):
            parameters = read_parameters(parameters) if parameters else ParameterSet()
        initial = initial_terrain(terrain, parameters)
        if source is None:
            source = _source(robot, camera, model, initial, config)
        self._source = source
        self._watcher = source if isinstance(source, TerrainWatcher) else None
        self._ekf = IcrEkf(robot.track_width, parameters, config.filter, lever_m=lever_m)
        self._at_pose = at_pose
        self._gaps = GapsSoFar()
        self._estimate: Estimate | None = None
        self._odometer: RunningOdometer | None = None

    def step(self, frame: Frame) -> LiveStep | None:
        """Take in the next frame; None as long as nothing can start.

        Raises
        ------
        EstimationError
            If the frame is older than the one before; nothing is changed then.
        CameraError
            If the first image to be classified is not of the camera's size.
        """
        if self._estimate is None:
            if not can_start(frame, at_pose=self._at_pose):
                return None
        elif not frame.stamp_s >= self._estimate.stamp_s:
            raise EstimationError(
                f"a frame of {frame.stamp_s} s came after that of {self._estimate.stamp_s} s; "
                "expected frames in order of time, as LiveFrames gives them"
            )
        frame = self._gaps.told(frame)
        if self._estimate is None or self._odometer is None:
            self._estimate = started(self._ekf, self._source, frame)
            self._odometer = RunningOdometer(self._estimate)
            pose = self._odometer.pose
        else:
            self._estimate = stepped(self._ekf, self._source, self._estimate, frame)
            pose = self._odometer.step(self._estimate)
        if self._watcher is None:
            return LiveStep(self._estimate, pose, self._estimate.terrain)
        seen = self._watcher.image_labels[-1] if frame.image is not None else None
        return LiveStep(self._estimate, pose, self._estimate.terrain, seen, self._watcher.event)

    @property
    def likeness(self) -> Likeness | None:
        """Whether the latest images are similar to the model's training photographs.

        None where images are not used, or the model holds no comparison; `Likeness.note` has words.
        """
        return None if self._watcher is None else self._watcher.seen.likeness


def _source(
    robot: Robot,
    camera: Camera | None,
    model: TerrainClassifier | str | Path | None,
    initial: str,
    config: Config,
) -> TerrainSource:
    if model is None:
        return ConstantTerrain(initial)
    if camera is None:
        raise ConfigError("a model was given and no camera; expected both, or neither")
    if isinstance(model, str | Path):
        model = TerrainClassifier.load(model)
    return TerrainWatcher(
        robot,
        camera,
        used_as(model, config.classifier),
        initial,
        region=config.region,
        switch=config.switch,
        keep=KEPT,
    )
