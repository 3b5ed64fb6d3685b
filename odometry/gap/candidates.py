"""Which effects may be missing, given what was recorded."""

from collections.abc import Sequence

import numpy as np

from odometry.effects.actuator_lag import ActuatorLag
from odometry.effects.base import Effect
from odometry.effects.curvature import Curvature
from odometry.effects.heading_offset import HeadingOffset
from odometry.effects.inertia_contact import InertiaByContact
from odometry.effects.inertia_icr import InertiaByIndices
from odometry.effects.lateral_skid import LateralSkid
from odometry.effects.lever_arm import LeverArm
from odometry.effects.residual import ANGLES, COMPONENTS, HARMONICS, Residual, variables_of
from odometry.effects.slope_contact import SlopeByContact
from odometry.effects.slope_icr import SlopeByIcr, half_length_m
from odometry.effects.terrain import Terrain, new_labels
from odometry.effects.time_offset import TimeOffset
from odometry.effects.traction_loss import TractionLoss
from odometry.effects.wheel_scale import WheelScale
from odometry.gap.calibration import Calibration
from odometry.windows.dense import DenseWindows

LATERAL_M_S2 = 0.3  # less inertia than this is nothing that contact forces are worth trying for
KNOTS = 5
LEAST_RANGE = 1e-3  # of a variable that says anything


def quick_effects(scenes: Sequence[DenseWindows], calibration: Calibration) -> tuple[Effect, ...]:
    """Effects of the catalogue that the measured runs could tell, but those of contact forces."""
    calibrated = {str(n) for _, s in calibration.held_back for n in np.unique(_labels(s))}
    labels = tuple(sorted({n for s in scenes for n in new_labels(s.inputs, calibrated)}))
    longest_s = max(float(scene.time_s[-1]) for scene in scenes)
    robot = calibration.base.robot
    every: tuple[Effect, ...] = (
        WheelScale(),
        ActuatorLag(),
        LateralSkid(),
        Curvature(),
        TractionLoss(longest_s, _observed_s(scenes)),
        Terrain(labels),
        SlopeByIcr(robot.track_width / 2, half_length_m(robot)),
        InertiaByIndices(robot.mass or 1.0, robot.track_width),
        TimeOffset(),
        LeverArm(),
        HeadingOffset(),
    )
    return tuple(e for e in every if told_by(e, scenes, calibration))


def _observed_s(scenes: Sequence[DenseWindows]) -> tuple[float, float]:
    """Moments before the first of which no window ends, and after the last none begins."""
    ends_s = [scene.pose_s[scene.windows[:, -1]].min() for scene in scenes]
    return float(min(ends_s)), float(max(scene.start_s.max() for scene in scenes))


def contact_effects(scenes: Sequence[DenseWindows], calibration: Calibration) -> tuple[Effect, ...]:
    """Effects by the balance of contact forces, where slope or speed ask for them."""
    found: list[Effect] = []
    half_width = calibration.base.robot.track_width / 2
    slope = SlopeByContact(half_width)
    if told_by(slope, scenes, calibration):
        found.append(slope)
    lateral = max(_lateral_m_s2(scene, calibration) for scene in scenes)
    if lateral > LATERAL_M_S2:
        found.append(InertiaByContact(half_width))
    return tuple(found)


def of_angles(scenes: Sequence[DenseWindows]) -> tuple[Residual, ...]:
    """Smooth functions of an angle that no effect of the catalogue depends on."""
    angles = [a for a in ANGLES if all(a in variables_of(s.inputs) for s in scenes)]
    terms = _every_term(2 * HARMONICS)
    return tuple(Residual(angle, terms, by_speed) for angle in angles for by_speed in (False, True))


def of_variables(scenes: Sequence[DenseWindows]) -> tuple[Residual, ...]:
    """Smooth functions of the other variables recorded: what is left may depend on any."""
    found = []
    for name, values in variables_of(scenes[0].inputs).items():
        knots = np.unique(np.quantile(values, np.linspace(0.02, 0.98, KNOTS)))
        if name not in ANGLES and len(knots) == KNOTS and knots[-1] - knots[0] > LEAST_RANGE:
            places = tuple(float(knot) for knot in knots)
            found.append(Residual(name, _every_term(KNOTS), False, places))
    return tuple(found)


def _every_term(functions: int) -> tuple[tuple[str, int], ...]:
    return tuple((component, k) for component in COMPONENTS for k in range(functions))


def told_by(effect: Effect, scenes: Sequence[DenseWindows], calibration: Calibration) -> bool:
    """Whether a run has the data that the effect needs."""
    return any(not effect.lacks(scene.inputs, calibration.base) for scene in scenes)


def _labels(scene: DenseWindows) -> np.ndarray:
    return np.array([]) if scene.inputs.terrain is None else scene.inputs.terrain.astype(str)


def _lateral_m_s2(scene: DenseWindows, calibration: Calibration) -> float:
    twist = calibration.base.model.twist(calibration.base.values, scene.inputs)
    return float(np.percentile(np.abs(twist[:, 0] * twist[:, 2]), 95))
