"""Which effects may be missing, given what was recorded."""

from collections.abc import Sequence

from odometry.effects.catalogue import EFFECTS
from odometry.effects.interface.base import Effect
from odometry.effects.interface.recorded import Recorded, labels_of
from odometry.effects.measurement.reference_fault import FEW_HEADINGS
from odometry.gap.fit.own_moments import observed_s
from odometry.gap.name.in_calibration import in_calibration
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.simulate import reported_of
from odometry.windows.dense.dense import DenseWindows


def offered_effects(scenes: Sequence[DenseWindows], calibration: Calibration) -> tuple[Effect, ...]:
    """Effects of the catalogue that the measured runs could determine, in its order.

    Without those that the calibration runs have as well.
    """
    offered = _of_catalogue(scenes, calibration)
    return tuple(
        e
        for e in offered
        if has_data_for(e, scenes, calibration) and not in_calibration(e, scenes, calibration)
    )


def effects_of_one_heading(
    scenes: Sequence[DenseWindows], calibration: Calibration
) -> tuple[Effect, ...]:
    """Those that the measured runs could determine if the robot had more headings."""
    base = calibration.base
    return tuple(
        e
        for e in _of_catalogue(scenes, calibration)
        if all(e.lacks(scene.inputs, base) == FEW_HEADINGS for scene in scenes)
    )


def _of_catalogue(scenes: Sequence[DenseWindows], calibration: Calibration) -> list[Effect]:
    recorded = Recorded(
        calibration.base,
        tuple(scene.inputs for scene in scenes),
        tuple(observed_s(scene) for scene in scenes),
        frozenset().union(*(labels_of(scene.inputs) for _, scene in calibration.held_back)),
        tuple(reported_of(scene) for scene in scenes),
    )
    return [effect for form in EFFECTS for effect in form.offered(recorded)]


def quick_effects(scenes: Sequence[DenseWindows], calibration: Calibration) -> tuple[Effect, ...]:
    """Those that take little time to compute."""
    return tuple(e for e in offered_effects(scenes, calibration) if not e.slow)


def contact_effects(scenes: Sequence[DenseWindows], calibration: Calibration) -> tuple[Effect, ...]:
    """Those by the balance of contact forces."""
    return tuple(e for e in offered_effects(scenes, calibration) if e.slow)


def of_the_same_robot(candidates: Sequence[Effect], named: Sequence[Effect]) -> tuple[Effect, ...]:
    """Candidates whose constants are those of the named effects of the same physics."""
    return tuple(
        one
        for one in candidates
        if all(
            one.constants() == other.constants()
            for other in named
            if other.physics and other.physics == one.physics
        )
    )


def has_data_for(effect: Effect, scenes: Sequence[DenseWindows], calibration: Calibration) -> bool:
    """Whether a run has the data that the effect needs."""
    return any(not effect.lacks(scene.inputs, calibration.base) for scene in scenes)
