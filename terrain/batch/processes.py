"""Processes of this machine, forked from one that has imported what a replay needs."""

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, forkserver, get_all_start_methods, get_context
from multiprocessing import parent_process as parent_of_this

METHOD = "forkserver" if "forkserver" in get_all_start_methods() else "spawn"
NEEDED = "terrain.batch.job"
ONE_THREAD = dict.fromkeys(("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def prepare() -> None:
    """Let a process import what a replay needs, while this one does other things.

    Processes forked from it need not: importing takes as long as a short run. It has one thread,
    as a process must that is forked.
    """
    if METHOD != "forkserver":
        return
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        forkserver.set_forkserver_preload([NEEDED])
        forkserver.ensure_running()
    finally:
        os.environ.clear()
        os.environ.update(before)


@contextmanager
def pool(processes: int) -> Iterator[ProcessPoolExecutor]:
    """So many processes that end with this one; at once where the work is broken off."""
    prepare()
    others = set(active_children())
    executor = ProcessPoolExecutor(processes, get_context(METHOD), end_with_parent)
    try:
        yield executor
    except BaseException:
        executor.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - others:
            process.kill()
        raise
    executor.shutdown()


def end_with_parent() -> None:
    """Let this process end soon after its parent, which alone hears of Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_watch, daemon=True).start()


def _watch() -> None:
    if parent := parent_of_this():
        parent.join()
    os._exit(1)
