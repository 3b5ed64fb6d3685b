"""Sources of terrain, one interface: camera, the run's own labels, motion, feel, or none."""

from pathlib import Path

from odometry.errors import ConfigError, ParameterError, RunFolderError
from odometry.feel.labels.felt import SILENT
from odometry.feel.labels.follow import Felt, follow_feel
from odometry.feel.labels.live_run import follow_feel_live
from odometry.feel.model import FeelModel
from odometry.feel.model_file import read_feel_model
from odometry.modes.follow.answers import named_modes
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set import NO_MODES, ModeSet
from odometry.modes.models.mode_set_file import read_mode_set
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.parameters import ParameterSet
from odometry.recording.run import UNKNOWN, UNNAMED_TERRAIN, Run
from odometry.replays.pipeline import ConstantTerrain, TerrainSource
from odometry.replays.terrain_sources import NamedTerrain, labelled_terrain
from terrain.camera.camera import Camera
from terrain.classification.answer import Classifier
from terrain.config import Config
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.feel_labels import FeelLabels

SOURCES = ("camera", "labels", "modes", "feel", "none")
BOTH = "camera and feel"
OWN_SOURCE = "a source of your own"
SOURCE_WORDS = {
    "camera": "the camera",
    "labels": "the run's own labels (the column `terrain`)",
    "modes": "the motion (the set of modes)",
    "feel": "what the robot feels (the model of `identify-feel`)",
    BOTH: "the camera and what the robot feels",
    OWN_SOURCE: OWN_SOURCE,
}


def source_name(
    source: str | None, *, vision: bool, has_model: bool, has_feel: bool = False
) -> str:
    """Which source is meant: by default the camera where it has a model, else feel, else none.

    Raises
    ------
    ConfigError
        If there is no such source, or it contradicts `vision`.
    """
    if source is None:
        without = "feel" if has_feel else "none"
        return "camera" if vision and has_model else without
    if source not in SOURCES:
        raise ConfigError(f"terrain source {source!r} is not one of {', '.join(SOURCES)}")
    if source == "camera" and not vision:
        raise ConfigError("the terrain source 'camera' needs vision, which was turned off")
    return source


def initial_terrain(named: str | None, parameters: ParameterSet, of_run: str | None = None) -> str:
    """The terrain in force until the first switch.

    The one that was named; else the run's own where `parameters` has it, else the only one of
    `parameters`, else the run's own, else ``unknown`` where `parameters` has several.

    Raises
    ------
    ParameterError
        If the reserved name was named.
    """
    if named == UNKNOWN:
        raise ParameterError(f"the terrain name {UNKNOWN!r} is reserved; name another, or none")
    own = None if of_run == UNKNOWN else of_run
    known = tuple(parameters.terrains)
    of_set = own if own in known else known[0] if len(known) == 1 else None
    return named or of_set or own or (UNKNOWN if known else UNNAMED_TERRAIN)


def terrain_source(
    run: Run,
    name: str,
    config: Config,
    *,
    initial: str,
    terrain: str | None = None,
    model: Classifier | None = None,
    modes: ModeSet | str | Path | None = None,
    feel: FeelModel | str | Path | None = None,
    show_progress: bool = False,
) -> TerrainSource:
    """Make a source of terrain for a run.

    Parameters
    ----------
    run : Run
    name : str
        "camera": `model` reads the images. "labels": the column `terrain` of truth.csv or
        odometry.csv. "modes": the interacting multiple model estimator, from `modes`. "none":
        one terrain for the whole run.
    config : Config
    initial : str
        In force until the first switch; of labels only where `terrain` says so too, of images,
        modes and feel where `terrain` or the run does: else a wrong start would mislead the
        gyroscope's bias, and the terrain is `unknown` until one of them supports one.
    terrain : str, optional
        What the user named.
    model : Classifier, optional
    modes : ModeSet or path, optional
    feel : FeelModel or path, optional
        The terrain by feel, for the source "feel", and beside the camera.
    show_progress : bool

    Raises
    ------
    OdometryError
        If the run, or what was given, lacks what the source needs.
    """
    if name == "labels":
        return labelled_terrain(run, terrain)
    first = initial if terrain is not None or run.terrain == initial else UNKNOWN
    if name == "camera":
        if model is None:
            raise ConfigError("the terrain source 'camera' needs a model (made by `train`)")
        return _watcher(run, model, first, config, feel)
    if name == "feel":
        if feel is None:
            raise ConfigError("the terrain source 'feel' needs a model (`identify-feel`)")
        felt = felt_of(run, feel, causal=config.filter.causal)
        return NamedTerrain.of_answers(
            first, felt.stamps_s, felt.lasting_answers, (*SILENT, UNKNOWN)
        )
    if name == "modes":
        if modes is None:
            raise ConfigError("the terrain source 'modes' needs a set of modes (`identify-modes`)")
        return moved_terrain(run, modes, first, show_progress=show_progress)
    return ConstantTerrain(initial)


def moved_terrain(
    run: Run, modes: ModeSet | str | Path, initial: str, *, show_progress: bool = False
) -> NamedTerrain:
    """What the motion names."""
    mode_set = modes if isinstance(modes, ModeSet) else read_mode_set(Path(modes))
    return felt_terrain(run, mode_set, initial, show_progress=show_progress)


def felt_of(run: Run, feel: FeelModel | str | Path, *, causal: bool) -> Felt:
    """What the run feels like; `causal` as in `IcrEkfConfig`."""
    model = feel if isinstance(feel, FeelModel) else read_feel_model(feel)
    return follow_feel_live(run, model) if causal else follow_feel(run, model)


def _watcher(
    run: Run,
    model: Classifier,
    initial: str,
    config: Config,
    feel: FeelModel | str | Path | None,
) -> TerrainWatcher:
    if run.images is None or "camera" not in run.settings:
        raise RunFolderError(
            f"{run.folder}: a model was given, but the run has no "
            f"{'images.csv' if run.images is None else '[camera] in run.toml'}; "
            "a model (--model) reads images: leave it out, or turn vision off (--no-vision)"
        )
    from terrain.classification.own_statistics import used_as  # noqa: PLC0415 - slow to load

    if feel is not None:
        check_weighed(config)
    camera = Camera.from_table(run.settings["camera"], str(run.folder / "run.toml"))
    names = tuple(map(str, model.classes_))
    felt = (
        None
        if feel is None
        else FeelLabels.of(felt_of(run, feel, causal=config.filter.causal), names)
    )
    return TerrainWatcher(
        run.robot,
        camera,
        used_as(model, config.classifier),
        initial,
        region=config.region,
        switch=config.switch,
        folder=run.folder,
        felt=felt,
    )


def check_weighed(config: Config) -> None:
    """Raise ConfigError where labels are counted, and feel cannot be weighed with them."""
    if config.switch.labels_in_row:
        raise ConfigError(
            f"[switch] labels_in_row = {config.switch.labels_in_row} counts labels of the camera; "
            "feel is weighed by probabilities: expected 0"
        )


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
    return NamedTerrain.of_answers(initial, track.stamps_s, answers, (*NO_MODES, UNKNOWN))
