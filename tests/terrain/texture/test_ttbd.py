"""Which greys are in which binary image, by hand."""

import numpy as np

from terrain.texture.ttbd import chen2023_members, costa2012_members, packed_tables


def spans(members):
    return [(int(np.flatnonzero(row)[0]), int(np.flatnonzero(row)[-1])) for row in members]


def test_images_of_the_paper():
    members = chen2023_members(np.array([10.0, 20.0]))
    assert spans(members) == [(11, 255), (21, 255), (11, 20), (21, 255)]


def test_images_of_the_published_code():
    members = costa2012_members(np.array([10.0, 20.0]))
    assert spans(members) == [(11, 255), (21, 255), (11, 19)]


def test_thresholds_of_the_published_code_may_lie_between_greys_and_out_of_order():
    members = costa2012_members(np.array([30.5, 0.0, 20.5]))
    assert spans(members[:3]) == [(31, 255), (1, 255), (21, 255)]
    assert not members[3].any()
    assert spans(members[4:]) == [(1, 20)]


def test_packing_keeps_every_image():
    rng = np.random.default_rng(5)
    members = rng.random((11, 256)) < 0.5
    tables = packed_tables(members)
    assert tables.shape == (2, 256)
    for image, greys in enumerate(members):
        np.testing.assert_array_equal(tables[image // 8] >> image % 8 & 1, greys)
