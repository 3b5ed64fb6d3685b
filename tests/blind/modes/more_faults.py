"""More faults of records, made after the modes had been mended for the others: headings, too."""

import numpy as np

from tests.blind.commands import RATE_HZ

LASTS_S = 5.0  # of an encoder that counts double


def encoder_counts_double(recording, onset_s, rng):
    """One tread for some seconds."""
    table = recording["odometry"]
    side = ("v_left", "v_right")[rng.integers(2)]
    double = (table["t"] >= onset_s) & (table["t"] < onset_s + LASTS_S)
    return recording.with_columns("odometry", **{side: table[side] * np.where(double, 2.0, 1.0)})


def gyro_tilted(recording, onset_s, rng):  # noqa: ARG001
    """The IMU came loose: its z axis leans by 20 to 45 degrees."""
    table, lean_rad = recording["odometry"], np.deg2rad(rng.uniform(20.0, 45.0))
    rate = np.gradient(table["roll"], table["t"])
    measured = np.cos(lean_rad) * table["gyro_z"] + np.sin(lean_rad) * rate
    return recording.with_columns("odometry", gyro_z=measured)


def gyro_on_its_side(recording, onset_s, rng):  # noqa: ARG001
    """It hears no turn."""
    table = recording["odometry"]
    return recording.with_columns("odometry", gyro_z=rng.normal(0.0, 0.01, len(table["t"])))


def gyro_in_packets(recording, onset_s, rng):  # noqa: ARG001
    """A value is held for some tenths of a second."""
    table, held = recording["odometry"], round(rng.uniform(0.2, 0.6) * RATE_HZ)
    rows = np.arange(len(table["t"])) // held * held
    return recording.with_columns("odometry", gyro_z=table["gyro_z"][rows])


def odometry_stamps_jump(recording, onset_s, rng):
    """The clock of the treads and the gyroscope goes ahead by some tenths of a second."""
    table = recording["odometry"]
    return recording.with_columns(
        "odometry", t=table["t"] + (table["t"] >= onset_s) * rng.uniform(0.3, 1.0)
    )


def payload(recording, onset_s, rng):  # noqa: ARG001
    """A load presses both tyres: they go less far in a turn than is counted."""
    table, factor = recording["odometry"], rng.uniform(1.04, 1.12)
    scaled = {side: table[side] * factor for side in ("v_left", "v_right")}
    return recording.with_columns("odometry", **scaled)


def treads_quantised(recording, onset_s, rng):  # noqa: ARG001
    """Encoders count coarsely."""
    table, step_m_s = recording["odometry"], rng.uniform(0.05, 0.2)
    rounded = {side: np.round(table[side] / step_m_s) * step_m_s for side in ("v_left", "v_right")}
    return recording.with_columns("odometry", **rounded)


def yaw_drifts(recording, onset_s, rng):
    """The reference's heading walks off steadily."""
    rate_rad_s = rng.uniform(0.01, 0.05) * rng.choice([-1, 1])
    return _with_yaw(recording, lambda t, yaw: yaw + rate_rad_s * np.maximum(t - onset_s, 0.0))


def yaw_jumps(recording, onset_s, rng):  # noqa: ARG001
    """The reference corrects its heading every few seconds."""
    steps_rad = rng.normal(0.0, 0.2, 40)
    return _with_yaw(
        recording, lambda t, yaw: yaw + np.cumsum(steps_rad)[(t // 3.0).astype(int) % 40]
    )


def yaw_frozen(recording, onset_s, rng):  # noqa: ARG001
    """The reference's heading stays."""
    return _with_yaw(recording, lambda t, yaw: yaw[np.searchsorted(t, onset_s)] + 0 * yaw)


def _with_yaw(recording, change):
    pose = recording["pose"]
    yaw = change(pose["t"], np.unwrap(pose["yaw"]))
    return recording.with_columns("pose", yaw=np.angle(np.exp(1j * yaw)))


MORE = {
    f"more_{fault.__name__}": fault
    for fault in (
        encoder_counts_double,
        gyro_tilted,
        gyro_on_its_side,
        gyro_in_packets,
        odometry_stamps_jump,
        payload,
        treads_quantised,
        yaw_drifts,
        yaw_jumps,
        yaw_frozen,
    )
}
