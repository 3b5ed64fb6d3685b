"""Logistic regression against an independent program, and what speed may not change."""

import numpy as np
from sklearn.linear_model import LogisticRegression

from odometry.feel.classifier.discriminant import moments_of, pooled
from odometry.feel.classifier.logistic import RIDGE, fitted_logistic
from tests.odometry.feel.classifier.test_discriminant import NAMES, made


def fitted(table, labels, runs, covariates):
    codes = np.searchsorted(NAMES, labels.astype(str))
    of = pooled(moments_of(table, labels, runs), NAMES)
    shares = np.full(len(table), 1 / len(table))
    return fitted_logistic(table, codes, shares, of, covariates), of


def test_it_is_that_of_an_independent_program():
    table, labels, runs = made(7)
    columns = table[:, :3]
    own, of = fitted(columns, labels, runs, 0)
    standard = (columns - of.means.mean(axis=0)) / np.sqrt(np.diag(of.whole))
    # of two classes the weights are half as large each: the penalty counts half
    other = LogisticRegression(C=2 / (RIDGE * len(table)), tol=1e-10, max_iter=2000)
    other.fit(standard, labels)
    found = own.log_likelihoods(columns)
    np.testing.assert_allclose(
        found[:, 1] - found[:, 0], other.decision_function(standard), atol=0.02
    )


def test_what_a_covariate_adds_changes_nothing():
    table, labels, runs = made(8)
    tilted, *_ = made(8, 2.0)
    both = [fitted(of, labels, runs, 1)[0].log_likelihoods(of) for of in (table, tilted)]
    np.testing.assert_allclose(both[0], both[1], atol=0.3)
    assert np.corrcoef(both[0][:, 0], both[1][:, 0])[0, 1] > 0.999
