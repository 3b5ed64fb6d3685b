"""A Dask cluster of real processes on this machine."""

import subprocess
import sys
from contextlib import ExitStack, contextmanager

SCHEDULER = ("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show")
WORKER = ("worker", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--host", "127.0.0.1")


@contextmanager
def started_scheduler():
    """The address of a scheduler."""
    with running(dask(*SCHEDULER)) as process:
        yield said(process, "Scheduler at:").split()[-1]


@contextmanager
def started_workers(scheduler, count, before=""):
    """Processes of workers, each of which has run a line of Python `before`."""
    with ExitStack() as stack:
        started = [dask(*WORKER, scheduler, before=before) for _ in range(count)]
        for process in started:
            stack.enter_context(running(process))
        for process in started:
            said(process, "Registered to:")
        yield started


def dask(*words, before=""):
    program = f"{before}\nimport sys\nfrom dask.__main__ import main\nsys.exit(main())"
    return subprocess.Popen(
        [sys.executable, "-c", program, *words], stderr=subprocess.PIPE, text=True, cwd="/"
    )


def said(process, text):
    """The first line of a process with a text."""
    for line in process.stderr:
        if text in line:
            return line
    raise AssertionError(f"it never said {text!r}")


@contextmanager
def running(process):
    try:
        yield process
    finally:
        process.kill()
        process.communicate()
