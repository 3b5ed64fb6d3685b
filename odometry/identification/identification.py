"""What an identification finds."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from odometry.effects.tables import table_of
from odometry.errors import IdentificationError
from odometry.identification.fit import Fit
from odometry.identification.halves import Halves
from odometry.identification.plausibility import CAUSES, refusals
from odometry.identification.runs_apart import RunsApart
from odometry.identification.stretch_fit import FEWEST
from odometry.identification.two_kinds import TwoKinds
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.window_errors import WindowErrors, errors_over


@dataclass(frozen=True)
class Identified:
    """The parameters that runs determine of a model on one terrain.

    Attributes
    ----------
    fit : Fit
        To all windows.
    held_out : WindowErrors or None
        None where a part alone cannot be fitted.
    held_out_by : str
        "runs": each by the others; "halves": each half of every run by the others, where a terrain
        has one run or one run does not determine the model.
    ideal : WindowErrors
        Of the ideal differential drive on the same windows.
    given : Mapping of name to float
        Parameters that were held at a stated value.
    halves : Halves or None
        Fits to either half of every run; None where one cannot be fitted.
    apart : RunsApart or None
        Runs that do not fit one model; None where all agree.
    kinds : TwoKinds or None
        Windows that two sets explain far better than one.
    horizon_m : float or None
        Wheel travel of a window: less than asked where there were too few of these.
    """

    fit: Fit
    held_out: WindowErrors | None
    held_out_by: str
    ideal: WindowErrors
    given: Mapping[str, float] = field(default_factory=dict)
    halves: Halves | None = None
    apart: RunsApart | None = None
    kinds: TwoKinds | None = None
    horizon_m: float | None = None

    @property
    def mixed(self) -> str:
        """Why one parameter set is true of no part of the recordings; "" where it may be."""
        found = self.apart or self.kinds
        return found.note() if found else ""

    def to_parameters(self, source: str) -> TerrainParameters:
        """The table of a parameter set, with the effects that the model has."""
        fit = self.fit
        return table_of(fit.model, fit.values, fit.names, fit.normal_covariance, source)


@dataclass(frozen=True)
class Identification:
    """Parameters of a model that runs determine, by terrain.

    Attributes
    ----------
    robot : Robot
    terrains : Mapping of terrain to Identified
    window_config : WindowConfig
    """

    robot: Robot
    terrains: Mapping[str, Identified]
    window_config: WindowConfig

    @property
    def left_out(self) -> Counter[str]:
        """Windows of the runs that were left out, counted by reason, on all terrains together."""
        return next(iter(self.terrains.values())).fit.windows.left_out

    @property
    def left_open(self) -> tuple[str, ...]:
        """Parameters that the runs do not determine, a clause each."""
        return tuple(
            f"[{terrain}] {words}"
            for terrain, found in self.terrains.items()
            for words in (
                *(open_.words() for open_ in found.fit.undetermined),
                *undetermined_by_positions(found.fit, self.robot),
                *undetermined_by_spread(found.fit, self.robot),
            )
        )

    @property
    def unexplained(self) -> tuple[str, ...]:
        """Why a fit is no model of what was recorded, a clause each."""
        return tuple(
            f"[{terrain}] {words}"
            for terrain, found in self.terrains.items()
            for words in (*refusals(found.fit), *contradicted(found.fit, found.ideal))
        )

    def require_determined(self) -> None:
        """Raise IdentificationError, with numbers, where a fit is no answer.

        It leaves parameters open, has one at its bound with residuals far above the noise, or
        lies farther from positions without yaw than the ideal drive.
        """
        if self.left_open:
            raise IdentificationError(
                "the runs do not determine these parameters, or not separately:\n  "
                + "\n  ".join(self.left_open)
                + "\nAdd runs that excite them (turns both ways at several speeds; slopes), fix "
                "values that are known, or choose a model with fewer parameters."
            )
        if self.unexplained:
            raise IdentificationError(
                "the model does not explain what was recorded:\n  "
                + "\n  ".join(self.unexplained)
                + f"\nLikeliest: {CAUSES}."
            )

    def to_parameter_set(self) -> ParameterSet:
        """One table a terrain, with covariances and where the values come from."""
        terrains = {}
        for terrain, found in self.terrains.items():
            runs = ", ".join(dict.fromkeys(map(str, found.fit.windows.run)))
            source = (
                f"identified by terrain-odometry from {len(found.fit.windows)} {found.fit.noun} of "
                f"{runs}"
            )
            terrains[terrain] = found.to_parameters(source)
        named = {"name": self.robot.name} if self.robot.name else {}
        return ParameterSet(terrains, named | {"track_width": self.robot.track_width})


def undetermined_by_positions(fit: Fit, robot: Robot) -> tuple[str, ...]:
    """What stretches of positions do not determine, a clause each; nothing of a fit to poses.

    Too few stretches show no spread, so that their intervals rest on an assumption; and an
    interval that is wider than the parameter is large does not determine it.
    """
    if fit.noise is None:
        return ()
    found = []
    if len(fit.windows) < FEWEST:
        found.append(
            f"{len(fit.windows)} stretches of {fit.windows.travel_m.mean():.1f} m (positions "
            f"have a noise of {fit.noise.position_m:.2g} m): fewer than {FEWEST} do not show the "
            "errors of the model; drive farther"
        )
    sizes = fit.model.ordinary_sizes(robot)
    intervals = fit.intervals
    for parameter, size in zip(fit.model.parameters, sizes, strict=True):
        if parameter.name in fit.names and parameter.name not in fit.open_names:
            of = intervals[parameter.name]
            if of.high - of.low > 2 * size:
                found.append(
                    f"{parameter.name}: 95 % interval {of.low:.3g} to {of.high:.3g} "
                    f"{parameter.unit}, more than its ordinary size ({size:.2g}) to either side"
                )
    return tuple(found)


def undetermined_by_spread(fit: Fit, robot: Robot) -> tuple[str, ...]:
    """Parameters that a set would state with more than their size, a clause each.

    A few windows fit any noise: their spread then says little, and Student's t makes intervals
    wide. Nothing of a fit to positions, which `undetermined_by_positions` judges.
    """
    if fit.noise is not None:
        return ()
    sizes = dict(zip(fit.values, fit.model.ordinary_sizes(robot), strict=True))
    stated = np.sqrt(np.diag(fit.normal_covariance)).tolist()
    return tuple(
        f"{name}: 95 % interval {fit.intervals[name].low:.3g} to {fit.intervals[name].high:.3g}, "
        f"by {freedom:.1f} degrees of freedom: add runs"
        for name, sigma, freedom in zip(fit.names, stated, fit.freedom.tolist(), strict=True)
        if name not in fit.open_names and sigma > sizes[name]
    )


def contradicted(fit: Fit, ideal: WindowErrors) -> tuple[str, ...]:
    """A clause where the ideal differential drive has less of both errors than the fit.

    The fit could have chosen that motion. Nothing of a fit to poses.

    Parameters
    ----------
    fit : Fit
    ideal : WindowErrors
        Of the ideal differential drive on the stretches of the fit.
    """
    if fit.noise is None or not fit.names:
        return ()
    own = errors_over(fit.model, fit.packed, fit.windows)
    pairs = (
        (own.translation_per_m.mean(), ideal.translation_per_m.mean(), "m per m"),
        (np.degrees(own.rotation_per_m.mean()), np.degrees(ideal.rotation_per_m.mean()), "deg/m"),
    )
    if any(mine <= other for mine, other, _ in pairs):
        return ()
    errors = " and ".join(f"{mine:.3g} against {other:.3g} {unit}" for mine, other, unit in pairs)
    return (f"the ideal differential drive has smaller errors on the fitted stretches: {errors}",)
