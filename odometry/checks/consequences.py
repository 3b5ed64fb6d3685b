"""Findings that follow from another one, and are not reported beside it."""

from collections.abc import Sequence

from odometry.checks.finding import Finding, Level

POSES = frozenset({"pose_late", "pose_jumps", "clocks_apart", "slip", "scale", "position_unit"})
YAW = frozenset({"yaw_backwards", "yaw_off_by_90", "yaw_offset", "yaw_unrelated"})
TREADS = frozenset({"slip", "slip_in_turns", "scale", "tread_unit", "position_unit", "track_width"})

# Cause: what follows from it.
CONSEQUENCES: dict[str, frozenset[str]] = {
    "latitude_longitude": POSES | YAW | {"positions_mirrored", "yaw_reversed", "coarse_positions"},
    "earth_centred": POSES | YAW | {"positions_mirrored", "yaw_reversed", "pose_mirrored"},
    "yaw_constant": YAW | {"pose_late", "poses_unrelated", "gyroscope_unit", "clocks_apart"},
    "yaw_is_quaternion": YAW
    | {"yaw_jumps", "pose_late", "gyroscope_unit", "track_width", "poses_unrelated", "clocks_apart"}
    | {"yaw_reversed", "yaw_in_degrees", "pose_mirrored", "positions_mirrored"},
    "repeated_poses": POSES
    | YAW
    | {"yaw_in_degrees", "gyroscope_unit", "track_width", "tread_unit"},
    "yaw_is_course": YAW | {"pose_late", "poses_unrelated", "gyroscope_unit", "yaw_jumps"},
    "poses_are_wheel_odometry": frozenset(
        {"gyroscope_unit", "track_width", "pose_late", "yaw_is_course", "yaw_jumps"}
    ),
    "noisy_positions": frozenset({"pose_late", "pose_jumps", "clocks_apart", "slip"})
    | YAW
    | {"yaw_jumps", "far_sensor", "pose_outliers"},
    "treads_are_twist": TREADS
    | POSES
    | {"pose_mirrored", "gyroscope_reversed", "treads_or_gyroscope_reversed"}
    | {"treads_unequal", "tread_left_reversed", "treads_swapped", "treads_both_reversed"}
    | {"far_sensor", "tread_right_reversed", "treads_unrelated", "yaw_backwards"},
    "treads_equal": TREADS
    | POSES
    | {"treads_unrelated", "far_sensor", "treads_are_twist", "treads_unequal", "stuck_encoder"},
    "tread_scale_changed": TREADS
    | POSES
    | {"treads_not_proportional", "far_sensor", "treads_unequal", "slip_episodes"},
    "treads_unequal": frozenset({"pose_jumps"}),
    "treads_are_counters": TREADS
    | POSES
    | YAW
    | {"treads_unrelated", "absurd_speed", "tread_left_reversed", "tread_right_reversed"}
    | {"treads_swapped", "gyroscope_unrelated", "pose_mirrored", "treads_both_reversed"},
    "tread_offset": frozenset({"treads_unequal", "gyroscope_bias", "pose_jumps"}),
    "uneven_stamps": frozenset({"odometry_gap"}),
    "saturated_speed": frozenset({"stuck_encoder", "pose_jumps", "treads_frozen"})
    | {"treads_unequal", "tread_offset", "slip", "scale"},
    "treads_frozen": frozenset({"pose_jumps", "slip", "odometry_gap", "turns_at_rest"})
    | {"far_sensor", "track_width", "treads_unequal", "tread_offset"},
    "odometry_gap": frozenset({"pose_jumps", "positions_stretched", "yaw_bent"}),
    "clock_set": frozenset({"pose_jumps"}),
    "imu_mount": frozenset({"gyroscope_reversed", "gyroscope_unrelated"}),
    "treads_still": TREADS | POSES,
    "treads_unrelated": TREADS | YAW | {"pose_late", "treads_late", "clocks_apart"},
    "poses_unrelated": (POSES - {"clocks_apart"})
    | YAW
    | {"position_unit", "pose_mirrored", "positions_mirrored"},
    "yaw_unrelated": YAW | {"pose_late", "poses_unrelated"},
    "gyroscope_unrelated": frozenset({"gyroscope_unit", "gyroscope_bias", "treads_late"}),
    "tread_left_reversed": TREADS | YAW | POSES | {"treads_both_reversed"},
    "tread_right_reversed": TREADS | YAW | POSES | {"treads_both_reversed"},
    "treads_both_reversed": YAW,
    "clocks_apart": frozenset(
        {"gyroscope_unit", "pose_late", "treads_late", "pose_jumps", "poses_unrelated"}
    ),
    "stuck_encoder": frozenset(
        {"slip", "slip_in_turns", "scale", "pose_jumps", "treads_unrelated", "gyroscope_unrelated"}
        | {"tread_offset", "treads_unequal"}
    ),
    "gyroscope_clipped": frozenset(
        {"yaw_jumps", "gyroscope_unit", "gyroscope_dead", "gyroscope_bias", "yaw_bent"}
    ),
    "gyroscope_dead": frozenset({"yaw_bent", "gyroscope_unit", "yaw_jumps", "stuck_encoder"}),
    "interpolated_poses": frozenset({"clocks_apart"}),
    "turns_at_rest": frozenset({"gyroscope_bias", "tread_offset"}),
    "tread_unit": frozenset({"track_width", "slip_in_turns", "slip"}),
    "slip": frozenset({"pose_late", "treads_late"}),
    "slip_in_turns": frozenset({"treads_late"}),
    "frozen_poses": frozenset(
        {"yaw_bent", "positions_stretched", "pose_jumps", "pose_late", "yaw_jumps", "slip_episodes"}
    ),
    "coarse_speeds": frozenset({"stuck_encoder"}),
    "position_unit": frozenset({"far_sensor"}),
}


# No curve of the speeds is fitted where these were found.
NOT_CURVES = frozenset(
    {"stuck_encoder", "treads_frozen", "treads_are_twist", "treads_unrelated", "poses_unrelated"}
    | {"treads_equal"}
)


def without_consequences(findings: Sequence[Finding]) -> list[Finding]:
    """The findings of which none explains another."""
    names = {finding.name for finding in findings}
    told = {follows for name in names for follows in CONSEQUENCES.get(name, ())}
    if names & NOT_CURVES:
        told.add("treads_not_proportional")
    if any(f.level is not Level.NOTE and f.name != "sensors_disagree" for f in findings):
        told.add("sensors_disagree")  # it is for what has no name
    return [finding for finding in findings if finding.name not in told]
