"""Variances of parameters from the differences between runs, or stretches of a run."""

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray

FEWEST_RUNS = 3  # whose spread is taken as a sample of the spread between runs
FEWEST_STRETCHES = 6
STRETCH = 5  # windows: some 20 s, over which slip wanders
FEWEST_WINDOWS = FEWEST_STRETCHES * STRETCH  # fewer show no spread of the parameters
DETERMINED_ALONE = 1 - 1e-6  # a direction in which one group has all of the information


def correlated_groups(
    run: AnyArray, stretch: int = STRETCH, fewest: int = FEWEST_STRETCHES
) -> IntArray | None:
    """Group (K,) of each window, within which errors may be correlated: runs, else stretches.

    Stretches are shorter where there would be too few of them. None where there are too few
    windows to estimate a spread.

    Parameters
    ----------
    run : (K,) of str
        Of each window, in the order of time.
    stretch : int
        Most windows of a stretch of a run.
    fewest : int
        Stretches whose spread is taken.
    """
    names = list(dict.fromkeys(run.tolist()))
    if len(names) >= FEWEST_RUNS:
        return np.array([names.index(name) for name in run], dtype=np.int64)
    groups, count = np.zeros(len(run), dtype=np.int64), 0
    stretch = max(1, min(stretch, len(run) // fewest))
    for name in names:
        here = np.flatnonzero(run == name)
        stretches = max(1, len(here) // stretch)
        groups[here] = count + np.arange(len(here)) * stretches // len(here)
        count += stretches
    return groups if count >= fewest else None


def spread_between(
    groups: IntArray, jacobian: FloatArray, residuals: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Variances (F,) of parameters from the spread between groups, and degrees of freedom (F,).

    The cluster-robust sandwich with the leverage correction CR2, and the degrees of freedom of
    Satterthwaite that belong to it under equal independent residuals (Bell and McCaffrey 2002;
    Pustejovsky and Tipton 2018 eq. 9 and 11). Both without any matrix larger than F: with
    X'X = B^-1 = C C' and Z_g = X_g C'^-1, (I - Z_g Z_g')^-1/2 acts on the range of Z_g alone.

    Parameters
    ----------
    groups : (K,)
        Within which residuals may be correlated.
    jacobian : (K, 3, F)
        Whitened derivative of the residuals by the parameters.
    residuals : (K, 3)
        Whitened.
    """
    count = jacobian.shape[-1]
    total = np.einsum("kif,kig->fg", jacobian, jacobian)
    sizes, axes = np.linalg.eigh(total)
    determined = sizes > sizes[-1] * len(jacobian) * np.finfo(float).eps
    inverse = (axes[:, determined] / np.sqrt(sizes[determined])).T  # Z_g' = inverse X_g'
    scores, crossed, own = [], [], []
    for group in dict.fromkeys(groups.tolist()):
        here = groups == group
        stacked = jacobian[here].reshape(-1, count) @ inverse.T
        shares, directions = np.linalg.eigh(stacked.T @ stacked)  # of all information
        alone = shares > DETERMINED_ALONE
        left = np.where(alone, np.inf, 1 - np.clip(shares, 0.0, DETERMINED_ALONE))
        root = (directions / np.sqrt(left)) @ directions.T
        scores.append(inverse.T @ root @ stacked.T @ residuals[here].ravel())
        crossed.append(inverse.T @ root @ (directions * shares) @ directions.T)
        own.append(((inverse.T @ directions) ** 2) @ (shares / left))
    variances = np.sum(np.square(scores), axis=0)
    return variances, _satterthwaite(np.array(crossed), np.array(own))


def _satterthwaite(crossed: FloatArray, own: FloatArray) -> FloatArray:
    """Degrees of freedom (F,) from what the groups' corrected scores have in common.

    They are 0 where no group determines a parameter.

    Parameters
    ----------
    crossed : (G, F, F)
        For each parameter (row) the corrected scores in units of equal information.
    own : (G, F)
        Their squares before the fit took its share.
    """
    gram = -np.einsum("gfi,hfi->fgh", crossed, crossed)
    places = np.arange(len(crossed))
    gram[:, places, places] += own.T
    traces = np.trace(gram, axis1=1, axis2=2)
    squares = np.maximum(np.sum(gram**2, axis=(1, 2)), np.finfo(float).tiny)
    return np.asarray(traces**2 / squares)
