"""Features of many patches, shared by processes of this machine or workers of a Dask cluster."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
from joblib import Parallel, cpu_count, delayed
from tqdm import tqdm

from odometry.arrays import ByteImage, FloatArray
from terrain.batch.connection import ONE_AT_A_TIME, answers, connected, failure
from terrain.classification.features import FeatureSettings
from terrain.classification.features_of import Transformed, features_of
from terrain.errors import BatchError
from terrain.one_thread import one_thread

PATCHES_A_JOB = 20  # of 128 px: a third of a second, and 1 MB in colour
WORTH_A_PROCESS = 100  # patches; their features take as long as a process takes to start
AHEAD = 4  # jobs for each thread of the workers that are sent before they can begin


def shared_feature_matrix(
    images: Sequence[ByteImage],
    made_by: FeatureSettings | Transformed,
    *,
    processes: int,
    scheduler: str | None = None,
    show_progress: bool = False,
) -> FloatArray:
    """Return the features of each patch as a row, the same for any number of processes.

    Parameters
    ----------
    images : sequence of ByteImage
    made_by : FeatureSettings or Transformed
    processes : int
        Of this machine, where there is no scheduler; -1 takes all cores. No more are started than
        is worth the while.
    scheduler : str, optional
        Address of a Dask scheduler, such as tcp://host:8786, whose workers do it.
    show_progress : bool

    Returns
    -------
    FloatArray, shape (patches, features)

    Raises
    ------
    ExtraError
        If there is a scheduler and Dask is not installed.
    BatchError
        If the cluster cannot do it.
    """
    firsts = range(0, len(images), PATCHES_A_JOB)
    parts = {first: images[first : first + PATCHES_A_JOB] for first in firsts}
    found = (
        _local(parts, made_by, processes)
        if scheduler is None
        else _on_cluster(parts, made_by, scheduler)
    )
    rows: dict[int, FloatArray] = {}
    silent = None if show_progress else True
    with tqdm(desc="features", unit="patch", total=len(images), disable=silent) as bar:
        for first, matrix in found:
            rows[first] = matrix
            bar.update(len(matrix))
    return np.concatenate([rows[first] for first in firsts])


def features_of_part(
    part: tuple[int, Sequence[ByteImage]], made_by: FeatureSettings | Transformed
) -> tuple[int, FloatArray]:
    """The features of some patches, computed by one thread; the number of the first goes along."""
    first, images = part
    with ONE_AT_A_TIME, one_thread():
        return first, features_of(images, made_by)


def _local(
    parts: dict[int, Sequence[ByteImage]], made_by: FeatureSettings | Transformed, processes: int
) -> Iterator[tuple[int, FloatArray]]:
    patches = sum(map(len, parts.values()))
    wanted = cpu_count() if processes < 0 else processes
    used = max(1, min(wanted, patches // WORTH_A_PROCESS))
    jobs = (delayed(features_of_part)(part, made_by) for part in parts.items())
    yield from Parallel(n_jobs=used, return_as="generator_unordered")(jobs)


def _on_cluster(
    parts: dict[int, Sequence[ByteImage]], made_by: FeatureSettings | Transformed, address: str
) -> Iterator[tuple[int, FloatArray]]:
    with connected(address) as client:
        ahead = AHEAD * sum(client.nthreads().values())
        work = partial(features_of_part, made_by=made_by)
        for _, future in answers(client, address, work, parts.items(), ahead):
            if future.status == "error":
                raise BatchError(f"--scheduler {address}: {failure(future)}")
            yield future.result()
