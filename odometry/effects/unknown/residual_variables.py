"""Variables that an unknown part of the motion may follow, and basis functions of them."""

from collections.abc import Callable, Mapping

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.unknown.leaning import LEANING, leaning
from odometry.models.inputs import Inputs

HARMONICS = 2
ANGLES = ("heading", "wheel_angle", "left_wheel_angle", "right_wheel_angle")
SINCE_STOP = "time_since_stop"  # of a drive that stops
REPEATED = "tread_speed_repeated"  # of which only a share may be added
FURTHER = (  # no rivals of names
    *("tread_speed_lost", "tread_speed_gained", REPEATED),
    *("turn_since_rest", "turn_since_reversal", *LEANING),
)
OF_TREADS = (  # variables (N, 2): of each tread its own
    *("tread_speed", "tread_acceleration", "other_tread_speed"),
    *("tread_travel_since_reversal", "tread_speed_lost", "tread_speed_gained", REPEATED),
)
WHAT_WENT_BEFORE = (  # of a moment, or is elsewhere
    *("other_tread_speed", "tread_travel_since_reversal", "travel_since_reversal"),
    *("turn_before", "lateral_acceleration_before", SINCE_STOP),
    *("mean_speed_before", "mean_turning_before"),
)
ACCELERATION_OVER_S = 0.2
CREEPING_M_S = 0.05  # below this forward speed a curvature is taken as at it
REVERSING_M_S = 0.02  # slower is no reversal
LONG_SINCE_M = 10.0  # before the first reversal
TURNING_RAD_S = 0.02  # slower is no turn
LONG_SINCE_RAD = 3.0  # before the first turn
TURN_OVER_M = 1.0
FORCE_OVER_S = 1.0
MEAN_OVER_S = 8.0  # heat, charge and mud come and go over seconds
STOP_S = 0.5  # a shorter rest is a reversal
CHANGED_OVER_S = 0.6  # a body slides on for about as long


def variables_of(inputs: Inputs, twist: FloatArray | None = None) -> dict[str, FloatArray]:
    """What a residual may depend on, of what was recorded and of the twist (N, 3) simulated.

    Each is (N,), but those of `OF_TREADS` (N, 2). In a drive without a stop the time since one is
    run time.
    """
    names = [name for name in VARIABLES if name != SINCE_STOP or _has_stop(inputs)]
    found = {name: variable_of(name, inputs, twist) for name in names}
    return {name: values for name, values in found.items() if values is not None}


def variable_of(name: str, inputs: Inputs, twist: FloatArray | None) -> FloatArray | None:
    """Values of a variable, None where it was not recorded."""
    if name in RECORDED:
        return RECORDED[name](inputs)
    return None if twist is None or name not in SIMULATED else SIMULATED[name](twist, inputs)


def basis_of(variable: FloatArray, knots: tuple[float, ...]) -> FloatArray:
    """Basis functions (N, B): hats on the knots, or without any cosines, sines and one."""
    if knots:
        numbers = np.arange(len(knots), dtype=np.float64)
        between = np.interp(variable, knots, numbers)
        return np.maximum(1.0 - np.abs(between - numbers[:, None]), 0.0).T
    waves = [wave(k * variable) for k in range(1, HARMONICS + 1) for wave in (np.cos, np.sin)]
    return np.stack([*waves, np.ones_like(variable)], axis=-1)


def bases_of_treads(
    variable: FloatArray, knots: tuple[float, ...]
) -> tuple[FloatArray, FloatArray]:
    """Basis functions (N, B) for the left and the right tread."""
    if variable.ndim == 1:
        basis = basis_of(variable, knots)
        return basis, basis
    return basis_of(variable[:, 0], knots), basis_of(variable[:, 1], knots)


def _samples(inputs: Inputs) -> tuple[FloatArray, FloatArray]:
    """Run time (N,) of samples and how long each lasts, never nothing."""
    time_s = np.asarray(inputs.time_s)
    return time_s, np.maximum(np.diff(time_s, append=time_s[-1]), 1e-6)


def _wheel_angle(angles_rad: FloatArray | None, which: slice) -> FloatArray | None:
    return None if angles_rad is None else np.asarray(angles_rad[..., which].mean(axis=-1))


