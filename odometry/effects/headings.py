"""Whether a robot looked in enough directions for an error that follows the heading."""

import numpy as np

from odometry.models.inputs import Inputs

SECTORS, LEAST_SECTORS = 12, 6  # of the circle, and in how many of them the robot must look
FEW_HEADINGS = "headings over half a turn"
LEAST_SHARE = 0.01  # of the samples, in a sector


def all_round(inputs: Inputs) -> str:
    """What is lacking: headings over half a turn or more; "" where there are."""
    if inputs.heading_rad is None:
        return "headings"
    sector = np.floor(inputs.heading_rad / (2 * np.pi) * SECTORS) % SECTORS
    shares = np.bincount(sector.astype(np.int64), minlength=SECTORS) / len(sector)
    enough = np.count_nonzero(shares >= LEAST_SHARE) >= LEAST_SECTORS
    return "" if enough else FEW_HEADINGS
