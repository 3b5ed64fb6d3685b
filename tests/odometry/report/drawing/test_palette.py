"""Colours: distinguished by readers with any of the three kinds of colour blindness."""

from itertools import combinations

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from odometry.report.drawing.figure import (
    LINE_STYLES,
    REFERENCE_STYLE,
    TERRAIN_TINTS,
    line_styles,
    terrain_colours,
)

# Machado, Oliveira and Fernandes 2009, Table 1, severity 1.0: on linear RGB
SIGHT = {
    "protan": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deutan": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritan": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}


def linear(colour):
    rgb = np.array(to_rgb(colour))
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE L*a*b* of linear sRGB under D65."""
    to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    xyz = np.clip(to_xyz @ rgb, 0, None) / [0.9505, 1.0, 1.089]
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def contrast_to_white(colour):
    """WCAG 2 contrast ratio."""
    return 1.05 / (linear(colour) @ [0.2126, 0.7152, 0.0722] + 0.05)


@pytest.mark.parametrize("sight", SIGHT)
def test_the_first_terrains_differ_for_every_eye(sight):
    seen = [lab(np.clip(np.array(SIGHT[sight]) @ linear(c), 0, 1)) for c in TERRAIN_TINTS[:4]]
    apart = [np.linalg.norm(a - b) for a, b in combinations(seen, 2)]
    assert min(apart) > 10  # 2.3 is just noticeable


def test_names_in_the_colour_of_a_line_are_readable_on_white():
    assert min(contrast_to_white(style.colour) for style in LINE_STYLES) > 3.0


def test_names_on_a_tint_are_readable_in_black():
    assert max(contrast_to_white(tint) for tint in TERRAIN_TINTS) < 21 / 4.5


def test_lines_differ_in_their_dashes_too():
    assert len({style.dashes for style in LINE_STYLES}) == len(LINE_STYLES)
    assert REFERENCE_STYLE.width_pt > max(style.width_pt for style in LINE_STYLES)


def test_a_terrain_keeps_its_colour_whatever_the_order():
    once = terrain_colours(["snow", "ice", "", "snow", "unknown"])
    assert once == terrain_colours(["ice", "snow"])
    assert set(once) == {"ice", "snow", "unknown"}
    assert len(set(once.values())) == 3


def test_there_may_be_more_names_than_colours():
    names = [f"{i:02d}" for i in range(20)]
    assert list(terrain_colours(names))[:20] == names
    assert list(line_styles(names)) == names
