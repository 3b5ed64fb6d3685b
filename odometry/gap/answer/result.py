"""What the gap workflow found."""

from dataclasses import dataclass

from odometry.arrays import FloatArray
from odometry.checks.findings.warned import RunFinding
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer.next_drives import NextDrive
from odometry.gap.locate.locate import Location
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.statistic import Gap
from odometry.windows.dense.dense import DenseWindows


@dataclass(frozen=True)
class NamedEffect:
    """An effect in the order added.

    Attributes
    ----------
    added : Added
        With the values of the last fit, of all effects together.
    low, high : (P,)
        95 % intervals.
    gap_before, gap_after : float
        On the measured runs, without and with it (and those before it) [m].
    evidence : float
        Twice the log-likelihood gained on windows not fitted, less the penalty.
    """

    added: Added
    low: FloatArray
    high: FloatArray
    gap_before: float
    gap_after: float
    evidence: float


@dataclass(frozen=True)
class Rival:
    """A candidate for the first effect.

    Attributes
    ----------
    name, form, course : str
    evidence : float
        Twice the log-likelihood gained on windows not fitted, less the penalty.
    gap_after : float
        On the measured runs, with it alone [m].
    added : bool
        Whether it was added.
    """

    name: str
    form: str
    evidence: float
    gap_after: float
    course: str = ""
    added: bool = False

    @property
    def form_in_words(self) -> str:
        """The form, and how the effect comes and goes in time."""
        return " ".join(filter(None, (self.form, self.course))).replace("_", " ")


@dataclass(frozen=True)
class Equivalent:
    """An effect that the data do not distinguish from a named one.

    Attributes
    ----------
    name, instead_of : str
        In place of "unknown": a fault of the reference that is not named, as robots do the same.
    told_apart_by : str
        Measure or drive.
    by_equation : bool
        Whether the equations are those of the named effect: no drive distinguishes them.
    """

    name: str
    instead_of: str
    told_apart_by: str
    by_equation: bool = False


@dataclass(frozen=True)
class Closing:
    """A gap before and after, beside what noise explains."""

    before: Gap
    after: Gap
    noise_floor: Gap

    @property
    def share_closed(self) -> float:
        """Of the excess above the noise floor; NaN where there is none."""
        excess = self.before.value - self.noise_floor.value
        return (self.before.value - self.after.value) / excess if excess > 0 else float("nan")


@dataclass(frozen=True)
class GapResult:
    """Where simulation and measurement disagree, and what was missing.

    Attributes
    ----------
    verdict : str
        Name of the first effect, "none" or "unknown".
    effects : tuple of NamedEffect
    equivalent : tuple of Equivalent
    location : Location
        Where the gap was before any effect was added.
    measured, holdout : Closing
        Of positions on the measured runs, fitted; and on those held out.
    rivals : tuple of Rival
    calibration : Calibration
        The base model.
    base : Base
        The same, moved within what its calibration leaves open.
    measured_scenes, holdout_scenes : tuple of DenseWindows
    horizon_s : float
    notes : tuple of str
        What a reader should know of the runs.
    next_drives : tuple of NextDrive
        Drives that would distinguish the first effect from those that the data do not.
    refusals : tuple of Refusal
        Names that had evidence and do not stand, and why.
    holdout_before : tuple of DenseWindows
        The held-out windows with poses that are left out after, if there are any.
    faults : tuple of (run, Finding)
        What `check` warns of in the same recordings, where it was asked.
    turns : tuple of (Closing, Closing), optional
        The two of headings or of the gyroscope, by which all is judged where positions show no gap
        on held-out data and these do.
    """

    verdict: str
    effects: tuple[NamedEffect, ...]
    equivalent: tuple[Equivalent, ...]
    location: Location
    measured: Closing
    holdout: Closing
    rivals: tuple[Rival, ...]
    calibration: Calibration
    base: Base
    measured_scenes: tuple[DenseWindows, ...]
    holdout_scenes: tuple[DenseWindows, ...]
    horizon_s: float
    notes: tuple[str, ...] = ()
    next_drives: tuple[NextDrive, ...] = ()
    refusals: tuple[Refusal, ...] = ()
    holdout_before: tuple[DenseWindows, ...] = ()
    faults: tuple[RunFinding, ...] = ()
    turns: tuple[Closing, Closing] | None = None

    @property
    def closings(self) -> tuple[Closing, Closing]:
        """Measured and held out, by the measure that shows the gap."""
        return self.turns or (self.measured, self.holdout)

    @property
    def depends_on(self) -> tuple[str, ...]:
        """Variables that the smooth functions follow which stand for something unknown."""
        kinds = (one.added.effect for one in self.effects)
        return tuple(kind.variable for kind in kinds if isinstance(kind, Residual))

    @property
    def stages(self) -> dict[str, tuple[Base, tuple[Added, ...]]]:
        """The model "before" and, where something was added or moved, "after"."""
        before: dict[str, tuple[Base, tuple[Added, ...]]]
        before = {"before": (self.calibration.base, ())}
        if not self.added and self.base is self.calibration.base:
            return before
        return {**before, "after": (self.base, self.added)}

    @property
    def added(self) -> tuple[Added, ...]:
        """All effects with their values."""
        return tuple(effect.added for effect in self.effects)
