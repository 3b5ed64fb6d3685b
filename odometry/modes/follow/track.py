"""Follow the modes of a run."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from tqdm import tqdm

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.checks.track_checks import contradictions
from odometry.modes.follow.camera_prior import SeenTerrain, mode_chains
from odometry.modes.follow.gyroscope_bias import bias_is_open, bias_readings, gyroscope_trust
from odometry.modes.follow.mode_beliefs import ModeBeliefs, ModeEstimators
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.follow.tempered_bank import independent_share, usable_measurements
from odometry.modes.models.innovation_test import Innovations, mode_fit
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from odometry.recording.run import Run
from odometry.windows.recorded.spans import within

__all__ = ["ModeTrack", "ModesConfig", "follow_modes", "follow_signals", "judged_signals"]

SETTLED_S = 1e4  # after which a chain has forgotten where it began


def follow_modes(
    run: Run,
    mode_set: ModeSet,
    config: ModesConfig | None = None,
    seen: Sequence[SeenTerrain] = (),
    *,
    show_progress: bool = False,
) -> ModeTrack:
    """Run the interacting multiple model estimator over a run.

    Parameters
    ----------
    run : Run
    mode_set : ModeSet
    config : ModesConfig, optional
    seen : sequence of SeenTerrain
        What vision saw; without it motion alone decides.
    show_progress : bool

    Raises
    ------
    RunFolderError
        As `judged_signals`.
    ParameterError
        If vision saw what is no mode.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> modes = odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml")
    >>> track = odometry.follow_modes(run, modes)
    >>> len(track.stamps_s)
    1085
    """
    signals = judged_signals(run, mode_set)
    return follow_signals(signals, mode_set, config, seen, show_progress=show_progress)


def judged_signals(run: Run, mode_set: ModeSet) -> Signals:
    """What of a run the filters use, labelled by truth.csv where it names modes: for scoring.

    Raises
    ------
    RunFolderError
        If the run is of a robot of another track width, or lacks what the modes are recognised by.
    """
    of_modes = mode_set.modes.track_width
    if not run.robot.may_have_width(of_modes):  # a set of older versions states none: NaN
        raise RunFolderError(
            f"{run.folder}: a robot of track width {run.robot.track_width:g} m; the modes are of "
            f"one of {of_modes:g} m: how terrain turns one robot says nothing of another"
        )
    signals = mode_set.modes.signals(run)
    if run.truth is None or "terrain" not in run.truth:
        return signals
    rows = np.searchsorted(run.truth.stamps_s, signals.stamps_s, side="right") - 1
    return replace(signals, labels=run.truth["terrain"].astype(object)[np.maximum(rows, 0)])


def follow_signals(
    signals: Signals,
    mode_set: ModeSet,
    config: ModesConfig | None = None,
    seen: Sequence[SeenTerrain] = (),
    *,
    show_progress: bool = False,
) -> ModeTrack:
    """The same over inputs and measurements."""
    config = config or ModesConfig()
    modes, count = mode_set.modes, len(mode_set.names)
    chains = mode_chains(seen, mode_set.names, mode_set.dwell_s)
    in_force = np.searchsorted([one.stamp_s for one in seen], signals.stamps_s, side="right")
    independent = independent_share(signals, modes.errors_last_s)
    transitions = [chain.transition for chain in chains]
    estimators = ModeEstimators(mode_set, transitions, independent, config.floor)
    gap_ends = np.searchsorted(signals.stamps_s, signals.gaps_s[:, 1])
    gap_ends = gap_ends[gap_ends < len(signals)]
    measured = usable_measurements(signals, gap_ends, modes.fastest_m_s)
    roughness, readings = modes.roughness(signals), bias_readings(signals, modes.fastest_m_s)
    size, states = len(signals), modes.model().states
    held = np.append(np.ones(states - 1), independent)  # share of each variance that filters hold
    lasting = np.zeros((count, states))
    lasting[:, :-1] = (1 - independent) * modes.measurement_variance
    probabilities, squared = np.empty((size, count)), np.empty(size)
    means, sigmas = np.empty((2, size, states))
    innovations = np.full((size, count, measured.shape[1]), np.nan)
    first = transitions[in_force[0]](SETTLED_S).mean(axis=0)
    beliefs = ModeBeliefs.at(modes.start(signals, independent), first)
    steps: Iterable[int] = tqdm(range(size), unit="step", disable=None if show_progress else True)
    for row in steps:
        filters = estimators.of(int(in_force[row]), float(roughness[max(row - 1, 0)]))
        if row:
            inputs = signals.tread_speeds_m_s[row - 1], measured[row]
            step_s = float(signals.stamps_s[row] - signals.stamps_s[row - 1])
            beliefs, innovations[row] = filters.step(beliefs, inputs, step_s, readings.get(row))
        if row in gap_ends:  # motion in a gap is no evidence on the modes
            beliefs = filters.begun(beliefs, modes.start(signals.after(row), independent))
        belief, merged = beliefs.together, beliefs.merged
        probabilities[row] = belief.probabilities
        variances = np.diag(merged[1]) / held + probabilities[row] @ lasting
        means[row], sigmas[row] = merged[0], np.sqrt(variances)
        squared[row] = _normalised_squared(belief, measured[row])
    leading = probabilities.argmax(axis=1)
    left = Innovations(innovations, leading, signals.stamps_s, independent)
    # headings that filters measure confirm a bias: no mode alone says that there is one
    open_ = np.zeros(size, dtype=np.bool_)
    if not modes.state_angles:
        open_ = bias_is_open(means[:, -1], readings, config)
    bias = means[:, -1], sigmas[:, -1]
    return ModeTrack(
        mode_set.names,
        signals.stamps_s,
        probabilities,
        means,
        sigmas,
        squared,
        signals.labels,
        mode_fit(left, mode_set.dwell_s, config.misfit_share),
        gyroscope_trust(signals, *bias, open_),
        **contradictions(replace(signals, measured=measured), mode_set, left, bias, config),
        blocked=within(signals.stamps_s, signals.blocked_s),
        config=config,
    )


def _normalised_squared(belief: ModeBelief, measured: FloatArray) -> float:
    """Of the most probable mode by how many entries were measured; NaN where none was."""
    if belief.innovations is None:
        return float("nan")
    of_mode = belief.innovations.normalised_squared[belief.log_probabilities.argmax()]
    return float(of_mode / np.isfinite(measured).sum())
