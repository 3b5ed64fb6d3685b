"""The terrain by feel: answers of the interacting multiple model estimator as a source."""

from odometry.errors import ParameterError
from odometry.modes.answers import named_modes
from odometry.modes.mode_set import NO_MODES, ModeSet
from odometry.modes.modes_config import ModesConfig
from odometry.modes.track import follow_modes
from odometry.modes.velocity import VelocityModes
from odometry.run import UNKNOWN, Run
from odometry.run_terrains import NamedTerrain


def felt_terrain(
    run: Run,
    mode_set: ModeSet,
    initial: str,
    config: ModesConfig | None = None,
    *,
    show_progress: bool = False,
) -> NamedTerrain:
    """The terrain by the motion; where it names none, the one in force stays.

    Each answer is made from what was measured up to its stamp.

    Parameters
    ----------
    run : Run
    mode_set : ModeSet
        Of terrains.
    initial : str
        In force until the first answer.
    config : ModesConfig, optional
    show_progress : bool

    Raises
    ------
    ParameterError
        If the modes are those of slipping wheels, which name no terrain.
    RunFolderError
        If the run lacks what the modes are recognised by.
    """
    if not isinstance(mode_set.modes, VelocityModes):
        raise ParameterError(
            f"the modes {', '.join(mode_set.names)} are of kind {mode_set.modes.kind!r}: they say "
            "how wheels slip, not on which terrain; expected a set of kind 'velocity'"
        )
    config = config or ModesConfig()
    track = follow_modes(run, mode_set, config, show_progress=show_progress)
    answers = named_modes(track, config.sure)
    return NamedTerrain.told(initial, track.stamps_s, answers, (*NO_MODES, UNKNOWN))
