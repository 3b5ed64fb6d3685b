"""A run whose modes were followed, by motion alone and with the camera, its scores and misfits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.feel.model import FeelModel
from odometry.modes.follow.answers import candidates, disagreements, named_modes
from odometry.modes.follow.camera_prior import SeenTerrain, seen_labels
from odometry.modes.follow.detection import Score, score_of
from odometry.modes.follow.feel_source import feel_source, with_feel
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.follow.track import follow_signals, judged_signals
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED, ModeSet
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from odometry.recording.run import UNKNOWN, Run

BOUND = 2.0  # standard deviations: 95 % of what is left of a mode that is true

MOTION, MOTION_AND_FEEL, MOTION_AND_CAMERA = "motion alone", "motion and feel", "motion and camera"


@dataclass(frozen=True)
class Misfit:
    """A stretch in which no mode of the set fits.

    Attributes
    ----------
    from_s, to_s : float
        From the last stamp before at which all of the nearest mode was within BOUND.
    signal : int
        Place of the measured entry that fits least.
    sigmas : float
        Root mean square of what is left of it in a window where the nearest mode is taken: 1 where
        that mode is true.
    """

    from_s: float
    to_s: float
    signal: int
    sigmas: float


def misfits(track: ModeTrack, sure: float) -> tuple[Misfit, ...]:
    """The stretches in which the answer of the rolling test is "none of these"."""
    if track.fit is None:
        return ()
    none, best = track.fit.none, track.fit.best
    rows = np.flatnonzero(none >= sure)
    fitted = np.flatnonzero(none < 1 - sure)
    quiet = np.flatnonzero(~(np.abs(best) > BOUND).any(axis=1))
    found: list[Misfit] = []
    # stretches between which a mode was not as probable as ever are one
    cuts = np.flatnonzero(np.diff(np.searchsorted(fitted, rows))) + 1
    for stretch in np.split(rows, cuts) if len(rows) else []:
        before = np.searchsorted(quiet, stretch[0])
        first = int(quiet[before - 1]) if before else 0
        squares = best[first : stretch[-1] + 1] ** 2
        measured = np.isfinite(squares).any(axis=0)
        sizes = np.full(best.shape[1], -1.0)
        sizes[measured] = np.sqrt(np.nanmean(squares[:, measured], axis=0))
        signal = int(sizes.argmax())
        begin, end = track.stamps_s[[first, stretch[-1]]].tolist()
        found.append(Misfit(begin, end, signal, float(sizes[signal])))
    return tuple(found)


@dataclass(frozen=True)
class Followed:
    """What `follow_modes` made of a run.

    Attributes
    ----------
    run : Run
    mode_set : ModeSet
    config : ModesConfig
    signals : Signals
        That the filters were fed with.
    motion : ModeTrack
        By motion alone.
    with_camera : ModeTrack or None
        By motion and camera, and feel where there is a model of it; None without images.
    seen : tuple of SeenTerrain
    with_feel : ModeTrack or None
        By motion and feel; None without a model of feel.
    """

    run: Run
    mode_set: ModeSet
    config: ModesConfig
    signals: Signals
    motion: ModeTrack
    with_camera: ModeTrack | None = None
    seen: tuple[SeenTerrain, ...] = ()
    with_feel: ModeTrack | None = None

    @property
    def tracks(self) -> Mapping[str, ModeTrack]:
        """By name, MOTION first; the others where there was feel or a camera."""
        every = {
            MOTION: self.motion,
            MOTION_AND_FEEL: self.with_feel,
            MOTION_AND_CAMERA: self.with_camera,
        }
        return {name: track for name, track in every.items() if track is not None}

    @property
    def last_track(self) -> ModeTrack:
        """The one that uses all there is."""
        return self.with_camera or self.with_feel or self.motion

    @property
    def seen_labels(self) -> AnyArray:
        """The terrain (N,) under the robot by the camera; "unknown" where there is no label."""
        return seen_labels(self.seen, self.motion.stamps_s)

    @property
    def disagreements(self) -> tuple[tuple[float, float, str, str], ...]:
        """Lasting ones of camera and motion: from, to [s], terrain by camera, mode by motion."""
        config = self.config
        return disagreements(self.motion, self.seen_labels, config.sure, config.lasting_s)

    @property
    def compared_s(self) -> float:
        """For how long camera and motion both name a mode [s]."""
        both = ~np.isin(self.answers(self.motion), NO_MODES) & (self.seen_labels != UNKNOWN)
        return float(_lasts_s(self.motion) @ both)

    @property
    def unfit_while_seen(self) -> tuple[float, tuple[str, ...]]:
        """For how long no mode fits the motion while the camera names one [s], and which."""
        unfit = (self.answers(self.motion) == NONE_OF_THESE) & (self.seen_labels != UNKNOWN)
        names = tuple(sorted(set(self.seen_labels[unfit].tolist())))
        return float(_lasts_s(self.motion) @ unfit), names

    @property
    def foreign_labels(self) -> tuple[str, ...]:
        """Terrains of the run that are no mode: answers on them are not scored."""
        return tuple(sorted(set(self.motion.labels.tolist()) - {UNKNOWN, *self.mode_set.names}))

    @property
    def misfits(self) -> tuple[Misfit, ...]:
        """Stretches in which no mode fits the motion."""
        return misfits(self.motion, self.config.sure)

    def answers(self, track: ModeTrack) -> AnyArray:
        """The mode (N,) named at each stamp, or one of NO_MODES."""
        return named_modes(track, self.config.sure)

    def shares(self, track: ModeTrack) -> dict[str, float]:
        """Share of the time of each answer that was given, the longest first."""
        answers, lasts_s = self.answers(track), _lasts_s(track)
        whole = max(float(lasts_s.sum()), 1e-12)
        held = {
            name: float(lasts_s[answers == name].sum()) / whole
            for name in (*self.mode_set.names, *NO_MODES)
        }
        return dict(sorted(((n, s) for n, s in held.items() if s > 0), key=lambda one: -one[1]))

    def doubtful(self, track: ModeTrack) -> float:
        """Share of the time in which a mode is probable enough, and is not named for its fit."""
        sure = track.probabilities.max(axis=1) >= self.config.sure
        open_ = self.answers(track) == UNDETERMINED
        lasts_s = _lasts_s(track)
        return float(lasts_s @ (sure & open_)) / max(float(lasts_s.sum()), 1e-12)

    def candidates(self, track: ModeTrack) -> AnyArray:
        """Names (N,) of the fewest modes that it may be at each stamp, with " or " between.

        "none of these" where that is the answer.
        """
        sets, places = self._candidate_sets(track)
        words = np.array([" or ".join(names) for names in sets], dtype=object)[places]
        return np.where(self.answers(track) == NONE_OF_THESE, NONE_OF_THESE, words)

    def left_open(self, track: ModeTrack) -> dict[tuple[str, ...], float]:
        """Share of the undetermined time of each set of modes it may be, the longest first."""
        sets, places = self._candidate_sets(track)
        undetermined = self.answers(track) == UNDETERMINED
        lasts_s = _lasts_s(track) * undetermined
        held_s = np.bincount(places, weights=lasts_s)
        longest = [place for place in np.argsort(-held_s, kind="stable") if held_s[place] > 0]
        return {sets[place]: float(held_s[place] / held_s.sum()) for place in longest}

    def _candidate_sets(self, track: ModeTrack) -> tuple[list[tuple[str, ...]], IntArray]:
        """The sets of modes that it may be, and the place (N,) of each stamp's among them."""
        chosen = candidates(track, self.config.sure)
        sets, places = np.unique(chosen, axis=0, return_inverse=True)
        names = np.array(track.names)
        return [tuple(names[one].tolist()) for one in sets], places.ravel()

    def score(self, track: ModeTrack) -> Score:
        """Answers of a track against the modes that the run names."""
        return score_of(track, self.config.sure)


