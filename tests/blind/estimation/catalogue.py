"""All faults of drives, and a case of one."""

import zlib

import numpy as np

from tests.blind.estimation import moved, poses, sensors
from tests.blind.faults.fault import UnsuitableError

FAULTS = {fault.key: fault for room in (poses, sensors, moved) for fault in room.FAULTS}


def make_case(fault, recording, name, seed):
    """A case of a fault on a recording, or None where it has no place for it."""
    rng = np.random.default_rng([seed, zlib.crc32(fault.key.encode()), zlib.crc32(name.encode())])
    try:
        return fault.draw(recording, rng)
    except UnsuitableError:
        return None
