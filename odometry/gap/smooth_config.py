"""Settings of smooth functions, which stand where no effect is named, or beside one."""

from dataclasses import dataclass

from odometry.config import require, require_positive

FEWEST = {
    "knots": 2,
    "even_knots": 2,
    "tread_knots": 1,
    "further_nodes": 2,
    "axis_nodes": 2,
    "promising_further": 1,
    "tries_further": 1,
}


@dataclass(frozen=True)
class SmoothConfig:
    """Which smooth functions of recorded variables are fitted, and how fine they are.

    Attributes
    ----------
    promising, promising_in_place : int
        Smooth functions that are fitted in full where one is asked for: in full, those that leave
        least to first order seldom change their order. In the place of a name more are: what is
        large is far from its first order, and the fourth was the true one.
    promising_further : int
        The same where nothing has a name, and functions that are no rivals of names are tried, too.
    tries_further : int
        How often they are searched, each time without the variable that did not hold on held-out
        data: each try may hold by chance in one of forty cases.
    beyond_first_order : float
        Share of what a name closes by which a smooth function may leave more to first order, and
        is fitted in its place all the same: the true one left 0.18 more, and 0.16 less in full.
    least_range : float
        Range of a variable, in its unit, below which it explains nothing: less is rounding.
    knots, tread_knots, even_knots : int
        Of a smooth function; of that of a tread's own motion, to each side of zero; and of one
        whose knots are even in its variable.
    nodes : tuple of int
        Of maps of what follows the place, at most; one grid of each number.
    further_nodes, axis_nodes : int
        Of a map where nothing has a name, and of a function of x or of y alone: furrows, waves of
        the terrain and the grid of a map are some metres long.
    least_spacing_m : float
        Between nodes: positions of a reference are off by some centimetres.
    least_revisited : float
        Share of the samples at places to which the robot comes back, which a map needs.
    most_smooth : int
        Smooth functions where no name is accepted.
    """

    promising: int = 2
    promising_in_place: int = 4
    promising_further: int = 6
    tries_further: int = 3
    beyond_first_order: float = 0.25
    least_range: float = 1e-3
    knots: int = 5
    tread_knots: int = 4
    even_knots: int = 9
    nodes: tuple[int, ...] = (16, 40)
    further_nodes: int = 100
    axis_nodes: int = 40
    least_spacing_m: float = 0.3
    least_revisited: float = 0.25
    most_smooth: int = 4

    def __post_init__(self) -> None:
        require_positive(self, "least_spacing_m")
        share = self.beyond_first_order
        require(0 <= share < 1, f"beyond_first_order = {share}, expected 0 to 1")
        require(min(self.nodes) >= 2, f"nodes = {self.nodes}, expected 2 or more each")
        for name, least in FEWEST.items():
            count = getattr(self, name)
            require(count >= least, f"{name} = {count}, expected {least} or more")
