"""What a fit to positions without yaw is based on, and what positions do not determine."""

from odometry.identification.fitted import Fit
from odometry.windows.stretches.stretches import Stretches

UNNOTICED_S = 0.1  # positions of real recordings that are in step with their treads lie within it


def position_notes(fit: Fit) -> tuple[str, ...]:
    """Sentences: what a fit to positions is based on, and what positions do not determine."""
    of, noise = fit.windows, fit.noise
    if noise is None or not isinstance(of, Stretches):
        return ()
    turns = "the treads alone" if of.turns_rad is None else "the gyroscope"
    basis = (
        f"positions without yaw: the shapes of {len(of)} stretches of {of.travel_m.mean():.1f} m "
        f"count, for positions with a noise of {noise.position_m:.2g} m; between positions the "
        f"yaw is carried by {turns}"
    )
    speed_m_s = float(of.travel_m.sum() / of.lasts_s[:, -1].sum())
    larger_m = UNNOTICED_S * speed_m_s
    delay = (
        f"stamps of positions that are late by {UNNOTICED_S:g} s, which no check notices, look "
        f"like an x_icr that is larger by {larger_m:.2g} m (at {speed_m_s:.2g} m/s); its interval "
        "does not hold that"
    )
    if of.arm_stated:
        return (
            basis,
            "[sensors] pose says where the antenna sits: where it is off, x_icr, y_left and "
            "y_right are off by as much, and their intervals do not hold that",
            delay,
        )
    return (
        basis,
        "[sensors] pose is not stated, so the antenna is taken to be at the robot's origin; an "
        "antenna ahead of it looks exactly like a smaller x_icr, one to the left like smaller "
        "y_left and y_right",
        delay,
    )
