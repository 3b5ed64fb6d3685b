"""Every finding by name: what it says, and which findings follow from it."""

from collections.abc import Sequence

from odometry.checks.finding import Finding, Level

CATALOGUE: dict[str, str] = {
    # Files, stamps and run.toml
    "no_run_folder": "a bag, another file or folder",
    "column_name": "a column that is not read, with a name like a known one",
    "unreadable": "a file is not as the format says",
    "one_row": "odometry.csv has one row",
    "stamp_unit": "stamps in ns, us or ms",
    "files_apart": "files that share no time: time zone, epoch, another recording",
    "stamps_lost_digits": "stamps that have lost their last digits",
    "repeated_stamps": "rows that repeat a stamp were dropped",
    "epoch_stamps": "stamps count from 1970",
    "uneven_stamps": "stamps of arrival, in bursts",
    "odometry_gap": "rows of odometry.csv are lost",
    "clock_set": "a clock that was set while recording",
    "track_width": "track width far from the width that turns imply",
    "robot_size": "sizes of [robot] in another unit",
    "setting_name": "a key of run.toml that is not read, with a name like a known one",
    "sensor_place": "[sensors] pose in mm",
    "terrain_names": "two spellings of one terrain",
    "one_motion": "a drive that only goes straight, spins, or is one circle",
    "sensors_disagree": "sensors differ, and the cause cannot be determined",
    # Treads
    "tread_unit": "tread speeds in rad/s, RPM, mm/s, ticks ...",
    "scale": "tread speeds or positions scaled",
    "slip": "the robot moves far less than its treads, not constantly",
    "slip_in_turns": "the robot turns far less than its treads say",
    "treads_swapped": "left and right exchanged",
    "treads_both_reversed": "both treads with the wrong sign",
    "tread_left_reversed": "left tread with the wrong sign",
    "tread_right_reversed": "right tread with the wrong sign",
    "treads_or_gyroscope_reversed": "treads and gyroscope turn opposite ways, no poses",
    "treads_unequal": "one side has another scale",
    "straight_drives": "one side has another scale, or the robot pulls to one side",
    "tread_offset": "one tread reads a constant besides its speed",
    "treads_are_twist": "the columns hold speed and turn rate",
    "treads_equal": "both columns hold one speed",
    "treads_unsigned": "the columns hold magnitudes",
    "tread_scale_changed": "the scale of the treads changes while recording",
    "treads_are_counters": "the columns hold positions of wheels",
    "treads_unrelated": "treads of another recording",
    "treads_not_proportional": "the columns hold a duty cycle, throttle or voltage",
    "treads_are_commands": "speeds that were commanded, not measured",
    "treads_late": "stamps of the treads late or early",
    "treads_still": "treads that do not move",
    "treads_frozen": "both treads lost while the robot moves",
    "turns_at_rest": "the gyroscope turns while the treads stand",
    "stuck_encoder": "one tread lost",
    "absurd_speed": "single corrupt samples",
    "dropped_speeds": "zeros amid motion",
    "coarse_speeds": "quantisation",
    "saturated_speed": "speeds clipped at a limit",
    # Poses
    "yaw_in_degrees": "yaw in degrees",
    "yaw_reversed": "yaw clockwise, or a compass bearing",
    "yaw_off_by_90": "yaw counts from another axis",
    "yaw_backwards": "yaw off by 180 degrees",
    "yaw_offset": "yaw off by a constant",
    "yaw_bent": "a compass that iron deviates",
    "yaw_constant": "yaw was not measured",
    "yaw_is_course": "yaw computed from positions",
    "yaw_is_quaternion": "a component of a quaternion",
    "yaw_unrelated": "yaw is no heading",
    "yaw_jumps": "yaw that jumps and stays",
    "pose_mirrored": "poses in a frame with z down (NED)",
    "positions_mirrored": "x and y swapped, or one negated",
    "position_axes": "positions of other axes, one of them vertical",
    "position_unit": "positions in mm, cm, km, feet",
    "latitude_longitude": "positions in degrees",
    "earth_centred": "positions from the centre of the earth (ECEF)",
    "positions_stretched": "x and y of different scales",
    "map_frame": "positions of a map (UTM)",
    "coarse_positions": "positions rounded (single precision)",
    "noisy_positions": "positions that scatter",
    "interpolated_poses": "poses between measured ones",
    "repeated_poses": "poses held between updates",
    "pose_outage": "no poses for a while",
    "frozen_poses": "a reference that was lost",
    "pose_jumps": "positions that jump and stay",
    "pose_outliers": "positions that go out and come back",
    "slip_episodes": "treads that drive on while the poses stay",
    "far_sensor": "a sensor far from the centre",
    "pose_late": "stamps of the poses late or early",
    "clocks_apart": "clocks that run apart",
    "poses_unrelated": "poses of another recording",
    "poses_are_wheel_odometry": "poses computed from these treads",
    # Gyroscope, attitude
    "gyroscope_is_treads": "a yaw rate computed from the treads",
    "treads_are_gyroscope": "treads computed from a speed and the gyroscope",
    "gyroscope_is_yaw": "a yaw rate computed from yaw",
    "yaw_is_gyroscope": "yaw that integrates the gyroscope",
    "yaw_is_treads": "yaw computed from the treads, beside measured positions",
    "turns_recorded_once": "treads and yaw rate, one of which was computed from the other",
    "gyroscope_bias": "a bias of the yaw rate",
    "gyroscope_unit": "yaw rate in degrees per second",
    "gyroscope_scale": "yaw rate scaled by some percent",
    "gyroscope_reversed": "yaw rate with the wrong sign",
    "gyroscope_clipped": "yaw rate clipped at a limit",
    "gyroscope_dead": "yaw rate that repeats one value",
    "gyroscope_held": "yaw rate that is renewed more rarely than it is logged",
    "gyroscope_late": "stamps of the gyroscope late or early",
    "gyroscope_unrelated": "another axis or another recording",
    "absurd_yaw_rate": "single corrupt samples",
    "attitude_in_degrees": "roll and pitch in degrees",
    "attitude_sign": "roll or pitch against gravity",
    "attitude_unit": "roll or pitch too small",
    "attitude_swapped": "roll and pitch exchanged",
    "imu_unit": "accelerations in g, or without gravity",
    "imu_mount": "an IMU upside down or on its side",
}


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
        | {"gyroscope_bias"}
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
    | {"treads_unrelated", "far_sensor", "treads_are_twist", "treads_unequal", "stuck_encoder"}
    | {"treads_or_gyroscope_reversed", "treads_swapped", "gyroscope_reversed", "pose_mirrored"}
    | {"gyroscope_unrelated", "poses_unrelated", "treads_late", "tread_offset", "gyroscope_unit"}
    | {"yaw_reversed", "turns_at_rest"},
    "treads_unsigned": TREADS
    | POSES
    | YAW
    | {"treads_unrelated", "far_sensor", "treads_unequal", "tread_offset", "slip_episodes"}
    | {"treads_equal", "treads_are_twist", "stuck_encoder", "gyroscope_unit", "pose_late"}
    | {"gyroscope_unrelated", "gyroscope_reversed", "turns_at_rest"},
    "tread_scale_changed": TREADS
    | POSES
    | {"treads_not_proportional", "far_sensor", "treads_unequal", "slip_episodes"},
    "treads_unequal": frozenset({"pose_jumps"}),
    "track_width": frozenset({"robot_size"}),  # turns say how wide it is
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
    "clock_set": frozenset({"pose_jumps", "slip", "scale"}),
    "dropped_speeds": frozenset({"treads_not_proportional"}),
    "imu_mount": frozenset({"gyroscope_reversed", "gyroscope_unrelated"}),
    "treads_still": TREADS | POSES,
    "treads_unrelated": TREADS | YAW | {"pose_late", "treads_late", "clocks_apart"},
    "poses_unrelated": (POSES - {"clocks_apart"})
    | (YAW - {"yaw_unrelated"})
    | {"position_unit", "pose_mirrored", "positions_mirrored"},
    "yaw_unrelated": (YAW - {"yaw_unrelated"}) | {"pose_late", "poses_unrelated"},
    "gyroscope_unrelated": frozenset({"gyroscope_unit", "gyroscope_bias", "treads_late"}),
    "tread_left_reversed": TREADS | YAW | POSES | {"treads_both_reversed"},
    "tread_right_reversed": TREADS | YAW | POSES | {"treads_both_reversed"},
    "treads_both_reversed": YAW,
    "clocks_apart": frozenset(
        {"gyroscope_unit", "pose_late", "treads_late", "pose_jumps", "poses_unrelated"}
        | {"slip_episodes", "treads_frozen"}
    ),
    "stuck_encoder": frozenset(
        {"slip", "slip_in_turns", "scale", "pose_jumps", "treads_unrelated", "gyroscope_unrelated"}
        | {"tread_offset", "treads_unequal", "treads_late", "treads_are_commands"}
    ),
    "gyroscope_clipped": frozenset(
        {"yaw_jumps", "gyroscope_unit", "gyroscope_dead", "gyroscope_bias", "yaw_bent"}
        | {"track_width", "slip_in_turns"}
    ),
    "gyroscope_held": frozenset({"gyroscope_dead", "yaw_jumps", "yaw_bent"}),
    "gyroscope_dead": frozenset(
        {"yaw_bent", "gyroscope_unit", "yaw_jumps", "stuck_encoder", "turns_at_rest"}
    ),
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
    "position_axes": POSES | YAW | {"position_unit", "positions_stretched", "positions_mirrored"},
    "positions_stretched": frozenset({"scale"}),
}


