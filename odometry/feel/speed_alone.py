"""A classifier that only knows how the robot was driven: what speed by itself gives away."""

import numpy as np

from odometry.arrays import IntArray
from odometry.feel.discriminant import fitted_discriminant, pooled
from odometry.feel.scores import balanced_accuracy
from odometry.feel.table import FeelTable

SHRINKAGE = 0.03


def speed_alone(table: FeelTable, folds: IntArray) -> float:
    """Balanced accuracy of windows by the covariates alone, folds (R,) of runs held out."""
    width = table.tables[0].shape[1]
    places = range(width - table.covariates, width)
    covariates, moments = table.tables[0][:, list(places)], table.moments[0]
    right = np.zeros(len(table), dtype=bool)
    judged = np.zeros(len(table), dtype=bool)
    for fold in np.unique(folds):
        part = moments.where(folds[moments.runs] != fold)
        names = tuple(sorted(set(part.labels.tolist())))
        rows = (folds[table.runs] == fold) & np.isin(table.labels.astype(str), names)
        if len(names) < 2 or not rows.any():
            continue
        model = fitted_discriminant(pooled(part, names).columns(places), 0, SHRINKAGE)
        squared = (model.left(covariates[rows]) ** 2).sum(axis=2)
        right[rows] = np.array(names, dtype=object)[squared.argmin(axis=1)] == table.labels[rows]
        judged |= rows
    return balanced_accuracy(table.labels[judged], right[judged])
