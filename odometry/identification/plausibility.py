"""Whether a fit is plausible: reasons to refuse it, notes of doubts, windows that are short."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.identification.fit import Fit
from odometry.identification.fitted import NORMAL, deviations_within
from odometry.models.base import Parameter
from odometry.recording.run import Robot
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.record import (
    CHANGE_OF_TERRAIN,
    CHANGE_OF_WINDOW,
    ODOMETRY_GAP,
    POSE_GAP,
    UNKNOWN_TURNS,
)
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows

FEW = 0.5  # share of the windows that may be shorter without a note
WHY = {
    CHANGE_OF_WINDOW: "`window` of pose.csv changes that often: its poses are chained in short "
    "stretches, and the motion from one to the next is less certain",
    POSE_GAP: "pose.csv has gaps that often",
    ODOMETRY_GAP: "odometry.csv has gaps that often",
    CHANGE_OF_TERRAIN: "the terrain changes that often",
    UNKNOWN_TURNS: "poses are so sparse that the whole turns between them cannot be counted",
}


def short_windows(windows: Windows | Stretches, config: WindowConfig) -> str:
    """How many windows are shorter than the horizon, and what cuts them; "" where few are.

    Stretches of positions are as long as they have to be.
    """
    if isinstance(windows, Stretches):
        return ""
    wanted, unit, length = config.travel_m, "m", windows.travel_m
    if config.horizon_s:
        wanted, unit, length = config.horizon_s, "s", _durations_s(windows)
    short = length < wanted * (1 - 1e-9)
    if short.mean() <= FEW:
        return ""
    cuts = [reason for reason, _ in windows.left_out.most_common() if reason in WHY]
    why = WHY[cuts[0]] if cuts else "the runs have no more"
    return (
        f"{short.sum()} of {len(windows)} windows are shorter than the {wanted:g} {unit} of the "
        f"horizon ({length[short].mean():.2f} {unit} on average): {why}. No window goes across "
        "such a place; a longer --horizon changes nothing"
    )


def _durations_s(windows: Windows) -> FloatArray:
    """How long each window (K,) lasts."""
    elapsed_s = np.concatenate([[0.0], np.cumsum(windows.steps_s)])
    return np.asarray(elapsed_s[windows.last] - elapsed_s[windows.first])


FEW_FREEDOM = 5.0
NEAR_BOUND = 1e-2
ABSURD = 0.1  # of the least usual gain: a robot that hardly moves shows no parameters
FAR_RESIDUALS = 3.0  # times the poses' stated noise
MOSTLY_OTHER = 5.0  # times it, from which most of the error is of something else
ONE_WAY = 0.05  # share of the turns of all windows that go to the rarer side
CAUSES = (
    "tread speeds in another unit (rad/s, RPM, mm/s), swapped or of the wrong sign; positions in "
    "degrees or kilometres; yaw in degrees or reversed; a wrong track_width; poses much worse than "
    "--position-sigma and --yaw-sigma say"
)


def refusals(fit: Fit) -> tuple[str, ...]:
    """Gains that no slip leaves, and parameters at a bound while the residuals are large.

    A search that would have gone on beyond its bound has not found a model of the motion. Where
    the residuals are as the noise explains, the bound is near enough to the truth, and a bound at
    which a parameter has no effect is an answer.
    """
    absurd = tuple(
        f"{parameter.name} is {fit.values[parameter.name]:.2g}, and slip leaves "
        f"{parameter.usual[0]:g} to {parameter.usual[1]:g} of the tread speed"
        for parameter in fit.model.parameters
        if parameter.usual
        and parameter.name in fit.names
        and abs(fit.values[parameter.name]) < ABSURD * parameter.usual[0]
    )
    return absurd or _at_bounds(fit)


def _at_bounds(fit: Fit) -> tuple[str, ...]:
    if fit.scale <= FAR_RESIDUALS:
        return ()
    parameters = {parameter.name: parameter for parameter in fit.model.parameters}
    return tuple(
        f"{name} ended at its bound {fit.values[name]:.4g}, and the residuals are {fit.scale:.1f} "
        f"times {fit.compared_with}"
        for name in fit.at_bound
        if not _is_neutral(parameters[name], fit.values[name])
    )


def _is_neutral(parameter: Parameter, value: float) -> bool:
    """Whether a value at a bound is the one without effect: the other bound is far from it."""
    return parameter.neutral is not None and abs(value - parameter.neutral) < NEAR_BOUND


def turns_outside(fit: Fit, robot: Robot) -> str:
    """That a robot seems to turn about a point ahead of it or behind it; "" where it does not.

    Its treads resist, so that it turns about a point between its ends. Half of a length that is
    not stated is taken as the track width.
    """
    x_m = fit.values.get("x_icr", 0.0)
    half_m = robot.length / 2 if robot.length else robot.track_width
    if abs(x_m) <= half_m:
        return ""
    point, side = ("ahead of its front", "behind") if x_m > 0 else ("behind its rear", "ahead of")
    return (
        f"x_icr = {x_m:.4g} m: the robot would turn about a point {point}. The reference is "
        f"probably {abs(x_m):.2g} m {side} the robot's origin: state it in [sensors] pose"
        + ("; or its positions are late, or late along one axis" * (fit.scale > FAR_RESIDUALS))
    )


def turns_one_way(fit: Fit) -> str:
    """That gains of both sides were found from turns to one side; "" where both were driven.

    How a robot turns to the other side may differ (where small differences of its treads do not
    turn it, gains of the sides take that up), and no interval holds by how much.
    """
    windows = fit.windows
    if isinstance(windows, Stretches) or not {"alpha_left", "alpha_right"} <= set(fit.names):
        return ""
    turns = windows.measured[:, 2]
    left, right = turns[turns > 0].sum(), -turns[turns < 0].sum()
    if min(left, right) >= ONE_WAY * (left + right):
        return ""
    side, other = ("left", "right") if left > right else ("right", "left")
    return (
        f"nearly all turns go to the {side}: alpha_left, alpha_right and ICRs hold for these, and "
        f"intervals do not hold how the robot turns to the {other}; add turns to the {other}"
    )


def notes(fit: Fit) -> tuple[str, ...]:
    """What is doubtful, a sentence each."""
    found = []
    for parameter in fit.model.parameters:
        value = fit.values[parameter.name]
        if parameter.name not in fit.names or parameter.name in fit.at_bound:
            continue
        if parameter.usual and not parameter.usual[0] <= value <= parameter.usual[1]:
            low, high = parameter.usual
            found.append(
                f"{parameter.name} = {value:.4g} is outside of {low:g} to {high:g}, where slip "
                "leaves it: are the tread speeds in m/s?"
            )
    parameters = {parameter.name: parameter for parameter in fit.model.parameters}
    found += [
        f"{name} ended at the edge of its search range"
        + (
            ", where it has no effect: a model without it predicts the same"
            if _is_neutral(parameters[name], fit.values[name])
            else ""
        )
        for name in fit.at_bound
        if name not in fit.open_names
    ]
    if fit.agreeing == 1 < fit.starts:
        found.append("no two starts agree; the minimum may not be the least")
    found += [
        f"{name} acts through a sign alone: a range of values fits equally well, and no interval "
        "can be stated"
        for name in fit.by_trial
    ]
    if fit.scale > MOSTLY_OTHER:
        found.append(
            f"the residuals are {fit.scale:.0f} times {fit.compared_with}: most of the error is "
            "not in this model (slip that comes and goes, an effect that it lacks, or a fault of "
            "the recording); `check` and `gap` say more"
        )
    few = float(fit.freedom.min(initial=np.inf))
    if few < FEW_FREEDOM:
        found.append(
            f"few windows, or few runs that differ: an interval rests on {few:.1f} degrees of "
            f"freedom and is {float(deviations_within(np.array(few))) / NORMAL:.1f} times as wide "
            "as with many; add runs"
        )
    return tuple(found)