# No curve of the speeds is fitted where these were found.
NOT_CURVES = frozenset(
    {"stuck_encoder", "treads_frozen", "treads_are_twist", "treads_unrelated", "poses_unrelated"}
    | {"treads_equal", "treads_unsigned"}
)


OF_TURNS = frozenset(
    {"pose_late", "clocks_apart", "clock_set", "poses_unrelated", "poses_are_wheel_odometry"}
    | {"pose_mirrored", "interpolated_poses", "repeated_poses", "frozen_poses", "turns_at_rest"}
    | {"uneven_stamps", "sensors_disagree"}
)


def _is_of_turns(name: str) -> bool:
    """Whether a finding is of measured turns: of the gyroscope, yaw or their stamps."""
    return name.startswith(("gyroscope_", "yaw_")) or name in OF_TURNS


def without_consequences(findings: Sequence[Finding]) -> list[Finding]:
    """The findings of which none explains another."""
    names = {finding.name for finding in findings}
    implied = {follows for name in names for follows in CONSEQUENCES.get(name, ())}
    if names & NOT_CURVES:
        implied.add("treads_not_proportional")
    if any(f.level is not Level.NOTE and f.name != "sensors_disagree" for f in findings):
        implied.add("sensors_disagree")  # it is for what has no name
    if any(f.level is not Level.NOTE and _is_of_turns(f.name) for f in findings):
        implied.add("gyroscope_scale")  # what is wrong by a little may be a part of it
    return [finding for finding in findings if finding.name not in implied]
