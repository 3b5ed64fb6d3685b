"""Stamps of arrival of rows that were measured at even times."""

from dataclasses import replace

import numpy as np

from odometry.tables.table import Table


def in_order(stamps_s):
    """No row overtakes another: those that wait come 10 us apart."""
    behind_s = 1e-5 * np.arange(len(stamps_s))
    return np.maximum.accumulate(stamps_s - behind_s) + behind_s


def by_chance(stamps_s, mean_s=0.12, share=1.0, seed=0):
    """Late by exponential times, all rows or a share of them."""
    rng = np.random.default_rng(seed)
    late_s = rng.exponential(mean_s, len(stamps_s)) * (rng.random(len(stamps_s)) < share)
    return in_order(stamps_s + late_s)


def after_stalls(stamps_s, every_s=15.0, lasts_s=1.0):
    """Rows of the last part of each such time come together at its end."""
    end_s = every_s * np.ceil(stamps_s / every_s)
    return in_order(np.where(end_s - stamps_s < lasts_s, end_s, stamps_s))


def cut_off(stamps_s, step_s):
    """The stamps in whole steps."""
    return step_s * np.floor(np.round(stamps_s / step_s, 6))


def stamped(table, stamps_s, rows=slice(None)):
    """Other stamps, of all or of some rows, as a reader leaves them."""
    columns = {name: np.asarray(values)[rows] for name, values in table.columns.items()}
    lines = np.arange(2, len(stamps_s) + 2)
    return Table(table.file, {**columns, "t": stamps_s}, lines).without_repeated()


def with_arrival(run, change=by_chance):
    """A run whose odometry.csv has changed stamps."""
    return replace(run, odometry=stamped(run.odometry, change(run.odometry.stamps_s)))
