"""The main job frame by frame, as on a robot."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from odometry.errors import ConfigError, EstimationError
from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.running_odometer import RunningOdometer
from odometry.feel.labels.live import NOTHING
from odometry.feel.model import FeelModel
from odometry.parameters import ParameterSet, read_parameters
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Robot
from odometry.replays.pipeline import TerrainSource, can_start, started, stepped
from odometry.set_of_robot import set_notes
from odometry.windows.recorded.gaps import GapsSoFar
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.likeness.likeness import Likeness
from terrain.config import Config
from terrain.live.checked_so_far import CheckedSoFar
from terrain.live.images_so_far import ImagesSoFar
from terrain.live.live_feel import LiveFelt
from terrain.live.live_source import live_feel, live_source
from terrain.live.live_step import LiveStep
from terrain.live.noticed_so_far import NoticedSoFar
from terrain.sources.sources import initial_terrain
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.place_labels import Footprint
from terrain.terrain_names import name_notes

if TYPE_CHECKING:
    from odometry.estimation.estimate import Estimate


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
        In force until the first switch; by default "unknown", or the only one of `parameters`
        where neither images nor feel will name one.
    config : Config, optional
        `[filter] causal` counts as set.
    source : TerrainSource, optional
        Gives the terrain instead of the images.
    feel : FeelModel or path, optional
        The terrain by feel, as the source, or beside the images; `imu` and `currents` take the
        rows that it needs.
    imu_rad : (roll, pitch, yaw), optional
        Of the axes of the IMU in the robot frame, `[sensors] imu`.
    lever_m : (x, y)
        Place in the robot frame of the point whose position is measured, `[sensors] pose`.
    at_pose : bool
        Whether to wait for the first measured position, and to start there; else the start is
        the origin.

    Raises
    ------
    OdometryError
        If an input does not have its documented format, a model has no camera, or feel is of
        another robot.

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
    >>> print(step.odometer_covariance.diagonal().round(4))  # of these, m^2 and rad^2
    [0.01   0.0098 0.0077]
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
        feel: FeelModel | str | Path | None = None,
        imu_rad: tuple[float, float, float] | None = None,
        lever_m: tuple[float, float] = (0.0, 0.0),
        at_pose: bool = False,
    ) -> None:
        config = config or Config()
        if not isinstance(parameters, ParameterSet):
            parameters = read_parameters(parameters) if parameters else ParameterSet()
        initial = initial_terrain(terrain, parameters)
        if feel is not None and source is not None:
            raise ConfigError("feel was given and a source of your own; expected one of them")
        live = None if feel is None else live_feel(feel, robot, imu_rad)
        if terrain is None and (live is not None or model is not None):
            initial = UNKNOWN  # a wrong start would mislead the gyroscope's bias
        self._felt: LiveFelt | None = None
        if source is None:
            source, felt = live_source(
                robot, initial, config, camera=camera, model=model, live=live
            )
            if live is not None and felt is not None:
                radius_m = Footprint.of(robot, config.region.footprint_scale).radius_m
                self._felt = LiveFelt(live, felt, radius_m)
        self._source = source
        self._watcher = source if isinstance(source, TerrainWatcher) else None
        self._ekf = IcrEkf(robot.track_width, parameters, config.filter, lever_m=lever_m)
        self._at_pose = at_pose
        classifier = None if self._watcher is None else self._watcher.classifier
        self._set_notes = [
            *set_notes(parameters, robot),
            *name_notes(initial, classifier, parameters),
        ]
        self._gaps = GapsSoFar()
        self._noticed = NoticedSoFar(robot.track_width, parameters.terrains)
        self._checked = CheckedSoFar(robot, lever_m)
        self._lost_s, self._lost_until_s = 0.0, 0.0
        wanted = None if self._watcher is None or camera is None else camera.image_size
        self._images = ImagesSoFar(wanted)
        self._estimate: Estimate | None = None
        self._odometer: RunningOdometer | None = None

    def imu(
        self,
        stamp_s: float,
        *,
        gyro: Sequence[float] = NOTHING,
        accel: Sequence[float] = NOTHING,
    ) -> None:
        """Take in a row of the IMU for feel; see `odometry.LiveFeel.imu`.

        Rows up to the stamp of a frame come before it; without feel they are left out.
        """
        if self._felt is not None:
            self._felt.live.imu(stamp_s, gyro=gyro, accel=accel)

    def currents(self, stamp_s: float, left_a: float, right_a: float) -> None:
        """Take in motor currents [A] for feel, held until the next."""
        if self._felt is not None:
            self._felt.live.currents(stamp_s, left_a, right_a)

    @property
    def feel_note(self) -> str:
        """Why there are no answers by feel, such as accelerations in g; "" where all is well."""
        return "" if self._felt is None else self._felt.live.note

    @property
    def notes(self) -> tuple[str, ...]:
        """What to know before the answers are used; some can be said after several images only.

        Terrains that the parameter set lacks, images unlike the training photographs, of another
        size than the camera's, grey before a model in colour or all without a name, `feel_note`,
        a drive without images, time without tread speeds, what the filter noticed that misleads it,
        the latest of each kind, and what the check of recordings says of the latest two minutes,
        once there are 60, 120, 240 s ... of frames: such a call takes some tenths of a second.
        """
        likeness = None if self.likeness is None else self.likeness.note
        lost = (
            f"no tread speeds came for {self._lost_s:.1f} s in all while a tread turned, the last "
            f"time until {self._lost_until_s:.2f} s: messages were lost, or the clock was set. "
            "Where the robot went meanwhile is not known, and the odometer is off by it"
        )
        said = likeness, *self._images.notes(), self.feel_note, lost if self._lost_s else ""
        noticed = self._noticed.notes(self._estimate) if self._estimate else ()
        checked = self._checked.notes()
        return tuple(filter(None, (*self._set_notes, *said, *noticed, *checked)))

    def step(self, frame: Frame) -> LiveStep | None:
        """Take in the next frame; None as long as nothing can start.

        Raises
        ------
        EstimationError
            If the frame is older than the one before, or holds an infinite number; nothing is
            changed then.
        """
        if self._estimate is not None and not frame.stamp_s >= self._estimate.stamp_s:
            raise EstimationError(
                f"a frame of {frame.stamp_s} s came after that of {self._estimate.stamp_s} s; "
                "expected frames in order of time, as LiveFrames gives them"
            )
        _check_finite(frame)
        if self._felt is not None:
            self._felt.before(frame)
        if self._estimate is None and not can_start(frame, at_pose=self._at_pose):
            return None
        frame = self._gaps.marked(frame)
        if self._estimate is None or self._odometer is None:
            self._estimate = started(self._ekf, self._source, frame)
            self._odometer = RunningOdometer(self._estimate)
        else:
            if frame.in_gap or np.isnan(self._estimate.tread_speeds_m_s).any():
                self._lost_s += frame.stamp_s - self._estimate.stamp_s
                self._lost_until_s = frame.stamp_s
            self._estimate = stepped(self._ekf, self._source, self._estimate, frame)
            self._odometer.step(self._estimate)
        self._noticed.add(self._estimate)
        self._checked.add(frame)
        self._images.drive(frame)
        odometer = (self._odometer.pose, self._odometer.covariance, self._odometer.twist)
        terrain, seen, event = self._estimate.terrain, None, None
        if self._watcher is not None:
            seen = self._watcher.image_labels[-1] if frame.image is not None else None
            if seen is not None:
                self._images.add(seen)
            event = self._watcher.event
        if self._felt is None:
            return LiveStep(self._estimate, *odometer, terrain, seen, event)
        felt = self._felt.after(self._estimate.stamp_s, self._odometer.pose, seen)
        return LiveStep(self._estimate, *odometer, terrain, seen, event, *felt)

    @property
    def likeness(self) -> Likeness | None:
        """Whether the latest images are similar to the model's training photographs.

        None where images are not used, or the model holds no comparison; `Likeness.note` has words.
        """
        return None if self._watcher is None else self._watcher.seen.likeness


def _check_finite(frame: Frame) -> None:
    """Raise EstimationError where a frame holds an infinite number."""
    for name in ("tread_speeds_m_s", "yaw_rate_rad_s", "pose", "velocity"):
        value = getattr(frame, name)
        if value is not None and np.isinf(value).any():
            raise EstimationError(
                f"the frame of {frame.stamp_s} s has {name} = {value}; expected numbers, or NaN "
                "for what was not measured"
            )
