"""Features of many patches, whatever makes them, shared by processes or by a Dask cluster."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np
from joblib import Parallel, cpu_count, delayed
from tqdm import tqdm

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.features.features import FeatureSettings, feature_matrix
from terrain.dask_connection import ONE_AT_A_TIME, answers, connected, failure
from terrain.errors import BatchError, PatchError
from terrain.images import to_grey
from terrain.one_thread import one_thread

PATCHES_A_JOB = 20  # of 128 px: a third of a second, and 1 MB in colour
WORTH_A_PROCESS = 100  # patches; their features take as long as a process takes to start
AHEAD = 4  # jobs for each thread of the workers that are sent before they can begin


class Transformer(Protocol):
    """Makes features of images, as transformers of scikit-learn do."""

    def transform(self, X: Iterable[AnyArray]) -> AnyArray:
        """Features (n, F) of images, grey (H, W) or RGB (H, W, 3)."""


@dataclass(frozen=True)
class Transformed:
    """Features by a transformer.

    Attributes
    ----------
    transformer : Transformer
        Fitted.
    colour : bool
        Whether it gets colour; else it gets grey patches.
    """

    transformer: Transformer
    colour: bool


def features_of(patches: Sequence[ByteImage], made_by: FeatureSettings | Transformed) -> FloatArray:
    """Features of patches as rows (n, F).

    Raises
    ------
    PatchError
        If a transformer gives no table of finite numbers.
    """
    if isinstance(made_by, FeatureSettings):
        return feature_matrix(patches, made_by)
    shown = patches if made_by.colour else [to_grey(patch) for patch in patches]
    table = np.asarray(made_by.transformer.transform(shown))
    name = type(made_by.transformer).__name__
    if table.ndim != 2 or len(table) != len(patches) or table.dtype.kind not in "fiub":
        raise PatchError(
            f"{name} gives {table.dtype} {table.shape} for {len(patches)} patches; expected a "
            "table of numbers with a row for each"
        )
    features = table.astype(np.float64)
    if not np.isfinite(features).all():
        raise PatchError(f"{name} gives numbers that are not finite")
    return features


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
