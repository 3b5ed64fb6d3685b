"""Which terrain a real robot is on, by its motion alone.

    TERRAIN_ODOMETRY_DATA=... python -m tests.studies.modes.modes_real

Warthog runs on five terrains, joined end to end, and Husky runs with yaw rate and wheels only.
Modes are identified on other runs (Warthog: each run is held out once), or on the other half where
a terrain has one run (Husky). Tables are shares of the time by true terrain (row) and answer.
Traction modes are followed on each Warthog run alone: poses of one do not go on in the next.
"""

import argparse
import csv
import os
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import IdentificationError
from odometry.modes.follow.detection import confusion
from odometry.modes.follow.track import ModesConfig, ModeTrack, follow_modes, follow_signals
from odometry.modes.identify.identify_traction import identify_traction_modes
from odometry.modes.identify.identify_velocity import identify_velocity_modes
from odometry.modes.models.mode_set import DWELL_S, NO_MODES, ModeSet
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import Signals
from odometry.recording.run import Run
from odometry.tables.table import Table

BETWEEN_S = 1.0  # of two runs joined
SURE = ModesConfig().sure
TESTS = (
    "fit",
    "gyroscope",
    "alike",
    "turns_are_off",
    "travel",
    "between",
    "headings_disagree",
    "contradicted",
    "gain",
    "centre",
    "drifts",
)
KINDS: Mapping[str, Mapping[str, bool]] = {
    "model and noise of each terrain": {},
    "a model of each terrain, one noise": {"common_noise": True},
    "one model, noise of each terrain": {"shared": True},
}


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    folder = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "motion"
    warthog, husky = by_terrain(folder, "warthog_"), by_terrain(folder, "husky_borealtc_")
    for models, options in KINDS.items():
        folds = max(map(len, warthog.values()))
        tracks = [
            judged(*left_out(warthog, fold), options=options, name=f"Warthog, fold {fold}")
            for fold in range(folds)
        ]
        print_table(f"Warthog, by held-out run, {models}", [track for track, _ in tracks])
        off = np.concatenate([of for _, of in tracks])
        print(f"yaw rates within two sigma of the state: {(off < 2).mean():.2f}\n")
        halved = {terrain: [halves(run) for run in runs] for terrain, runs in husky.items()}
        tracks = [
            judged(
                [pair[known] for of in halved.values() for pair in of],
                [pair[1 - known] for of in halved.values() for pair in of],
                options=options,
                name="Husky",
            )
            for known in (0, 1)
        ]
        print_table(f"Husky, by halves, {models}", [track for track, _ in tracks])
    by_poses = [
        track
        for fold in range(max(map(len, warthog.values())))
        for track in judged_by_poses(*left_out(warthog, fold))
    ]
    print_table("Warthog, by held-out run, traction modes", by_poses)


