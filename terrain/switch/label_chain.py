"""The terrain at each place of a row of places, from all labels: a hidden Markov chain."""

from collections.abc import Mapping, Sequence

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.recording.run import UNKNOWN

# chosen with simulated labels, half of whose drives were kept for the figures
UNNAMED = 0.03  # of the ways that end, so many end on a terrain that has no name
# of the appearances of a known terrain so many resemble none, and of the labels of an appearance
# so many are `unknown` by themselves: 0.05 to 0.15 of images of known terrain have no name
REFUSED = 0.1
# and of one without a name: either as few, or what photographs of terrains that were not in
# training have, 0.38 of patches to 0.63 of photographs
REFUSED_UNNAMED = np.array([REFUSED, 0.5])


def given_to(
    labels: Sequence[str], probabilities: Sequence[Mapping[str, float]], names: Sequence[str]
) -> FloatArray:
    """Probability of each terrain by each label; zeros where the label is ``unknown``.

    Parameters
    ----------
    labels : sequence of str, length n
    probabilities : sequence of Mapping, length n
        Of each terrain by the classifier; empty where it gave only the label.
    names : sequence of str, length k

    Returns
    -------
    (n, k)
    """
    given = np.zeros((len(labels), len(names)))
    for row, label, by_name in zip(given, labels, probabilities, strict=True):
        of = {} if label == UNKNOWN else by_name or {label: 1.0}
        row[:] = [of.get(name, 0.0) for name in names]
    return given


def of_any_place(names: int) -> FloatArray:
    """Probabilities (names + 1,) of the terrain at a place of which nothing is known."""
    return np.append(np.full(names, (1 - UNNAMED) / names), UNNAMED)


def smoothed(
    given: FloatArray,
    steps_m: FloatArray,
    prior: FloatArray,
    *,
    accuracy: float,
    change_m: float,
    alike_m: float,
    by_feel: BoolArray | None = None,
) -> FloatArray:
    """Probability of each terrain at each place, given the labels of all places.

    There are k named terrains and one that is none of them. A place has the appearance of one of
    the k, or resembles none. On a named terrain it is usually its own, seldom another or none; on
    one without a name each of the k with equal probability, and none as seldom or half the time.
    Between places a distance s apart the terrain stays with probability exp(-s / change_m), and is
    else drawn again. Where it stays, the appearance stays with probability exp(-s / alike_m), and
    is else drawn again. A label names the appearance, or seldom another. Half of the wrong labels
    come from a wrong appearance, which lasts; the others are independent. So many labels of one
    stretch are little more evidence than one of them, and labels that contradict each other, or
    names among many images without one, support no name.

    Parameters
    ----------
    given : (n, k)
        Probability of each named terrain by the label of each place; zeros where the image was
        of none.
    steps_m : (n,)
        Distance to each place from the one before; the first is that from where `prior` holds.
    prior : (k + 1,)
        Of the terrain; the last is none of those with names.
    accuracy : float
        Probability that a label is right on a terrain with a name, 0 to 1.
    change_m : float
        Mean distance between changes of terrain.
    alike_m : float
        Mean distance between new appearances of one terrain: the correlation length of labels.
    by_feel : (n,), optional
        Whether a label comes from feel and not from an image: its probabilities are of the terrain
        itself, not of its appearance; they are no evidence on a terrain that is none of the k.

    Returns
    -------
    (n, k + 1)
        Rows add up to 1.

    References
    ----------
    Rabiner 1989, "A tutorial on hidden Markov models", eq. 19-27, with scaled variables; a state
    is a pair (terrain, appearance).
    """
    count = given.shape[1]
    wrong = (1 - accuracy) / 2
    seen = _by_appearance(given, wrong)[:, None, :]
    of_none = given.mean(axis=1, keepdims=True)
    terrain_evidence = np.hstack([given, of_none, of_none])[:, :, None]
    evidence = seen if by_feel is None else np.where(by_feel[:, None, None], terrain_evidence, seen)
    own = (1 - wrong) * np.eye(count) + wrong / count
    appearances = np.vstack([own, np.full((2, count), 1 / count)])
    like_none = np.append(np.full(count, REFUSED), REFUSED_UNNAMED)[:, None]
    appearances = np.hstack([(1 - like_none) * appearances, like_none])
    drawn = _both_unnamed(of_any_place(count))[:, None]
    ahead, after = _both_ways(
        np.broadcast_to(evidence, (len(evidence), *appearances.shape)),
        _both_unnamed(prior)[:, None] / drawn,
        np.stack([np.exp(-steps_m / change_m), np.exp(-steps_m / alike_m)]),
        appearances,
        drawn,
    )
    product = (appearances * drawn * ahead * after).sum(axis=2)  # eq. 27
    product = np.column_stack([product[:, :count], product[:, count:].sum(axis=1)])
    return np.asarray(product / product.sum(axis=1, keepdims=True))


