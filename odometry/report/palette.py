"""Colours that colour-blind readers can distinguish, the same in every figure of a page."""

from collections.abc import Iterable
from dataclasses import dataclass

from odometry.run import UNKNOWN

# Tints of P. Tol's "light" scheme: black text and dark lines stay readable on them.
TERRAIN_TINTS = (
    "#EEDD88",
    "#44BB99",
    "#99DDFF",
    "#FFAABB",
    "#BBCC33",
    "#77AADD",
    "#EE8866",
    "#AAAA00",
)
UNKNOWN_TINT = "#DDDDDD"


@dataclass(frozen=True)
class LineStyle:
    """Colour, dashes and width of a line: two lines never differ by colour alone."""

    colour: str
    dashes: str | tuple[float, tuple[float, ...]] = "solid"
    width_pt: float = 1.6


REFERENCE_STYLE = LineStyle("#000000", "solid", 2.2)
LINE_STYLES = (
    LineStyle("#0072B2"),
    LineStyle("#D55E00", "dashdot"),
    LineStyle("#00785A", "dotted", 2.0),
    LineStyle("#AA4499", "dashed"),
    LineStyle("#7A5C00", (0.0, (6.0, 1.5, 1.0, 1.5, 1.0, 1.5))),
    LineStyle("#555555", (0.0, (8.0, 2.0))),
    LineStyle("#332288", (0.0, (3.0, 1.0, 1.0, 1.0))),
    LineStyle("#C2185B", (0.0, (5.0, 1.0)), 1.8),
    LineStyle("#5B8E00", (0.0, (1.0, 2.5)), 2.0),
    LineStyle("#00838F", (0.0, (10.0, 2.0, 2.0, 2.0))),
)


def terrain_colours(names: Iterable[str]) -> dict[str, str]:
    """Give each terrain a tint, by the order of the alphabet; `unknown` is grey.

    Parameters
    ----------
    names : iterable of str
        All terrains of a page, so that each keeps its colour over all figures; "" is left out.
    """
    known = sorted({name for name in names if name} - {UNKNOWN})
    tints = {name: TERRAIN_TINTS[i % len(TERRAIN_TINTS)] for i, name in enumerate(known)}
    return tints | {UNKNOWN: UNKNOWN_TINT}


def mode_colours(names: Iterable[str]) -> dict[str, str]:
    """Give each mode a colour, in the order given: dark ones first, then tints."""
    colours = (*(style.colour for style in LINE_STYLES), *TERRAIN_TINTS)
    return {name: colours[i % len(colours)] for i, name in enumerate(names)}


def line_styles(names: Iterable[str]) -> dict[str, LineStyle]:
    """Give each line a style, in the order given; after the last style the first comes again."""
    return {name: LINE_STYLES[i % len(LINE_STYLES)] for i, name in enumerate(names)}