def _at_least(values: FloatArray, least: float) -> FloatArray:
    return np.copysign(np.maximum(np.abs(values), least), values)


def _accelerations(speeds_m_s: FloatArray, time_s: FloatArray | None) -> FloatArray | None:
    """Of both treads (N, 2) [m/s^2]: differences over ACCELERATION_OVER_S."""
    if time_s is None:
        return None
    ends = [
        np.searchsorted(time_s, time_s + side * ACCELERATION_OVER_S / 2, side="right") - 1
        for side in (1, -1)
    ]
    ahead, behind = (speeds_m_s[np.maximum(end, 0)] for end in ends)
    return np.asarray((ahead - behind) / ACCELERATION_OVER_S)


def _changed(inputs: Inputs, *, to_more: bool) -> FloatArray | None:
    """Speed (N, 2) [m/s] that each tread gained, or lost, in magnitude over CHANGED_OVER_S.

    With the sign of the faster of both speeds; zero where the change is of the other kind.
    """
    if inputs.time_s is None:
        return None
    time_s, now = np.asarray(inputs.time_s), inputs.tread_speeds_m_s
    then = now[np.maximum(np.searchsorted(time_s, time_s - CHANGED_OVER_S, side="right") - 1, 0)]
    more, less = (now, then) if to_more else (then, now)
    return np.asarray(np.sign(more) * np.maximum(np.abs(more) - np.abs(less), 0.0))


def _since_reversal(speed_m_s: FloatArray, inputs: Inputs) -> FloatArray:
    """Travel (N,) [m] since the speed last changed its sign, at the middle of each sample."""
    _, steps_s = _samples(inputs)
    moved_m = np.abs(speed_m_s) * steps_s
    middle_m = np.cumsum(moved_m) - moved_m / 2
    moving = np.flatnonzero(np.abs(speed_m_s) > REVERSING_M_S)
    turned = moving[1:][np.sign(speed_m_s[moving[1:]]) != np.sign(speed_m_s[moving[:-1]])]
    last = np.full(len(speed_m_s), -LONG_SINCE_M)
    last[turned] = (np.cumsum(moved_m) - moved_m)[turned]
    return np.asarray(middle_m - np.maximum.accumulate(last))


def _each_since_reversal(inputs: Inputs) -> FloatArray | None:
    if inputs.time_s is None:
        return None
    return np.stack([_since_reversal(speed, inputs) for speed in (inputs.left, inputs.right)], -1)


def _since_stop(inputs: Inputs) -> FloatArray | None:
    """Time (N,) [s] since both treads last stood, or the start."""
    if inputs.time_s is None:
        return None
    time_s, _ = _samples(inputs)
    _, rests = _stands_and_rests(inputs)
    return np.asarray(time_s - np.maximum.accumulate(np.where(rests, time_s, time_s[0])))


def _has_stop(inputs: Inputs) -> bool:
    """Whether treads that moved stand for a while and move again."""
    if inputs.time_s is None:
        return False
    stands, rests = _stands_and_rests(inputs)
    moving = np.flatnonzero(~stands)
    return len(moving) > 0 and bool(rests[moving[0] : moving[-1]].any())


def _stands_and_rests(inputs: Inputs) -> tuple[BoolArray, BoolArray]:
    """Whether both treads stand (N,), and whether they have stood for STOP_S."""
    time_s, _ = _samples(inputs)
    stands = np.asarray((np.abs(inputs.tread_speeds_m_s) < REVERSING_M_S).all(axis=-1))
    moved_s = np.maximum.accumulate(np.where(stands, time_s[0], time_s))
    return stands, stands & (time_s - moved_s >= STOP_S)


def _turn_since(twist: FloatArray, inputs: Inputs, *, rests: bool) -> FloatArray | None:
    """Size (N,) of the turn [rad] since its side last changed, or since it rested as well."""
    if inputs.time_s is None:
        return None
    _, steps_s = _samples(inputs)
    turned_rad = np.abs(twist[:, 2]) * steps_s
    sides = np.where(np.abs(twist[:, 2]) > TURNING_RAD_S, np.sign(twist[:, 2]), 0.0)
    kept = np.arange(len(sides)) if rests else np.flatnonzero(sides)
    begins = kept[1:][sides[kept[1:]] != sides[kept[:-1]]]
    before_rad = np.cumsum(turned_rad) - turned_rad
    last_rad = np.full(len(sides), -LONG_SINCE_RAD)
    last_rad[begins] = before_rad[begins]
    return np.asarray(before_rad + turned_rad / 2 - np.maximum.accumulate(last_rad))


