"""Cases of rivals: run folders that leave two hypotheses, and drives that a program proposes.

case = make_rivals("wheels_or_slip", truth=1, seed=3, folder=Path("somewhere"))
case.drive(Proposal("steps", speed_m_s=0.8), Path("elsewhere"))
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from tests.blind.hidden.kind import Hidden, Kind
from tests.blind.hidden.motion import Motion, move
from tests.blind.hidden.recorded import record
from tests.blind.hidden.scene import RUNS, Scene, draw_drive, draw_scene
from tests.blind.hidden.size import size_between, size_of_floor
from tests.blind.rivals.drives import Proposal, drive_of, handful
from tests.blind.rivals.given import Given, draw_given
from tests.blind.rivals.more_pairs import MORE_PAIRS
from tests.blind.rivals.pairs import PAIRS

SIZES_OF_FLOOR = (2.0, 10.0)
MOST_BETWEEN = 0.5
LEAST_APART = 1.0
ATTEMPTS = 60
EVERY_PAIR = {**PAIRS, **MORE_PAIRS}


@dataclass(frozen=True, eq=False)
class DrawnRivals:
    """A robot, the drive that is given, and both hypotheses.

    Attributes
    ----------
    hides : (callable, callable)
        clock to the `Hidden` of each.
    """

    scene: Scene
    given: Given
    hides: tuple[Callable, Callable]


@dataclass(frozen=True, eq=False)
class RivalCase:
    """Rivals on disk, and which of them is the truth.

    Attributes
    ----------
    true, rival : str
        Families of answers.
    calibration, measured, holdout : Path
    drawn : DrawnRivals
    """

    pair: str
    true: str
    rival: str
    calibration: Path
    measured: Path
    holdout: Path
    drawn: DrawnRivals
    truth: int
    rng: np.random.Generator = field(repr=False)

    def drive(self, proposal: Proposal, folder: Path) -> Path:
        """The run folder of a drive that was proposed, with the truth in it."""
        drive = drive_of(self.rng, self.drawn.scene, proposal)
        motion = move(self.drawn.scene, drive, self.drawn.hides[self.truth](drive.clock))
        return record(folder, motion, self.drawn.scene, rng=self.rng, noise=1.0)


def make_rivals(pair: str, truth: int, seed: int, folder: Path) -> RivalCase:
    """Write the folders; a calibration of all sorts, and two runs of the drive that is given."""
    rng = np.random.default_rng([seed, truth, *pair.encode()])
    drawn, motions = draw_rivals(pair, truth, rng)
    calibration = draw_drive(rng, drawn.scene, RUNS[0])
    motions = (move(drawn.scene, calibration, Hidden()), *motions)
    folders = {
        run: record(Path(folder) / run, motion, drawn.scene, rng=rng, noise=1.0)
        for run, motion in zip(RUNS, motions, strict=True)
    }
    names = EVERY_PAIR[pair].names
    return RivalCase(
        pair, names[truth], names[1 - truth], **folders, drawn=drawn, truth=truth, rng=rng
    )


def draw_rivals(pair: str, truth: int, rng) -> tuple[DrawnRivals, list[Motion]]:
    """Rivals, and two motions with the truth, in which it shows and the other is as good."""
    row, seen = EVERY_PAIR[pair], []
    for _ in range(ATTEMPTS):
        scene = _of_unit_factors(draw_scene(rng, Kind(row.match)), row.gyroscope)
        given = draw_given(rng, scene, row.given)
        drawn = DrawnRivals(scene, given, row.match(rng, scene, given))
        drives = [given.drive(rng, scene, rng.uniform(70.0, 110.0)) for _ in range(2)]
        first, second = (move(scene, drives[0], hide(drives[0].clock)) for hide in drawn.hides)
        size, between = size_of_floor(first, scene), size_between(first, second, scene)
        seen.append((round(size, 2), round(between, 2)))
        shows = SIZES_OF_FLOOR[0] <= size <= SIZES_OF_FLOOR[1] and between <= MOST_BETWEEN
        if shows and max(apart(rng, drawn).values()) >= LEAST_APART:
            held_out = move(scene, drives[1], drawn.hides[truth](drives[1].clock))
            return drawn, [(first, second)[truth], held_out]
    raise ValueError(f"{pair}: no rivals of the wanted size in {ATTEMPTS} draws: {seen}")


def apart(rng, drawn: DrawnRivals) -> dict[Proposal, float]:
    """How far apart a handful of drives shows the two, as factors of the noise of a window."""
    result = {}
    for proposal in handful(drawn.scene.base.width):
        drive = drive_of(rng, drawn.scene, proposal)
        first, second = (move(drawn.scene, drive, hide(drive.clock)) for hide in drawn.hides)
        result[proposal] = size_between(first, second, drawn.scene)
    return result


def _of_unit_factors(scene, gyroscope):
    """Without factors of the tread speeds, so that equal speeds drive straight."""
    icrs = {name: replace(one, alpha_left=1.0, alpha_right=1.0) for name, one in scene.icrs.items()}
    sensors = scene.sensors if gyroscope else replace(scene.sensors, gyroscope="")
    return replace(scene, icrs=icrs, sensors=sensors)
