"""Which findings follow from others, and are not reported beside them."""

from collections.abc import Sequence

from odometry.checks.findings.finding import Finding, Level

POSES = frozenset(
    {"pose_late", "pose_jumps", "clocks_apart", "slip", "scale", "position_unit"}
    | {"recordings_joined"}
)
YAW = frozenset({"yaw_backwards", "yaw_off_by_90", "yaw_offset", "yaw_unrelated"})
TREADS = frozenset({"slip", "slip_in_turns", "scale", "tread_unit", "position_unit", "track_width"})
OF_OTHER_TIMES = (  # speeds that are not of their stamps
    TREADS
    | POSES
    | {"treads_late", "treads_are_commands", "gyroscope_late", "treads_unequal", "tread_offset"}
    | {"turn_blocked", "stuck_encoder", "treads_not_proportional", "far_sensor"}
)

OF_LOST = frozenset(
    {"slip", "slip_in_turns", "scale", "pose_jumps", "treads_unrelated", "gyroscope_unrelated"}
    | {"tread_offset", "treads_unequal", "treads_late", "treads_are_commands"}
)

# Where a fifth of the rows of a file and more had the stamp of another row, those that are left are
# no more of their times.
OF_REPEATED_STAMPS = OF_OTHER_TIMES | {
    *("poses_unrelated", "pose_outliers", "frozen_poses", "dropped_speeds", "smoothed_poses"),
    *("tread_late", "treads_held", "odometry_gap", "interpolated_poses", "yaw_jumps"),
    *("yaw_late", "positions_late"),
}

