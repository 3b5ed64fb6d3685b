"""A connection to a Dask cluster with the versions of this process, and what its workers answer."""

import gc
import platform
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from itertools import islice
from typing import Any, TypeVar

from odometry.installed import extra_module
from odometry.outputs.provenance import installed_packages
from terrain.errors import BatchError

CONNECTS_S, WAITS_S = 10.0, 10.0
ON_SCHEDULER = ("dask", "distributed")  # packages that a scheduler needs
ONE_AT_A_TIME = threading.Lock()  # in one process: figures and OpenCV have settings of a process

Item = TypeVar("Item")


@contextmanager
def connected(address: str) -> Iterator[Any]:
    """A client of a scheduler that has workers, all of the versions of this process.

    Raises
    ------
    ExtraError
        If Dask is not installed.
    BatchError
        If the scheduler cannot be reached, has no workers, or something has other versions.
    """
    distributed = extra_module("distributed", "dask", "--scheduler")
    # A client that failed closes itself where it is collected; within the next one it would wait
    # for ever for a lock that this one holds.
    gc.collect()
    with warnings.catch_warnings():  # of other versions, which are checked below
        warnings.simplefilter("ignore")
        try:
            client = distributed.Client(address, timeout=CONNECTS_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise BatchError(
                f"--scheduler {address}: no scheduler answers there within {CONNECTS_S:g} s "
                f"({_first_line(error)}); start one with: dask scheduler"
            ) from error
    with client:
        _require_versions(client, address)
        yield client


def answers(
    client: Any, address: str, function: Callable[[Item], Any], items: Iterable[Item], ahead: int
) -> Iterator[tuple[Item, Any]]:
    """Send items to the workers, so many `ahead`; items and their futures as they are done.

    A future is finished or an error; it is done by another worker where one is lost.

    Raises
    ------
    BatchError
        If the scheduler is gone.
    """
    distributed = extra_module("distributed", "dask", "--scheduler")
    waiting, item_of = iter(items), {}
    done = distributed.as_completed(loop=client.loop)

    def send(count: int) -> None:
        for item in islice(waiting, count):
            future = client.submit(function, item, pure=False)
            item_of[future] = item
            done.add(future)

    send(ahead)
    for future in done:
        if future.status not in {"finished", "error"}:
            raise BatchError(f"the scheduler {address} is gone")
        send(1)
        yield item_of.pop(future), future


def failure(future: Any) -> str:
    """Say in one line why there is no answer."""
    error = future.exception()
    if type(error).__name__ == "KilledWorker":
        return f"every worker that did it was lost, {error.last_worker.address} last"
    return f"{type(error).__name__}: {_first_line(error)}"


def versions() -> dict[str, str]:
    """Versions on which it depends that the results are the same everywhere."""
    packages = {name: version(name) for name in ON_SCHEDULER}
    return {"python": platform.python_version(), **packages, **installed_packages()}


def _require_versions(client: Any, address: str) -> None:
    try:
        client.wait_for_workers(1, timeout=WAITS_S)
    except TimeoutError:
        raise BatchError(
            f"{address} has no workers; start some with: dask worker {address} --nthreads 1"
        ) from None
    here = versions()
    scheduler = client.get_versions()["scheduler"]["packages"]
    _require_same(
        {name: here[name] for name in ON_SCHEDULER}, scheduler, f"the scheduler {address}"
    )
    for worker, found in client.run(versions, on_error="return").items():
        where = f"the worker {worker}"
        if isinstance(found, BaseException):
            raise BatchError(
                f"{where} cannot run this program ({type(found).__name__}: {found}); install "
                f"terrain-odometry {here.get('terrain-odometry', '')} there"
            )
        _require_same(here, found, where)


def _require_same(here: Mapping[str, str], there: Mapping[str, Any], where: str) -> None:
    differ = [
        f"{name} {there.get(name, 'absent')} (here {wanted})"
        for name, wanted in here.items()
        if there.get(name, "absent") != wanted
    ]
    if differ:
        raise BatchError(
            f"{where} has {', '.join(differ)}: expected the same versions on all machines"
        )


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
