"""Bags with bytes changed, cut out or put in: an import works, or says what is wrong."""

import numpy as np
import pytest

from odometry.errors import BagError, RunFolderError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import KINDS, RADIUS_M, Bag, course, name_of

MUTATIONS = 10


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    """Bytes of a small bag of each kind, and the suffix of its file."""
    found = {}
    for kind in KINDS:
        bag = Bag(kind)
        for t_s, left, right, x, y, _ in course(3.0):
            values = [left / RADIUS_M, right / RADIUS_M]
            bag.joints(t_s, ["left_wheel", "right_wheel"], np.zeros(2), values)
            bag.pose_stamped("/mocap/pose", t_s, bag.pose((x, y, 0), (1, 0, 0, 0)))
        path = bag.write(tmp_path_factory.mktemp(kind) / name_of(kind))
        file = path if path.is_file() else next(f for f in path.iterdir() if f.suffix != ".yaml")
        found[kind] = (file.read_bytes(), file.suffix)
    return found


def mutated(content, rng):
    place, length = int(rng.integers(4, len(content))), int(rng.integers(1, 200))
    kind = rng.integers(4)
    if kind == 0:
        return content[:place]
    if kind == 1:
        return content[:place] + rng.bytes(length) + content[place + length :]
    if kind == 2:
        return content[:place] + content[place + length :]
    return content[:place] + bytes(length) + content[place:]


@pytest.mark.parametrize("kind", KINDS)
def test_only_what_is_wrong_with_a_bag_is_raised(kind, contents, tmp_path):
    content, suffix = contents[kind]
    rng = np.random.default_rng(KINDS.index(kind))
    worked = 0
    for number in range(MUTATIONS):
        file = tmp_path / f"bag{number}{suffix}"
        file.write_bytes(mutated(content, rng))
        try:
            imported(tmp_path / f"run{number}", file)
        except (BagError, RunFolderError):
            continue
        worked += 1
    assert worked > 0