# Cause: what follows from it.
CONSEQUENCES: dict[str, frozenset[str]] = {
    "latitude_longitude": POSES | YAW | {"positions_mirrored", "yaw_reversed", "coarse_positions"},
    "web_map_positions": POSES | TREADS | {"map_frame", "position_unit"},
    "interleaved_rows": TREADS
    | POSES
    | {
        "dropped_speeds",
        "placeholder_speeds",
        "absurd_speed",
        "treads_unrelated",
        "poses_unrelated",
        "coarse_speeds",
    }
    | {"gyroscope_unrelated", "treads_are_commands", "treads_late", "uneven_stamps", "yaw_jumps"}
    | {"treads_unequal", "tread_offset", "stuck_encoder", "treads_swapped", "repeated_stamps"}
    | {"treads_not_proportional", "turns_at_rest", "turns_recorded_once", "treads_are_twist"},
    "stamp_pace": TREADS
    | POSES
    | {"gyroscope_unit", "gyroscope_scale", "coarse_positions", "yaw_jumps", "gyroscope_late"}
    | {"treads_late", "treads_are_commands", "one_motion"},
    "earth_centred": POSES | YAW | {"positions_mirrored", "yaw_reversed", "pose_mirrored"},
    "yaw_constant": YAW | {"pose_late", "poses_unrelated", "gyroscope_unit", "clocks_apart"},
    "yaw_is_quaternion": YAW
    | {"yaw_jumps", "pose_late", "gyroscope_unit", "track_width", "poses_unrelated", "clocks_apart"}
    | {"yaw_reversed", "yaw_in_degrees", "pose_mirrored", "positions_mirrored"},
    "pose_bursts": POSES
    | {"pose_outliers", "noisy_positions", "yaw_jumps", "interpolated_poses", "yaw_bent"},
    "repeated_poses": POSES
    | YAW
    | {"yaw_in_degrees", "gyroscope_unit", "track_width", "tread_unit"},
    "yaw_is_course": YAW | {"pose_late", "poses_unrelated", "gyroscope_unit", "yaw_jumps"},
    "poses_are_wheel_odometry": frozenset(
        {"gyroscope_unit", "track_width", "pose_late", "yaw_is_course", "yaw_jumps"}
        | {"gyroscope_bias", "ticking_poses"}
    ),
    "ticking_poses": frozenset(
        {"pose_jumps", "pose_outliers", "treads_unsigned", "noisy_positions"}
    )
    | {"positions_stretched"},
    "coarse_positions": frozenset({"repeated_poses", "noisy_positions"}),
    "noisy_positions": frozenset({"pose_late", "pose_jumps", "clocks_apart", "slip"})
    | YAW
    | {"yaw_jumps", "far_sensor", "pose_outliers"},
    "treads_are_twist": TREADS
    | POSES
    | {"pose_mirrored", "gyroscope_reversed", "treads_or_gyroscope_reversed"}
    | {"treads_unequal", "tread_left_reversed", "treads_swapped", "treads_both_reversed"}
    | {"far_sensor", "tread_right_reversed", "treads_unrelated", "yaw_backwards"}
    | {"turn_blocked"},
    "treads_equal": TREADS
    | POSES
    | {"treads_unrelated", "far_sensor", "treads_are_twist", "treads_unequal", "stuck_encoder"}
    | {"treads_or_gyroscope_reversed", "treads_swapped", "gyroscope_reversed", "pose_mirrored"}
    | {"gyroscope_unrelated", "poses_unrelated", "treads_late", "tread_offset", "gyroscope_unit"}
    | {"yaw_reversed", "turns_at_rest", "one_motion", "changed_in_part", "tread_scale_drifts"},
    "treads_unsigned": TREADS
    | POSES
    | YAW
    | {"treads_unrelated", "far_sensor", "treads_unequal", "tread_offset", "slip_episodes"}
    | {"treads_equal", "treads_are_twist", "stuck_encoder", "gyroscope_unit", "pose_late"}
    | {"gyroscope_unrelated", "gyroscope_reversed", "turns_at_rest"},
    "tread_scale_changed": TREADS
    | POSES
    | {"treads_not_proportional", "far_sensor", "treads_unequal", "slip_episodes"},
    "tread_scale_drifts": TREADS
    | POSES
    | {"treads_not_proportional", "far_sensor", "treads_unequal", "tread_offset"},
    "treads_unequal": frozenset({"pose_jumps", "turn_blocked"}),
    "track_width": frozenset({"robot_size"}),  # turns say how wide it is
    "treads_are_counters": TREADS
    | POSES
    | YAW
    | {"treads_unrelated", "absurd_speed", "tread_left_reversed", "tread_right_reversed"}
    | {"treads_swapped", "gyroscope_unrelated", "pose_mirrored", "treads_both_reversed"}
    | {"one_motion", "poses_unrelated"},
    "tread_offset": frozenset({"treads_unequal", "gyroscope_bias", "pose_jumps"}),
    "tread_late": OF_OTHER_TIMES | {"yaw_jumps"},
    "treads_held": OF_OTHER_TIMES,
    "coarse_yaw": YAW
    | POSES
    | {"yaw_jumps", "yaw_bent", "poses_unrelated", "gyroscope_unit", "interpolated_poses"}
    | {"far_sensor", "track_width", "treads_frozen", "gyroscope_late", "treads_late"},
    "positions_on_lines": POSES
    | YAW
    | {"pose_outliers", "positions_stretched", "position_axes", "treads_frozen", "far_sensor"},
    "saturated_speed": frozenset({"stuck_encoder", "pose_jumps", "treads_frozen"})
    | {"treads_unequal", "tread_offset", "slip", "scale", "track_width", "slip_in_turns"},
    "treads_frozen": frozenset({"pose_jumps", "slip", "odometry_gap", "turns_at_rest"})
    | {"far_sensor", "track_width", "treads_unequal", "tread_offset", "turn_blocked"},
    "odometry_gap": frozenset({"pose_jumps", "positions_stretched", "yaw_bent"}),
    "clock_set": frozenset({"pose_jumps", "slip", "scale"}),
    "dropped_speeds": frozenset({"treads_not_proportional"}),
    "placeholder_speeds": frozenset({"treads_not_proportional", "absurd_speed", "dropped_speeds"}),
    "imu_mount": frozenset({"gyroscope_reversed", "gyroscope_unrelated"}),
    "treads_still": TREADS | POSES,
    "treads_unrelated": TREADS
    | YAW
    | {
        "pose_late",
        "treads_late",
        "clocks_apart",
        "turn_blocked",
        "dropped_speeds",
        "absurd_speed",
    },
    "poses_unrelated": (POSES - {"clocks_apart"})
    | (YAW - {"yaw_unrelated"})
    | {"position_unit", "pose_mirrored", "positions_mirrored"},
    "yaw_unrelated": (YAW - {"yaw_unrelated"}) | {"pose_late", "poses_unrelated"},
    "yaw_drifts": YAW | POSES | {"yaw_jumps", "gyroscope_bias", "yaw_bent"},
    "gyroscope_unrelated": frozenset(
        {
            "gyroscope_unit",
            "gyroscope_bias",
            "treads_late",
            "yaw_jumps",
            "yaw_bent",
            "turns_at_rest",
            "tread_unit",
        }
        | {"track_width", "slip_in_turns", "gyroscope_reversed", "pose_late", "gyroscope_late"}
    ),
    "tread_left_reversed": TREADS | YAW | POSES | {"treads_both_reversed", "turn_blocked"},
    "tread_right_reversed": TREADS | YAW | POSES | {"treads_both_reversed", "turn_blocked"},
    "treads_both_reversed": YAW,
    "clocks_apart": frozenset(
        {"gyroscope_unit", "pose_late", "treads_late", "pose_jumps", "poses_unrelated"}
        | {"slip_episodes", "treads_frozen"}
    ),
    "latency_changes": OF_OTHER_TIMES
    | {"gyroscope_unit", "poses_unrelated", "slip_episodes", "treads_frozen", "gyroscope_dead"}
    | {"tread_late", "yaw_jumps", "yaw_late", "positions_late"},
    "stuck_encoder": OF_LOST,
    "slow_speeds_zero": OF_LOST
    | {"dropped_speeds", "turn_blocked", "turns_at_rest", "straight_drives", "treads_frozen"},
    "gyroscope_clipped": frozenset(
        {"yaw_jumps", "gyroscope_unit", "gyroscope_dead", "gyroscope_bias", "yaw_bent"}
        | {"track_width", "slip_in_turns"}
    ),
    "gyroscope_held": frozenset({"gyroscope_dead", "yaw_jumps", "yaw_bent"}),
    "gyroscope_dead": frozenset(
        {"yaw_bent", "gyroscope_unit", "yaw_jumps", "stuck_encoder", "turns_at_rest"}
        | {"turn_blocked", "gyroscope_late"}
    ),
    "interpolated_poses": frozenset({"clocks_apart", "yaw_jumps", "smoothed_poses"}),
    "turns_at_rest": frozenset({"gyroscope_bias", "tread_offset"}),
    "tread_unit": frozenset({"track_width", "slip_in_turns", "slip"}),
    "slip": frozenset({"pose_late", "treads_late"}),
    "slip_in_turns": frozenset({"treads_late"}),
    "frozen_poses": frozenset(
        {"yaw_bent", "positions_stretched", "pose_jumps", "pose_late", "yaw_jumps", "slip_episodes"}
    ),
    "coarse_speeds": frozenset({"stuck_encoder", "treads_held"}),
    "position_unit": frozenset({"far_sensor"}),
    "position_axes": POSES | YAW | {"position_unit", "positions_stretched", "positions_mirrored"},
    "positions_stretched": frozenset({"scale", "yaw_offset"}),  # axes that lean turn it, too
}


