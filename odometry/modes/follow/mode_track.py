"""What following the modes of a run gives at each stamp."""

from dataclasses import dataclass, field

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.modes.checks.between_modes import BetweenModes
from odometry.modes.checks.gain_check import GainCheck
from odometry.modes.checks.travel_check import TravelCheck
from odometry.modes.follow.gyroscope_bias import GyroscopeTrust
from odometry.modes.models.innovation_test import ModeFit
from odometry.modes.modes_config import ModesConfig


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
        Whether the gyroscope can be used; None: it is taken as sound.
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
    contradicted : (N,) or None
        Where the most probable mode was contradicted not long ago; without it nowhere.
    gain : GainCheck or None
        Where the robot turns more or less than the most probable mode does; without it nowhere.
    centre : (N,) or None
        Where the robot turns about another point than the most probable mode; else nowhere.
    drifts : (N,) or None
        Where the robot drifts in one direction of the world; without it nowhere.
    scatter : (N,) or None
        How many times as far poses scatter as in the runs of identification; NaN: undetermined.
    felt : (N, M) or None
        Probability of each mode by feel alone; None without a model of feel.
    blocked : (N,) or None
        Where the treads turn on the spot and the robot does not; without it nowhere.
    config : ModesConfig
        By which it was followed, and is answered but for `sure`.

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
    contradicted: BoolArray | None = None
    gain: GainCheck | None = None
    centre: BoolArray | None = None
    drifts: BoolArray | None = None
    scatter: FloatArray | None = None
    felt: FloatArray | None = None
    blocked: BoolArray | None = None
    config: ModesConfig = field(default_factory=ModesConfig)
