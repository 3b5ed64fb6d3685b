"""What a run does not show of errors of positions that last."""

from odometry.preparation.wander_at_rest import wander_sigma_m
from odometry.windows.recorded.measured_poses import lacks_yaw, measured_positions
from terrain.result.run_result import RunResult

HELD = frozenset({"noisy_positions", "wandering_positions"})  # kinds of events


def lasting_note(result: RunResult) -> list[str]:
    """Say that nothing shows whether positions without yaw, of a receiver, wander.

    Those that scatter, or wander at rest, have such errors in their sigmas. Without stops a
    receiver that smooths looks exact, and so does one that holds its position at each of them.
    """
    run = result.run
    if run.pose is None or not lacks_yaw(run) or result.config.filter.lasting_sigma_m:
        return []
    if any(event.kind in HELD for event in result.replay.events):
        return []
    if wander_sigma_m(run, *measured_positions(run)[:2]) is not None:
        return []
    return [
        "whether errors of the positions last (satellites) cannot be determined: it takes three "
        "stops of ten seconds, and positions that are not held there. sigma_x and sigma_y of the "
        "estimate hold none; where the receiver is no RTK, state them: [filter] lasting_sigma_m of "
        "--config"
    ]
