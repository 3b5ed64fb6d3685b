"""What following the modes of a run gives at each stamp, and the settings of it."""

from dataclasses import dataclass

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.config import require, require_positive
from odometry.modes.between_modes import BetweenModes
from odometry.modes.gyroscope_trust import GyroscopeTrust
from odometry.modes.innovation_test import ModeFit
from odometry.modes.travel_check import TravelCheck


@dataclass(frozen=True)
class ModesConfig:
    """Settings of the estimator and of its answers.

    Attributes
    ----------
    floor : float
        Least probability of a mode.
    sure : float
        The probability from which a mode is named; below it the answer is "undetermined".
    lasting_s : float
        A disagreement of camera and feel that lasts so long is reported.
    misfit_share : float
        Share of the time in which no mode of the set fits, before anything was measured.
    """

    floor: float = 1e-6
    sure: float = 0.9
    lasting_s: float = 2.0
    misfit_share: float = 0.05

    def __post_init__(self) -> None:
        require(0 <= self.floor < 0.5, f"floor = {self.floor}, expected 0 to below 0.5")
        require(0.5 < self.sure < 1, f"sure = {self.sure}, expected above 0.5 and below 1")
        require_positive(self, "lasting_s")
        require(
            0 < self.misfit_share < 0.5,
            f"misfit_share = {self.misfit_share}, expected above 0 and below 0.5",
        )


@dataclass(frozen=True)
class ModeTrack:
    """Beliefs at the N stamps of a run.

    Attributes
    ----------
    names : tuple of str
        Of the M modes.
    stamps_s : (N,)
    probabilities : (N, M)
        Of each mode, from what was measured up to the stamp.
    means, sigmas : (N, n)
        State over all modes, and its standard deviations. Errors of models that last are in
        these: what filters take for noise of each measurement would average out.
    normalised_squared : (N,)
        Squared normalised innovation of the most probable mode, divided by how many entries were
        measured: 1 on average; NaN where nothing was.
    labels : (N,) of str
        What the run names; "unknown" where it names nothing.
    fit : ModeFit or None
        Whether a mode fits at all; without it one is taken to.
    gyroscope : GyroscopeTrust or None
        Whether the gyroscope can be trusted; without it it is.
    alike : (N, M) or None
        Modes that the drive does not distinguish from the most probable one; None: not tested.
    turns_are_off : (N,) or None
        Where turns to one side or to both contradict the most probable mode; without it nowhere.
    travel : TravelCheck or None
        Modes that travel by another distance than was measured; without it none do.
    between : BetweenModes or None
        Where the robot turns by more than one mode and by less than the next; without it nowhere.
    headings_disagree : (N,) or None
        Where gyroscope and headings turn apart by more than distinguishes modes; else nowhere.
    felt : (N, M) or None
        Probability of each mode by feel alone; None without a model of feel.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> modes = odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml")
    >>> track = odometry.follow_modes(run, modes)
    >>> track.names, track.probabilities.shape == (len(track.stamps_s), 2)
    (('grass', 'gravel'), True)
    """

    names: tuple[str, ...]
    stamps_s: FloatArray
    probabilities: FloatArray
    means: FloatArray
    sigmas: FloatArray
    normalised_squared: FloatArray
    labels: AnyArray
    fit: ModeFit | None = None
    gyroscope: GyroscopeTrust | None = None
    alike: BoolArray | None = None
    turns_are_off: BoolArray | None = None
    travel: TravelCheck | None = None
    between: BetweenModes | None = None
    headings_disagree: BoolArray | None = None
    felt: FloatArray | None = None
