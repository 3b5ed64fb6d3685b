"""A case before its sensors."""

from dataclasses import dataclass
from typing import Any

from tests.blind.motion import Motion
from tests.blind.robot import Body


@dataclass(frozen=True, eq=False)
class Drawn:
    """A robot and its three motions; the rest is as in `cases.Case`.

    Attributes
    ----------
    body : Body
    motions : dict
        calibration, measured and holdout: (motion, the effects in it by name).
    """

    body: Body
    motions: dict[str, tuple[Motion, dict[str, Any]]]
    effects: tuple[str, ...]
    truth: dict[str, Any]
    acceptable: tuple[str, ...] = ()
