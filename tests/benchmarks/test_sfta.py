"""Time of SFTA beside two marks of OpenCV, in one run: `pytest --benchmark-only`."""

import cv2
import numpy as np
import pytest
from skimage.data import gravel
from skimage.filters import threshold_multiotsu

from terrain.texture import sfta

SIZES = [(200, 200), (480, 640), (720, 1280)]
OF_EACH_SIZE = pytest.mark.parametrize("size", SIZES, ids=["size0", "size1", "size2"])


@pytest.fixture(autouse=True)
def one_thread():
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    yield
    cv2.setNumThreads(threads)


def photo(size):
    return np.ascontiguousarray(np.tile(gravel(), (2, 3))[: size[0], : size[1]])


class TestBesideOpenCV:
    @pytest.fixture(autouse=True)
    def _group(self, benchmark, size):
        benchmark.group = f"{size[1]} x {size[0]}"

    @OF_EACH_SIZE
    @pytest.mark.parametrize("variant", ["chen2023", "costa2012"])
    def test_sfta(self, benchmark, size, variant):
        benchmark(sfta, photo(size), 4, variant)

    @OF_EACH_SIZE
    def test_calc_hist(self, benchmark, size):
        benchmark(cv2.calcHist, [photo(size)], [0], None, [256], [0, 256])

    @OF_EACH_SIZE
    def test_erode(self, benchmark, size):
        benchmark(cv2.erode, photo(size), np.ones((3, 3), np.uint8))


def test_thresholds_of_scikit_image_alone(benchmark):
    """What any port pays that takes its thresholds from scikit-image: seconds, not tenths of ms."""
    benchmark.group = "200 x 200"
    benchmark.pedantic(threshold_multiotsu, (photo((200, 200)),), {"classes": 5}, rounds=1)