# No curve of the speeds is fitted where these were found.
NOT_CURVES = frozenset(
    {
        "stuck_encoder",
        "slow_speeds_zero",
        "treads_frozen",
        "treads_are_twist",
        "treads_unrelated",
        "poses_unrelated",
    }
    | {"treads_equal", "treads_unsigned"}
)


LOST_FOR_A_WHILE = frozenset(
    {"turn_blocked", "dropped_speeds", "tread_late", "interleaved_rows", "changed_in_part"}
)


OF_TURNS = frozenset(
    {"pose_late", "clocks_apart", "clock_set", "poses_unrelated", "poses_are_wheel_odometry"}
    | {"pose_mirrored", "interpolated_poses", "repeated_poses", "frozen_poses", "turns_at_rest"}
    | {"uneven_stamps", "sensors_disagree", "smoothed_poses"}
)


def _is_of_turns(name: str) -> bool:
    """Whether a finding is of measured turns: of the gyroscope, yaw or their stamps."""
    return name.startswith(("gyroscope_", "yaw_")) or name in OF_TURNS


def without_consequences(findings: Sequence[Finding]) -> list[Finding]:
    """The findings of which none explains another."""
    names = {finding.name for finding in findings}
    implied = {follows for name in names for follows in CONSEQUENCES.get(name, ())}
    if any(f.name == "repeated_stamps" and f.level is not Level.NOTE for f in findings):
        implied |= OF_REPEATED_STAMPS
    if names & NOT_CURVES or names & LOST_FOR_A_WHILE:
        implied.add("tread_scale_drifts")  # whose course follows nearly anything
    if "stuck_encoder" in implied:
        implied.add("slow_speeds_zero")
    if names & NOT_CURVES:
        implied.add("treads_not_proportional")
    faults = {f.name for f in findings if f.level is not Level.NOTE} - {"sensors_disagree"}
    if faults:
        implied.add("sensors_disagree")  # it is for what has no name
    for smooth in ("smoothed_poses", "smoothed_treads"):
        if faults - {smooth}:
            implied.add(smooth)  # what is wrong otherwise may look smooth
    if any(f.level is not Level.NOTE and _is_of_turns(f.name) for f in findings):
        implied.add("gyroscope_scale")  # what is wrong by a little may be a part of it
    return [finding for finding in findings if finding.name not in implied]
