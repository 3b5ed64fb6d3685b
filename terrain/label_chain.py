"""Which terrain lies at each place of a row of places, from all labels: a hidden Markov chain."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import BoolArray, FloatArray

# chosen with simulated labels, half of whose drives were kept for the figures
UNNAMED = 0.03  # of the ways that end, so many end on a terrain that has no name


def given_to(
    labels: Sequence[str], probabilities: Sequence[Mapping[str, float]], names: Sequence[str]
) -> FloatArray:
    """What each label gives to each terrain.

    Parameters
    ----------
    labels : sequence of str, length n
    probabilities : sequence of Mapping, length n
        What the classifier gave to each terrain; empty where it gave only the label.
    names : sequence of str, length k

    Returns
    -------
    (n, k)
    """
    given = np.zeros((len(labels), len(names)))
    for row, label, by_name in zip(given, labels, probabilities, strict=True):
        of = by_name or {label: 1.0}
        row[:] = [of.get(name, 0.0) for name in names]
    return given


def smoothed(
    given: FloatArray,
    steps_m: FloatArray,
    prior: FloatArray,
    *,
    accuracy: float,
    change_m: float,
    alike_m: float,
    felt: BoolArray | None = None,
) -> FloatArray:
    """Probability of each terrain at each place, given the labels of all places.

    There are k named terrains and one that is none of them. A place looks like one of the k: like
    its own, seldom like any of the others, and like any of the k alike where it is none of them.
    Between places a distance s apart the terrain stays with probability exp(-s / change_m), and is
    else drawn anew. Where it stays, the look stays with probability exp(-s / alike_m), and is else
    drawn anew. A label names the look, or seldom any of the k. Half of the wrong labels are wrong
    looks, which last; the others stand alone. So many labels of one stretch say little more of its
    terrain than one of them, and labels that contradict each other speak for no name.

    Parameters
    ----------
    given : (n, k)
        What the label of each place gives to each named terrain.
    steps_m : (n,)
        Distance to each place from the one before; the first is that from where `prior` holds.
    prior : (k + 1,)
        Of the terrain; the last is none of those with names.
    accuracy : float
        Probability that a label is right on a terrain with a name, 0 to 1.
    change_m : float
        Mean distance between changes of terrain.
    alike_m : float
        Mean distance between new looks of one terrain: the correlation length of labels.
    felt : (n,), optional
        What was felt and not seen: probabilities of the terrain itself, whatever it looks like;
        they speak neither for nor against one that is none of the k.

    Returns
    -------
    (n, k + 1)
        Rows add up to 1.

    References
    ----------
    Rabiner 1989, "A tutorial on hidden Markov models", eq. 19-27, with scaled variables; a state
    is a pair (terrain, look).
    """
    count = given.shape[1]
    wrong = (1 - accuracy) / 2
    seen = ((1 - wrong) * given + wrong / count)[:, None, :]
    beneath = np.column_stack([given, given.mean(axis=1)])[:, :, None]
    evidence = seen if felt is None else np.where(felt[:, None, None], beneath, seen)
    own = (1 - wrong) * np.eye(count) + wrong / count
    looks = np.vstack([own, np.full(count, 1 / count)])
    drawn = np.append(np.full(count, (1 - UNNAMED) / count), UNNAMED)[:, None]
    stays, alike = np.exp(-steps_m / change_m), np.exp(-steps_m / alike_m)
    forward = np.empty((len(evidence), *looks.shape))
    state = prior[:, None] * looks
    for place, of in enumerate(evidence):
        state = of * _ahead(state, looks, drawn, stays[place], alike[place])  # eq. 20
        state /= state.sum()
        forward[place] = state
    backward = np.ones_like(forward)
    for place in range(len(evidence) - 1, 0, -1):
        state = evidence[place] * backward[place]
        state = _back(state, looks, drawn, stays[place], alike[place])  # eq. 25
        backward[place - 1] = state / state.sum()
    product = (forward * backward).sum(axis=2)  # eq. 27
    return np.asarray(product / product.sum(axis=1, keepdims=True))


def _ahead(
    state: FloatArray, looks: FloatArray, drawn: FloatArray, stays: float, alike: float
) -> FloatArray:
    """Probabilities (k + 1, k) of terrain and look, a step on."""
    terrain = state.sum(axis=1, keepdims=True)
    same = alike * state + (1 - alike) * terrain * looks
    return np.asarray(stays * same + (1 - stays) * terrain.sum() * drawn * looks)


def _back(
    state: FloatArray, looks: FloatArray, drawn: FloatArray, stays: float, alike: float
) -> FloatArray:
    """Likelihood (k + 1, k) of what comes, by terrain and look a step before."""
    terrain = (looks * state).sum(axis=1, keepdims=True)
    same = alike * state + (1 - alike) * terrain
    return np.asarray(stays * same + (1 - stays) * (drawn * terrain).sum())


def carried(belief: FloatArray, stay: FloatArray) -> FloatArray:
    """Beliefs (..., k) after ways on which the terrain stays with probabilities `stay` (..., 1).

    The transition is symmetric, so that it carries likelihoods back as well.
    """
    return np.asarray(stay * belief + (1 - stay) * belief.mean(axis=-1, keepdims=True))
