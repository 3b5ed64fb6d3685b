"""What to look for where smooth functions stand for something unknown, and how to separate them."""

from collections.abc import Mapping, Sequence

from odometry.effects.unknown.residual import Residual
from odometry.gap.locate.region_words import noun_of

AT_SPEEDS = "several constant speeds, straight on and in one turn"
WITH_STOPS = "one speed, with and without stops and reversals"
IN_CIRCLES = "circles of several radii to both sides at one speed"
AFTER_REST = "the same course again after a rest"
TO_BOTH_SIDES = "turns on the spot, some to one side in turn and some to both"
RECORDED_ELSEWHERE = "the same course, with tread speeds recorded by the drives themselves"
LEVEL = "the same course on level terrain"
SLOWLY = "a straight line at one slow speed"
DRIVES: Mapping[str, str] = {  # in which a variable changes and the others hardly do
    **dict.fromkeys(("speed", "tread_speed", "other_tread_speed"), AT_SPEEDS),
    **dict.fromkeys(("speed_history", "tread_acceleration", "time_since_stop"), WITH_STOPS),
    **dict.fromkeys(("tread_speed_lost", "tread_speed_gained"), WITH_STOPS),
    **dict.fromkeys(("turn_since_rest", "turn_since_reversal"), TO_BOTH_SIDES),
    "tread_speed_repeated": RECORDED_ELSEWHERE,
    **dict.fromkeys(("travel_since_reversal", "tread_travel_since_reversal"), WITH_STOPS),
    **dict.fromkeys(("curvature", "speed_difference", "turn_before"), IN_CIRCLES),
    **dict.fromkeys(("lateral_acceleration", "lateral_acceleration_before"), IN_CIRCLES),
    **dict.fromkeys(("time", "mean_speed_before", "mean_turning_before"), AFTER_REST),
    **dict.fromkeys(("roll", "pitch", "leaning_forward", "leaning_left"), LEVEL),
    **dict.fromkeys(("wheel_angle", "left_wheel_angle", "right_wheel_angle"), SLOWLY),
    "heading": "straight lines on several headings",
    "place": "the same course at another place",
}
ON_A_MAST = "positions of an antenna on a mast that are not corrected for roll and pitch"
SUCH_AS: Mapping[str, str] = dict.fromkeys(("leaning_forward", "leaning_left"), ON_A_MAST)


def where_to_look(residuals: Sequence[Residual]) -> list[str]:
    """What to look for, by what each function depends on, as clauses: each once."""
    return list(
        dict.fromkeys(
            f"look for a cause that depends on {noun_of(one.variable)}"
            + (f", such as {SUCH_AS[one.variable]}" if one.variable in SUCH_AS else "")
            if one.remedy == Residual.remedy
            else one.remedy
            for one in residuals
        )
    )


def how_to_separate(residuals: Sequence[Residual]) -> str:
    """That several variables go together in these runs, and drives in which they do not."""
    names = dict.fromkeys(one.variable for one in residuals)
    if len(names) < 2:
        return ""
    drives = dict.fromkeys(DRIVES[name] for name in names)
    return (
        "These go together in these runs: the cause may follow one of them, or something else that "
        f"goes with them. To separate them, drive for a minute each: {'; '.join(drives)}."
    )
