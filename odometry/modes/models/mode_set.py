"""A set of modes and how long each lasts, as TOML."""

from dataclasses import dataclass

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes
from odometry.recording.run import UNKNOWN

UNDETERMINED, NONE_OF_THESE = "undetermined", "none of these"
NO_MODES = (NONE_OF_THESE, UNDETERMINED)  # answers that name none
DWELL_S = 20.0  # of a mode without a stated one


@dataclass(frozen=True)
class ModeSet:
    """Modes of one kind.

    Attributes
    ----------
    modes : VelocityModes or TractionModes
    dwell_s : (M,)
        Mean time in each mode [s].
    source : str
        Where the numbers come from.

    Raises
    ------
    ParameterError
        If a mode has the name of an answer that names none, or of a terrain that is not known.

    Examples
    --------
    >>> import odometry
    >>> modes = odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml")
    >>> modes.names, modes.dwell_s.tolist()
    (('grass', 'gravel'), [20.0, 20.0])
    """

    modes: VelocityModes | TractionModes
    dwell_s: FloatArray
    source: str = ""

    def __post_init__(self) -> None:
        reserved = (*NO_MODES, UNKNOWN)
        for name in set(self.modes.names) & set(reserved):
            raise ParameterError(
                f"a mode of the name {name!r}, expected none of the reserved names "
                f"{', '.join(map(repr, reserved))}"
            )

    @property
    def names(self) -> tuple[str, ...]:
        """Of the modes."""
        return self.modes.names
