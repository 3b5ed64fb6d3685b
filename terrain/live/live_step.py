"""What is known after one frame of the live main job."""

from dataclasses import dataclass

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from terrain.image_labels.image_label import ImageLabel
from terrain.live.live_feel import FeltAnswer
from terrain.result.contradictions_so_far import Contradiction
from terrain.switch.switch import SwitchEvent


@dataclass(frozen=True)
class LiveStep:
    """What is known after one frame.

    Attributes
    ----------
    estimate : Estimate
        Pose corrected by measured poses, ICRs, covariance, and what the filter noticed.
    odometer : (3,)
        x, y [m], yaw [rad] of the odometer, which no measured pose corrects after the start.
    odometer_covariance : (3, 3)
        Of these. Without poses it is that of `estimate`, too, whose own is then too small.
    twist : (3,)
        v_x, v_y [m/s], omega [rad/s] in the robot frame, of the odometer since the frame before;
        zero at the first.
    terrain : str
        In force; `unknown` where for long no label supported it.
    image_label : ImageLabel or None
        Label of the frame's image; None where it has no image, or there is no model.
    switch : SwitchEvent or None
        The terrain that came into force at this frame.
    felt : FeltAnswer or None
        What the robot feels, where that became known at this frame.
    contradiction : Contradiction or None
        Camera and feel differ for long, or feel knows no such terrain; as far as it lasts.

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
    odometer_covariance: FloatArray
    twist: FloatArray
    terrain: str
    image_label: ImageLabel | None = None
    switch: SwitchEvent | None = None
    felt: FeltAnswer | None = None
    contradiction: Contradiction | None = None