def _both_unnamed(probabilities: FloatArray) -> FloatArray:
    """Of the terrains (k + 1,), with half of the last for each of two kinds without a name."""
    return np.append(probabilities, probabilities[-1]) / ([1] * (len(probabilities) - 1) + [2, 2])


def _by_appearance(given: FloatArray, wrong: float) -> FloatArray:
    """Probability of each label (n, k) where a place resembles each of the k or none (n, k + 1)."""
    count, alone = given.shape[1], REFUSED
    by_name = (1 - alone) * ((1 - wrong) * given + wrong / count)
    named = np.column_stack([by_name, np.full(len(given), alone / count)])
    unnamed = np.append(np.full(count, alone), 1 - alone)
    return np.where(given.any(axis=1, keepdims=True), named, unnamed)


def _both_ways(
    evidence: FloatArray,
    first: FloatArray,
    same: FloatArray,
    appearances: FloatArray,
    drawn: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Forward and backward variables (n, k + 2, k + 1), in one loop.

    The chain is reversible: what comes before, in shares of what is drawn, obeys the same step
    as the likelihood of what comes after. Backward variables hold the evidence of their place,
    forward ones that of the places before alone. On the way to each place terrain and appearance
    stay with the probabilities `same` (2, n).
    """
    ahead, after = np.empty_like(evidence), np.empty_like(evidence)
    ahead[0] = _step(first, appearances, drawn, same[:, 0], 1 - same[:, 0])
    after[-1] = evidence[-1]
    state = np.stack([evidence[0] * ahead[0], after[-1]])
    there_and_back = np.stack([evidence, evidence[::-1]], axis=1)
    both = np.stack([same, np.roll(same[:, ::-1], 1, axis=1)], axis=2)[..., None, None]
    changed = 1 - both
    for place in range(1, len(evidence)):
        stays = both[:, place], changed[:, place]
        state = _step(state, appearances, drawn, *stays)  # eq. 20 and 25
        ahead[place] = state[0]
        state *= there_and_back[place]
        state /= np.add.reduce(state, axis=(1, 2), keepdims=True)
        after[-1 - place] = state[1]
    return ahead, after


def _step(
    state: FloatArray,
    appearances: FloatArray,
    drawn: FloatArray,
    stays: AnyArray,
    changes: AnyArray,
) -> FloatArray:
    """Likelihood (..., k + 2, k + 1) by terrain and appearance, a step on.

    `stays` and `changes` (2, ...) are the probabilities that terrain and appearance do so.
    """
    terrain = np.add.reduce(appearances * state, axis=-1, keepdims=True)
    ahead = stays[1] * state
    ahead += changes[1] * terrain
    ahead *= stays[0]
    ahead += changes[0] * np.add.reduce(drawn * terrain, axis=-2, keepdims=True)
    return np.asarray(ahead)


def carried(belief: FloatArray, stay: FloatArray) -> FloatArray:
    """Beliefs (..., k) after distances on which terrain stays with probabilities `stay` (..., 1).

    The transition is symmetric, so that it carries likelihoods back as well.
    """
    mean = np.add.reduce(belief, axis=-1, keepdims=True) / belief.shape[-1]
    return np.asarray(stay * belief + (1 - stay) * mean)