def _lasts_s(track: ModeTrack) -> FloatArray:
    """How long (N,) each stamp lasts [s]; the last not at all."""
    return np.append(np.diff(track.stamps_s), 0.0)


def followed(
    run: Run,
    mode_set: ModeSet,
    config: ModesConfig | None = None,
    seen: Sequence[SeenTerrain] = (),
    *,
    feel: FeelModel | None = None,
    show_progress: bool = False,
) -> Followed:
    """Follow a run by motion alone, and with feel and camera where there is a model and labels.

    See `follow_modes`.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> modes = odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml")
    >>> found = odometry.followed(run, modes)
    >>> sorted(set(found.answers(found.motion).tolist()))
    ['grass', 'gravel', 'undetermined']
    """
    config = config or ModesConfig()
    signals = judged_signals(run, mode_set)
    motion = follow_signals(signals, mode_set, config, show_progress=show_progress)
    by_feel = by_camera = None
    if seen:
        by_camera = follow_signals(signals, mode_set, config, seen, show_progress=show_progress)
    if feel is not None:
        source = feel_source(run, feel, mode_set.names, mode_set.dwell_s)
        by_feel, by_camera = (
            None if track is None else with_feel(track, source, mode_set.dwell_s, config)
            for track in (motion, by_camera)
        )
    return Followed(run, mode_set, config, signals, motion, by_camera, tuple(seen), by_feel)
