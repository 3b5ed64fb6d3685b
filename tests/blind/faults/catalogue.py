"""All faults, and a case of one: a faulty copy of a clean recording.

from tests.blind.faults.catalogue import FAULTS, make_case
folder, base = make_case(FAULTS["pose_late"], bases, seed=3, folder=Path("somewhere"))
"""

import numpy as np

from tests.blind.faults import (
    bent,
    computed,
    copied,
    encoders,
    frames,
    images,
    inertial,
    poses,
    references,
    robot,
    slow,
    stamps,
    substitutes,
    texts,
    treads,
    velocities,
)
from tests.blind.faults.fault import UnsuitableError, says
from tests.blind.faults.recordings import read_recording, write_recording

ROOMS = (
    stamps,
    treads,
    velocities,
    encoders,
    poses,
    frames,
    references,
    substitutes,
    inertial,
    robot,
    images,
    texts,
    bent,
    computed,
    copied,
    slow,
)
FAULTS = {fault.key: fault for room in ROOMS for fault in room.FAULTS}
MOTION = frozenset({"motion"})


def suitable(fault, bases):
    """Recordings that have what a fault needs."""
    needs = fault.needs or MOTION
    return [base for base in bases if needs <= base.has]


def make_case(fault, bases, seed, folder):
    """Write a faulty copy; returns its base. The same seed and bases give the same bytes."""
    rng = np.random.default_rng([seed, *fault.key.encode()])
    candidates = suitable(fault, bases)
    if not candidates:
        raise UnsuitableError(f"{fault.key}: no recording with {', '.join(fault.needs)}")
    for _ in range(30):
        base = candidates[rng.integers(len(candidates))]
        try:
            faulty = fault.draw(read_recording(base.folder), rng)
        except UnsuitableError:
            continue
        write_recording(faulty, folder)
        return base
    raise UnsuitableError(f"{fault.key}: 30 draws found no place where it matters")


def right(fault, seen, cause):
    """Whether a cause is that of the fault, or of one that the files cannot distinguish from it."""
    faults = [fault, *(FAULTS[key] for key in fault.equal)]
    return any(says(seen, cause, one.words) for one in faults)
