"""scikit-learn's shared checks on the terrain classifier, on tables of features."""

from sklearn.utils.estimator_checks import parametrize_with_checks

from terrain.classification.classifier import TerrainClassifier


@parametrize_with_checks([TerrainClassifier(), TerrainClassifier("chen2023")])
def test_scikit_learn_checks(estimator, check):
    check(estimator)
