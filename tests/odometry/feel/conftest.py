import pytest

from tests.odometry.feel.feel_drives import model_of_three


@pytest.fixture(scope="session")
def model():
    """Of three made terrains, three runs each."""
    return model_of_three()
