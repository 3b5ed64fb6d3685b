import pytest

from terrain.classification.classifier import TerrainClassifier
from tests.terrain.classification.test_no_ground import photographs


@pytest.fixture(scope="session")
def model():
    """A classifier of 40 photographs of each of two terrains; copy it to change it."""
    return TerrainClassifier().fit(*photographs(1, photos=40))
