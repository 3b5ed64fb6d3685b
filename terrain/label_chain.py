"""Which terrain lies at each place of a row of places, from all labels: a hidden Markov chain."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import FloatArray


def likelihoods(
    labels: Sequence[str],
    probabilities: Sequence[Mapping[str, float]],
    names: Sequence[str],
    accuracy: float,
) -> FloatArray:
    """Likelihood of each label on each terrain.

    Parameters
    ----------
    labels : sequence of str, length n
    probabilities : sequence of Mapping, length n
        What the classifier gave to each terrain; empty where it gave only the label.
    names : sequence of str, length k
        The known terrains.
    accuracy : float
        Probability that a label is right, 0 to 1.

    Returns
    -------
    (n, k + 1)
        The last column is a terrain that is none of `names`: a label says nothing of it but that
        it was wrong, and wrong labels are spread evenly.
    """
    given = np.zeros((len(labels), len(names) + 1))
    for row, label, by_name in zip(given, labels, probabilities, strict=True):
        of = by_name or {label: 1.0}
        row[:-1] = [of.get(name, 0.0) for name in names]
    return np.asarray(accuracy * given + (1 - accuracy) / given.shape[1])


def smoothed(
    likelihood: FloatArray, steps_m: FloatArray, prior: FloatArray, change_m: float
) -> FloatArray:
    """Probability of each terrain at each place, given the labels of all places.

    Between places a distance s apart the terrain stays with probability exp(-s / change_m), and
    is else any of the k, all alike.

    Parameters
    ----------
    likelihood : (n, k)
        Of the label of each place on each terrain.
    steps_m : (n,)
        Distance to each place from the one before; the first is that from where `prior` holds.
    prior : (k,)
    change_m : float
        Mean distance between changes of terrain.

    Returns
    -------
    (n, k)
        Rows add up to 1.

    References
    ----------
    Rabiner 1989, "A tutorial on hidden Markov models", eq. 19-27, with scaled variables.
    """
    count = likelihood.shape[1]
    transition = carried(np.eye(count), np.exp(-steps_m / change_m)[:, None, None])
    forward, backward = np.empty_like(likelihood), np.ones_like(likelihood)
    belief = prior
    for place, by_label in enumerate(likelihood):
        belief = by_label * (transition[place] @ belief)  # eq. 20
        belief /= belief.sum()
        forward[place] = belief
    belief = backward[-1]
    for place in range(len(likelihood) - 2, -1, -1):
        belief = transition[place + 1] @ (likelihood[place + 1] * belief)  # eq. 25
        belief /= belief.sum()
        backward[place] = belief
    product = forward * backward  # eq. 27
    return np.asarray(product / product.sum(axis=1, keepdims=True))


def carried(belief: FloatArray, stay: FloatArray) -> FloatArray:
    """Beliefs (..., k) after ways on which the terrain stays with probabilities `stay` (..., 1).

    The transition is symmetric, so that it carries likelihoods back as well.
    """
    return np.asarray(stay * belief + (1 - stay) * belief.mean(axis=-1, keepdims=True))
