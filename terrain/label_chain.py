"""Which terrain lies at each place of a row of places, from all labels: a hidden Markov chain."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray

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
    ahead, after = _both_ways(
        np.broadcast_to(evidence, (len(evidence), *looks.shape)),
        prior[:, None] / drawn,
        np.stack([np.exp(-steps_m / change_m), np.exp(-steps_m / alike_m)]),
        looks,
        drawn,
    )
    product = (looks * drawn * ahead * after).sum(axis=2)  # eq. 27
    return np.asarray(product / product.sum(axis=1, keepdims=True))


def _both_ways(
    evidence: FloatArray,
    first: FloatArray,
    same: FloatArray,
    looks: FloatArray,
    drawn: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Forward and backward variables (n, k + 1, k), in one loop.

    The chain is reversible: what comes before, in shares of what is drawn, obeys the same step
    as the likelihood of what comes after. Backward variables hold the evidence of their place,
    forward ones that of the places before alone. On the way to each place terrain and look stay
    with the probabilities `same` (2, n).
    """
    ahead, after = np.empty_like(evidence), np.empty_like(evidence)
    ahead[0] = _step(first, looks, drawn, *same[:, 0])
    after[-1] = evidence[-1]
    state = np.stack([evidence[0] * ahead[0], after[-1]])
    there_and_back = np.stack([evidence, evidence[::-1]], axis=1)
    both = np.stack([same, np.roll(same[:, ::-1], 1, axis=1)], axis=2)[..., None, None]
    for place in range(1, len(evidence)):
        state = _step(state, looks, drawn, *both[:, place])  # eq. 20 and 25
        ahead[place] = state[0]
        state *= there_and_back[place]
        state /= np.add.reduce(state, axis=(1, 2), keepdims=True)
        after[-1 - place] = state[1]
    return ahead, after


def _step(
    state: FloatArray, looks: FloatArray, drawn: FloatArray, stays: AnyArray, alike: AnyArray
) -> FloatArray:
    """Likelihood (..., k + 1, k) by terrain and look, a step on."""
    terrain = np.add.reduce(looks * state, axis=-1, keepdims=True)
    same = alike * state + (1 - alike) * terrain
    anew = np.add.reduce(drawn * terrain, axis=-2, keepdims=True)
    return np.asarray(stays * same + (1 - stays) * anew)


def carried(belief: FloatArray, stay: FloatArray) -> FloatArray:
    """Beliefs (..., k) after ways on which the terrain stays with probabilities `stay` (..., 1).

    The transition is symmetric, so that it carries likelihoods back as well.
    """
    return np.asarray(stay * belief + (1 - stay) * belief.mean(axis=-1, keepdims=True))
