"""No ground is of two places."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from terrain.labelling.squares import place_centres, places_of

POINTS = arrays(float, st.tuples(st.integers(1, 40), st.just(2)), elements=st.floats(-6, 6))


@given(POINTS, st.floats(0.5, 3.0), st.floats(0.01, 0.5))
def test_all_ground_of_a_piece_is_nearest_to_the_centre_of_its_place(middles, apart_m, radius_m):
    centres = place_centres(middles, apart_m)
    places = places_of(middles, centres, radius_m)
    around = np.linspace(0, 2 * np.pi, 12)
    rim = radius_m * np.stack([np.cos(around), np.sin(around)], axis=-1)
    for middle, place in zip(middles, places, strict=True):
        to_centres = np.linalg.norm((middle + rim)[:, None] - centres, axis=-1)
        if place >= 0:
            assert (to_centres.min(axis=1) >= to_centres[:, place] - 1e-9).all()
        else:  # its circle does cross a border
            nearest = np.linalg.norm(middle - centres, axis=-1).argmin()
            others = np.delete(centres, nearest, axis=0)
            gap = np.linalg.norm(others - centres[nearest], axis=-1)
            squares = ((middle - others) ** 2).sum(axis=1)
            squares -= ((middle - centres[nearest]) ** 2).sum()
            assert (squares / (2 * gap)).min() < radius_m + 1e-9


@given(POINTS, st.floats(0.5, 3.0))
def test_centres_are_apart_and_near_all(middles, apart_m):
    centres = place_centres(middles, apart_m)
    between = np.linalg.norm(centres[:, None] - centres, axis=-1)
    assert (between[~np.eye(len(centres), dtype=bool)] >= apart_m).all()
    assert (np.linalg.norm(middles[:, None] - centres, axis=-1).min(axis=1) < apart_m).all()
