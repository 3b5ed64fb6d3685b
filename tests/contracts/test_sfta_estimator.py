"""scikit-learn's shared checks on the transformers of images: SFTA and those of patches.

The checks feed tables, so a row is shown to the transformer as an image of one row of pixels.
Nothing else is changed: construction, fitting, names, cloning and errors are their own.
"""

from contextlib import contextmanager

import numpy as np
from sklearn.utils.estimator_checks import parametrize_with_checks

from terrain.classification.features.network_features import Network, NetworkFeatures
from terrain.classification.sfta_features import SftaFeatures
from terrain.errors import ImageError
from terrain.texture import SFTA
from tests.terrain.classification.features.onnx_bytes import tiny_network

TINY = Network("tiny.onnx", tiny_network())
SIZES_DIFFER = "images may differ in size: there is no number of columns to remember"
OTHER_WORDS = "refused with an ImageError about images, not in the words for tables"
EXPECTED_FAILURES = {
    "check_n_features_in": SIZES_DIFFER,
    "check_n_features_in_after_fitting": SIZES_DIFFER,
    "check_complex_data": OTHER_WORDS,
    "check_dtype_object": "refused: an array of Python objects is not an image",
    "check_estimator_sparse_array": OTHER_WORDS,
    "check_estimator_sparse_matrix": OTHER_WORDS,
    "check_estimator_sparse_tag": OTHER_WORDS,
    "check_estimators_empty_data_messages": OTHER_WORDS,
    "check_fit2d_predict1d": OTHER_WORDS,
}
NO_DEFAULT = {"check_parameters_default_constructible": "no network is the usual one"}


class RowsAsImages:
    """A transformer of tables: each row an image of height one, squeezed into 0 to 1."""

    def fit(self, X, y=None):
        with value_error():
            return super().fit(as_images(X), y)

    def transform(self, X):
        with value_error():
            return super().transform(as_images(X))

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.input_tags.two_d_array = True
        tags.input_tags.three_d_array = False
        return tags


class SftaOfRows(RowsAsImages, SFTA):
    """SFTA."""


class FeaturesOfRows(RowsAsImages, SftaFeatures):
    """The features of the terrain classifier."""


class NetworkOfRows(RowsAsImages, NetworkFeatures):
    """The features of an image network."""

    def __init__(self, network=TINY):
        super().__init__(network, layers=("r1",))


def as_images(table):
    rows = np.asarray(table)
    if rows.ndim != 2 or rows.dtype.kind not in "iuf":
        return rows
    squeezed = np.where(np.isfinite(rows), 1.0 / (1.0 + np.exp(-np.clip(rows, -50, 50))), rows)
    return squeezed[:, None, :]


@contextmanager
def value_error():
    """The checks ask for ValueError, which our errors are not."""
    try:
        yield
    except ImageError as error:
        raise ValueError(str(error)) from error


@parametrize_with_checks(
    [SftaOfRows(), FeaturesOfRows("chen2023"), NetworkOfRows()],
    expected_failed_checks=lambda of: (
        EXPECTED_FAILURES | (NO_DEFAULT if isinstance(of, NetworkFeatures) else {})
    ),
)
def test_scikit_learn_checks(estimator, check):
    check(estimator)