def by_terrain(folder: Path, prefix: str) -> dict[str, list[Run]]:
    """Runs whose terrain INDEX.csv names, by terrain."""
    found = defaultdict(list)
    with (folder / "INDEX.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            terrain = row["terrain"].split(" (")[0]
            if row["run"].startswith(prefix) and terrain != "not stated":
                run = Run.read(folder / row["run"])
                found[terrain].append(replace(run, settings={"run": {"terrain": terrain}}))
    return dict(found)


def left_out(runs: dict[str, list[Run]], fold: int) -> tuple[list[Run], list[Run]]:
    """Runs to identify on, and the run of each terrain that this fold holds out."""
    known = [run for of in runs.values() for place, run in enumerate(of) if place != fold]
    return known, [of[fold] for of in runs.values() if fold < len(of)]


def judged(
    known: Sequence[Run], held: Sequence[Run], *, options: Mapping[str, bool], name: str
) -> tuple[ModeTrack, FloatArray]:
    """Modes identified on some runs, followed over others; how far yaw rates are off in sigmas."""
    modes = identified(known, options)
    if not options:
        gains = modes.steady_gains()[:, 1] * [-1, 1]
        lags = -1 / modes.A[:, 1, 1]
        said = ", ".join(
            f"{terrain} {gain.mean():.3f} ({lag:.2f} s, error {np.sqrt(noise):.3f})"
            for terrain, gain, lag, noise in zip(
                modes.names, gains, lags, modes.measurement_variance[:, 1], strict=True
            )
        )
        print(f"{name}: yaw rate by tread speed (lag, error): {said}")
    mode_set = ModeSet(modes, np.full(len(modes.names), DWELL_S))
    signals = joined([modes.signals(run) for run in held])
    track = follow_signals(signals, mode_set)
    off = np.abs(signals.measured[:, 1] - track.means[:, 1]) / track.sigmas[:, 1]
    return track, off[np.isfinite(off)]


def identified(known: Sequence[Run], options: Mapping[str, bool]) -> VelocityModes:
    """Velocity modes of the terrains that are not refused: half a drive may be straight on."""
    try:
        return identify_velocity_modes(known, **options)
    except IdentificationError as error:
        refused = str(error).split(":")[0]
        rest = [run for run in known if run.terrain != refused]
        if len(rest) == len(known):
            raise
        print(f"Left out. {error}")
        return identified(rest, options)


def judged_by_poses(known: Sequence[Run], held: Sequence[Run]) -> list[ModeTrack]:
    """Traction modes identified on some runs, followed over each of the others."""
    modes = identify_traction_modes(known)
    mode_set = ModeSet(modes, np.full(len(modes.names), DWELL_S))
    return [follow_modes(run, mode_set) for run in held]


def joined(parts: Sequence[Signals]) -> Signals:
    """Runs end to end: the state jumps between them, which is the hard part of a change."""
    stamps, begin = [], 0.0
    for part in parts:
        stamps.append(part.stamps_s - part.stamps_s[0] + begin)
        begin = float(stamps[-1][-1]) + BETWEEN_S
    return Signals(
        np.concatenate(stamps),
        np.concatenate([part.tread_speeds_m_s for part in parts]),
        np.concatenate([part.measured for part in parts]),
        np.concatenate([part.labels for part in parts]),
    )


def halves(run: Run) -> tuple[Run, Run]:
    """The first and the second half of a run's time."""
    middle_s = float(run.odometry.stamps_s[[0, -1]].mean())
    return tuple(
        replace(
            run,
            folder=run.folder.with_name(f"{run.folder.name}_{name}"),
            odometry=within(run.odometry, low_s, high_s),
            velocity=None if run.velocity is None else within(run.velocity, low_s, high_s),
        )
        for name, low_s, high_s in (("first", -np.inf, middle_s), ("second", middle_s, np.inf))
    )


def within(table: Table, low_s: float, high_s: float) -> Table:
    """Rows from one time to another."""
    first, end = np.searchsorted(table.stamps_s, [low_s, high_s])
    return table.rows(slice(int(first), int(end)))


def answered_s(track: ModeTrack, sure: float, names: Sequence[str]) -> FloatArray:
    """Seconds (M, M + 2) by true terrain and answer, none of a terrain that was left out."""
    left_out = [place for place, name in enumerate(names) if name not in track.names]
    places = [place - before for before, place in enumerate(left_out)]
    return np.insert(confusion(track, sure, names), places, 0.0, axis=1)


def print_table(title: str, tracks: Sequence[ModeTrack]) -> None:
    """Shares of the time, and how the innovations were."""
    names = max((track.names for track in tracks), key=len)
    print(f"\n{title}: named with {SURE:.0%} and more | most probable")
    print(" " * 10, *(f"{name[:9]:>9}" for name in (*names, *NO_MODES, "", *names)))
    named = sum(answered_s(track, SURE, names) for track in tracks)
    untested = dict.fromkeys(TESTS)
    forced = sum(answered_s(replace(track, **untested), 0.0, names) for track in tracks)
    forced = forced[:, : len(names)]
    for name, row, other in zip(names, named, forced, strict=True):
        cells = [f"{value:9.2f}" for value in row / row.sum()]
        cells += [" " * 9, *(f"{value:9.2f}" for value in other / other.sum())]
        print(f"{name:10}", *cells)
    right, wrong = np.trace(named), named[:, : len(names)].sum() - np.trace(named)
    told = named.sum()
    print(
        f"of {told:.0f} s: right {right / told:.3f}, wrong {wrong / told:.3f}, open "
        f"{named[:, -1].sum() / told:.3f}, none of these {named[:, -2].sum() / told:.3f}; "
        f"most probable right {np.trace(forced) / told:.3f}; "
        f"innovations squared {np.mean([np.nanmean(t.normalised_squared) for t in tracks]):.2f}\n"
    )


if __name__ == "__main__":
    main()
