"""Paths of positions that are those of exchanged treads in a part, where nothing else turns."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.unexplained.position_differences import path_likenesses

LIKE, UNLIKE = 0.9, 0.8  # similarity of a path that is the one of the treads, and that is not
# Spans of 20 s of either kind. Of 34 real recordings without gyroscope and yaw none has more than
# one that is the path of exchanged treads.
LEAST_SPANS = 3


def exchanged_in_part(evidence: Evidence) -> str:
    """Words where positions are the path of the treads in some spans, and their mirror in others.

    Exchanged treads, or both with the other sign, turn to the other side. Compared where neither a
    gyroscope nor a yaw was measured: with them turns are.
    """
    if evidence.yaw_rate is not None or evidence.yaw_measured:
        return ""
    as_read, exchanged, began_s = path_likenesses(evidence)
    spans = [
        began_s[(one > LIKE) & (other < UNLIKE)]
        for one, other in ((as_read, exchanged), (exchanged, as_read))
    ]
    if min(map(len, spans)) < LEAST_SPANS:
        return ""
    at_s = evidence.run_time_s(float(np.min(spans[1])))
    return (
        f"the path of pose.csv is that of the treads in {len(spans[0])} spans of 20 s, and in "
        f"{len(spans[1])} that of exchanged treads (or of both with the other sign), first at "
        f"{at_s:.0f} s"
    )