def _turn_before(twist: FloatArray, inputs: Inputs) -> FloatArray | None:
    """Turn (N,) [rad] over the last TURN_OVER_M of travel."""
    if inputs.time_s is None:
        return None
    _, steps_s = _samples(inputs)
    travel_m = np.cumsum(np.abs(twist[:, 0]) * steps_s)
    turned_rad = np.cumsum(twist[:, 2] * steps_s)
    return np.asarray(turned_rad - np.interp(travel_m - TURN_OVER_M, travel_m, turned_rad))


def _mean_before(values: FloatArray, inputs: Inputs, over_s: float) -> FloatArray | None:
    """Mean (N,) over the time before each sample; before the first there was nothing."""
    if inputs.time_s is None:
        return None
    time_s, steps_s = _samples(inputs)
    ends_s = np.append(time_s, time_s[-1] + steps_s[-1])
    summed = np.concatenate([[0.0], np.cumsum(values * steps_s)])
    return np.asarray((summed[:-1] - np.interp(time_s - over_s, ends_s, summed)) / over_s)


RECORDED: Mapping[str, Callable[[Inputs], FloatArray | None]] = {
    "speed": lambda inputs: (inputs.left + inputs.right) / 2,
    "speed_difference": lambda inputs: inputs.right - inputs.left,
    "roll": lambda inputs: inputs.roll_rad,
    "pitch": lambda inputs: inputs.pitch_rad,
    "tread_speed": lambda inputs: inputs.tread_speeds_m_s,
    "tread_acceleration": lambda inputs: _accelerations(inputs.tread_speeds_m_s, inputs.time_s),
    "other_tread_speed": lambda inputs: inputs.tread_speeds_m_s[:, ::-1],
    "tread_travel_since_reversal": _each_since_reversal,
    "tread_speed_lost": lambda inputs: _changed(inputs, to_more=False),
    "tread_speed_gained": lambda inputs: _changed(inputs, to_more=True),
    REPEATED: lambda inputs: (
        np.zeros(inputs.tread_speeds_m_s.shape)
        if inputs.unrepeated_m_s is None
        else inputs.unrepeated_m_s
    ),
    "time": lambda inputs: inputs.time_s,
    SINCE_STOP: _since_stop,
    "mean_speed_before": lambda inputs: _mean_before(
        np.abs(inputs.tread_speeds_m_s).mean(axis=-1), inputs, MEAN_OVER_S
    ),
    "heading": lambda inputs: inputs.heading_rad,
    "wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(None)),
    "left_wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(0, 1)),
    "right_wheel_angle": lambda inputs: _wheel_angle(inputs.wheel_angles_rad, slice(1, 2)),
}
SIMULATED: Mapping[str, Callable[[FloatArray, Inputs], FloatArray | None]] = {
    LEANING[0]: lambda twist, inputs: leaning(twist, inputs, 0),
    LEANING[1]: lambda twist, inputs: leaning(twist, inputs, 1),
    "curvature": lambda twist, _: twist[:, 2] / _at_least(twist[:, 0], CREEPING_M_S),
    "lateral_acceleration": lambda twist, _: twist[:, 0] * twist[:, 2],
    "travel_since_reversal": lambda twist, inputs: (
        None if inputs.time_s is None else _since_reversal(twist[:, 0], inputs)
    ),
    "turn_before": _turn_before,
    "turn_since_rest": lambda twist, inputs: _turn_since(twist, inputs, rests=True),
    "turn_since_reversal": lambda twist, inputs: _turn_since(twist, inputs, rests=False),
    "lateral_acceleration_before": lambda twist, inputs: _mean_before(
        twist[:, 0] * twist[:, 2], inputs, FORCE_OVER_S
    ),
    "mean_turning_before": lambda twist, inputs: _mean_before(
        np.abs(twist[:, 2]), inputs, MEAN_OVER_S
    ),
}
VARIABLES = tuple(name for name in (*RECORDED, *SIMULATED) if name not in FURTHER)
