"""Offsets of several classifiers, one beside the other, and what they notice together."""

from dataclasses import replace

import numpy as np

from odometry.feel.classifier.discriminant import Discriminant
from odometry.feel.classifier.members import Members
from odometry.feel.classifier.strangeness import farness

RNG = np.random.default_rng(7)
FIRST = Discriminant(np.zeros((0, 3)), RNG.normal(size=(3, 3)), np.diag([1.0, 2.0, 0.5]))
SECOND = Discriminant(np.zeros((0, 2)), RNG.normal(size=(3, 2)), np.eye(2))
OF_RUNS = Discriminant(np.zeros((0, 4)), RNG.normal(size=(3, 4)), np.diag([1.0, 3.0, 1.0, 2.0]))
TABLES = [RNG.normal(size=(5, width)) for width in (3, 2, 4)]
USUAL = tuple(np.zeros(width) for width in (3, 2, 4))


def squares(one, table, directions):
    left = table[:, None] @ one.whitening.T - one.means @ one.whitening.T
    return ((left @ directions.T) ** 2).sum(axis=2)


def test_the_squared_offset_is_the_mean_of_discriminants_and_of_the_columns_of_run_means():
    _, found = Members((FIRST, SECOND), USUAL, None, OF_RUNS).offsets(TABLES)
    of_terrains = [
        squares(one, table, one.between)
        for one, table in zip((FIRST, SECOND), TABLES, strict=False)
    ]
    of_means = squares(OF_RUNS, TABLES[2], np.eye(4)) / 4
    np.testing.assert_allclose((found**2).sum(axis=2), np.mean(of_terrains, axis=0) + of_means)


def test_a_terrain_off_along_a_column_in_which_runs_agree_is_far():
    """No two known terrains differ in the third column, so that no discriminant looks along it."""
    means = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
    plain = Discriminant(np.zeros((0, 3)), means, np.eye(3))
    of_runs = replace(plain, whitening=np.diag([1.0, 1.0, 5.0]))
    windows = [np.array([[0.1, 0.0, 0.0], [0.1, 0.0, 1.0]])] * 2
    usual = (np.zeros(3), np.zeros(3))
    blind = farness(Members((plain,), usual).offsets(windows)[1])
    found = farness(Members((plain,), usual, None, of_runs).offsets(windows)[1])
    np.testing.assert_allclose(blind, blind[0])
    assert found[1] > 100 * found[0]
