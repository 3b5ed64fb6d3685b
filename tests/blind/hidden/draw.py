"""Cases of hidden effects: drawn until the effect shows at 2 to 10 times the noise."""

from dataclasses import dataclass
from typing import Any

from tests.blind.hidden.kind import Hidden
from tests.blind.hidden.motion import Motion, move
from tests.blind.hidden.scene import RUNS, Scene, draw_drive, draw_scene
from tests.blind.hidden.size import size_of_floor

SIZES_OF_FLOOR = (2.0, 10.0)
HELD_OUT_OF_FLOOR = (1.5, 20.0)
ATTEMPTS = 60


@dataclass(frozen=True, eq=False)
class DrawnHidden:
    """A scene and its three motions."""

    scene: Scene
    motions: dict[str, Motion]

    @property
    def truth(self) -> dict[str, Any]:
        """Base ICRs, by terrain where there are labels, and the parameters of each run."""
        base = {name or "base": icrs.values() for name, icrs in self.scene.icrs.items()}
        hidden = {
            run: motion.hidden.truth for run, motion in self.motions.items() if run != RUNS[0]
        }
        return {**base, **hidden}


def draw_hidden_case(kind, rng):
    """A scene and its motions; what is hidden shows in both runs that have it."""
    sizes = []
    for _ in range(ATTEMPTS):
        scene = draw_scene(rng, kind)
        hide = kind.draw(rng, scene)
        measured = _moved(rng, scene, hide, "measured")
        alone = [size_of_floor(motion, scene) for motion in parts_alone(scene, measured)]
        sizes.append([round(size, 1) for size in alone])
        if kind.true and not all(SIZES_OF_FLOOR[0] <= s <= SIZES_OF_FLOOR[1] for s in alone):
            continue
        holdout = _moved(rng, scene, hide, "holdout")
        held_out = size_of_floor(holdout, scene)
        if not kind.true or HELD_OUT_OF_FLOOR[0] <= held_out <= HELD_OUT_OF_FLOOR[1]:
            break
    else:
        raise ValueError(f"no effect of the wanted size in {ATTEMPTS} draws: {sizes}")
    calibration = move(scene, draw_drive(rng, scene, "calibration"), Hidden())
    return DrawnHidden(scene, dict(zip(RUNS, (calibration, measured, holdout), strict=True)))


def parts_alone(scene, motion):
    """The motion on the same drive with each of the hidden effects by itself."""
    if not motion.hidden.parts:
        return [motion]
    return [move(scene, motion.drive, part) for part in motion.hidden.parts]


def _moved(rng, scene, hide, run):
    drive = draw_drive(rng, scene, run)
    return move(scene, drive, hide(rng, drive.clock))
