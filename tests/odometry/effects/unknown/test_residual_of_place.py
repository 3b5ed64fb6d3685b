"""A map of what follows the place."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from odometry.effects.catalogue import added_effects, effect_table
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs

GRID = tuple((i, j) for i in range(-2, 3) for j in range(-1, 3))


@pytest.fixture
def positions_m(rng):
    """Within the grid of 0.5 m."""
    return rng.uniform([-1.0, -0.5], [1.0, 1.0], (50, 2))


def test_between_nodes_it_is_bilinear(positions_m, rng):
    effect = ResidualOfPlace(spacing_m=0.5, nodes=GRID)
    values = rng.normal(size=len(GRID))
    axes = 0.5 * np.arange(-2, 3), 0.5 * np.arange(-1, 3)
    oracle = RegularGridInterpolator(axes, values.reshape(5, 4))
    np.testing.assert_allclose(effect.hats(positions_m) @ values, oracle(positions_m), atol=1e-14)


def test_far_from_every_node_it_adds_nothing():
    effect = ResidualOfPlace(spacing_m=0.5, nodes=((0, 0), (4, 4)))
    np.testing.assert_array_equal(effect.hats(np.array([[0.5, 0.0], [1.0, 1.0]])), 0.0)


def test_along_one_axis_the_other_coordinate_does_nothing(positions_m):
    nodes = tuple((0, j) for j in range(-1, 3))
    effect = ResidualOfPlace(spacing_m=0.5, nodes=nodes, axis="y", terms=(("v_x", 0),))
    hats = effect.hats(positions_m)
    knots = [-0.5, 0.0, 0.5, 1.0]
    oracle = [np.interp(positions_m[:, 1], knots, row) for row in np.eye(4)]
    np.testing.assert_allclose(hats, np.transpose(oracle), atol=1e-14)
    (read,) = added_effects([effect_table(Added(effect, np.array([0.1])))], "set")
    assert read.effect == effect
    assert effect.key != replace(effect, axis="").key
    with pytest.raises(ParameterError, match="axis = 'z', expected one of x, y"):
        replace(effect, axis="z")


def test_it_adds_a_share_of_the_forward_speed_where_the_robot_is(bench, rng, positions_m):
    inputs = replace(bench.drive(rng).rows(slice(50)), position_m=positions_m)
    twist = bench.base.model.twist(bench.base.values, inputs)
    terms = tuple(("v_x", k) for k in range(len(GRID)))
    effect = ResidualOfPlace(terms=terms, by="v_x", spacing_m=0.5, nodes=GRID)
    everywhere = effect.twist(np.full(len(GRID), -0.3), twist, inputs, bench.base)
    np.testing.assert_allclose(everywhere, twist * [0.7, 1.0, 1.0], atol=1e-14)
    one = np.zeros(len(GRID))
    one[7] = -0.3
    changed = effect.twist(one, twist, inputs, bench.base)[:, 0] / twist[:, 0]
    np.testing.assert_allclose(changed, 1 - 0.3 * effect.hats(positions_m)[:, 7], atol=1e-12)


def test_a_parameter_set_gives_it_back():
    terms = (("world_x", 0), ("world_y", 1))
    effect = ResidualOfPlace(terms=terms, spacing_m=0.75, nodes=((0, 0), (-3, 2)), spread=0.2)
    table = effect_table(Added(effect, np.array([0.1, -0.2])))
    (read,) = added_effects([table], "set")
    assert read.effect == effect
    np.testing.assert_array_equal(read.values, [0.1, -0.2])


def test_without_positions_it_says_so():
    plain, effect = Inputs(np.zeros((2, 2))), ResidualOfPlace(terms=(("v_x", 0),), nodes=((0, 0),))
    assert effect.lacks(plain, None) == "place"
    with pytest.raises(ParameterError, match="no positions were measured"):
        effect.twist(np.zeros(1), np.zeros((2, 3)), plain, None)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"terms": (("v_x", 1),)}, "a number below 1"),
        ({"terms": (("v_z", 0),)}, "expected one of v_x"),
        ({"terms": (("v_x",),)}, "has a term"),
        ({"spacing_m": 0.0}, "expected more than 0"),
        ({"variable": "heading"}, "expected 'place'"),
        ({"by": "v_y"}, "expected one of speed"),
        ({"spread": -1.0}, "expected more than 0"),
        ({"nodes": ((0.5, 1),)}, "expected pairs of whole numbers"),
        ({"nodes": ((0,),)}, "expected pairs of whole numbers"),
        ({"nodes": "ab"}, "expected pairs of whole numbers"),
    ],
)
def test_a_wrong_setting_is_an_error(settings, said):
    with pytest.raises(ParameterError, match=said):
        ResidualOfPlace(**{"nodes": ((0, 0),), **settings})


def test_a_finer_map_is_another():
    coarse, fine = (ResidualOfPlace(spacing_m=of, nodes=((0, 0),)) for of in (1.0, 0.5))
    assert coarse.key != fine.key
