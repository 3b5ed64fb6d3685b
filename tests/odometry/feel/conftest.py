import pytest

from odometry.feel.identify_feel import identify_feel
from tests.odometry.feel.feel_drives import drives


@pytest.fixture(scope="session")
def model():
    """Of three made terrains, four runs each."""
    return identify_feel(drives(["tiles", "gravel", "snow"]))
