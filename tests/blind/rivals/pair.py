"""Two hypotheses that a drive of one sort does not tell apart."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Pair:
    """Two rivals.

    Attributes
    ----------
    names : (str, str)
        In plain words, families of `tests/studies/gap_names.py`.
    given : str
        The drive that cannot tell them apart: a name of `given.GIVEN`.
    match : callable
        rng, scene, given to (hide, hide): the makers of both.
    gyroscope : bool
        Whether it is recorded; where it alone would tell them apart, it is not.
    """

    names: tuple[str, str]
    given: str
    match: Callable
    gyroscope: bool = True
