"""The map of what follows the place."""

from dataclasses import replace

import numpy as np

from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.gap.answer.result import NamedEffect
from odometry.report.gap.gap_places import NEAR, map_of
from odometry.report.gap.gap_shapes import shape_pictures

NODES = ((0, 0), (1, 0), (0, 1), (1, 1))


def test_a_map_is_bilinear_where_the_robot_was_and_nothing_elsewhere():
    effect = ResidualOfPlace(
        terms=tuple(("v_x", k) for k in range(4)), by="v_x", spacing_m=2.0, nodes=NODES
    )
    edges = np.linspace(0.0, 2.0, 5)
    here = np.array([[0.25, 0.25]])
    (values,) = map_of(effect, np.array([0.0, 1.0, 2.0, 3.0]), here, (edges, edges)).values()
    x, y = np.meshgrid(edges[:-1] + 0.25, edges[:-1] + 0.25)
    near = np.hypot(x - 0.25, y - 0.25) <= 2.0 * NEAR
    np.testing.assert_allclose(values[near], (x / 2 + y)[near], atol=1e-12)
    assert np.isnan(values[~near]).all()
    assert not near.all()


def test_a_map_of_two_treads_is_drawn(scaled_result, tmp_path):
    terms = tuple((side, k) for side in ("left", "right") for k in range(4))
    effect = ResidualOfPlace(terms=terms, by="speed", spacing_m=5.0, nodes=NODES)
    values = np.linspace(-0.3, 0.2, 8)
    named = NamedEffect(Added(effect, values), values - 0.1, values + 0.1, 0.2, 0.1, 50.0)
    (picture,) = shape_pictures(replace(scaled_result, effects=(named,)), tmp_path)
    assert picture.file.name == "gap_shape_1.png"
    assert picture.file.stat().st_size > 5000
    assert "5 m apart" in picture.caption
