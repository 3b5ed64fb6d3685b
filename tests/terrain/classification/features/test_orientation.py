"""Directions as bytes against the arctangent of every pixel."""

import numpy as np
import pytest

from terrain.classification.features import orientation
from terrain.classification.features.orientation import approximate_is_close, half_turn_bytes


def by_arctangent(across, down):
    """Modulo half a turn; what is half a turn, is none."""
    angle = np.arctan2(down, across)
    half = np.float32(np.pi)
    angle = np.where(angle == half, np.float32(0), angle)
    angle = np.where(angle < 0, angle + half, angle)
    return np.clip(np.rint(angle * np.float32(255 / np.pi)), 0, 255).astype(np.uint8)


@pytest.fixture(params=["approximate", "exact"])
def _way(request, monkeypatch):
    if request.param == "exact":
        monkeypatch.setattr(orientation, "approximate_is_close", lambda: False)


def test_opencv_is_close_enough_here():
    assert approximate_is_close()


@pytest.mark.usefixtures("_way")
def test_every_direction_and_size(rng):
    angles = rng.uniform(-np.pi, np.pi, (400, 500))
    sizes = 10 ** rng.uniform(-4, 3, angles.shape)
    across, down = (sizes * of(angles) for of in (np.cos, np.sin))
    across, down = across.astype(np.float32), down.astype(np.float32)
    found = half_turn_bytes(across, down)
    np.testing.assert_array_equal(found, by_arctangent(across, down))
    assert np.unique(found).size == 256


@pytest.mark.usefixtures("_way")
def test_edges_of_bytes():
    """Directions as near to the edge between two bytes as single precision has them."""
    edges = (np.arange(-255, 255) + 0.5)[:, None] + np.linspace(-0.04, 0.04, 81)
    across, down = (of(edges * np.pi / 255).astype(np.float32) for of in (np.cos, np.sin))
    np.testing.assert_array_equal(half_turn_bytes(across, down), by_arctangent(across, down))


@pytest.mark.usefixtures("_way")
def test_zeros_axes_and_numbers_hardly_above_zero():
    values = np.array([0, -0.0, 1, -1, 1e-20, -1e-20, 1e-45, -1e-45, 1e15, -1e15], np.float32)
    across, down = np.meshgrid(values, values)
    found = half_turn_bytes(across, down)
    np.testing.assert_array_equal(found, by_arctangent(across, down))
    assert found[values == 1, values == 1] == 64  # 45 degrees
    assert not found[:, values == 1][values == 0].any()
