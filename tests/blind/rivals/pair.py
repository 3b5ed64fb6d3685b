"""Two hypotheses that one sort of drive does not distinguish."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Pair:
    """Two rivals.

    Attributes
    ----------
    names : (str, str)
        In plain words, families of `tests/studies/gap/gap_names.py`.
    given : str
        The drive that cannot distinguish them: a name of `given.GIVEN`.
    match : callable
        rng, scene, given to (hide, hide): the makers of both.
    gyroscope : bool
        Whether it is recorded; where it alone would distinguish them, it is not.
    """

    names: tuple[str, str]
    given: str
    match: Callable
    gyroscope: bool = True
