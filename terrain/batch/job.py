"""One run of many: replayed into its own folder, or kept where that holds the same already."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from odometry.errors import OdometryError
from odometry.outputs.manifest import FINISHED, Manifest, check_finished, read_manifest
from odometry.outputs.output_folder import claim_folder
from odometry.outputs.provenance import Asked, Made
from odometry.outputs.written_tables import changes_of
from terrain.checks.recording import checked_run
from terrain.one_thread import one_thread
from terrain.results import write_run
from terrain.run_options import RunOptions

VERB = "run"
REPLAYED, KEPT, FAILED = "replayed", "kept", "failed"


@dataclass(frozen=True)
class Job:
    """What a process needs to know to replay one run as `run` would.

    Attributes
    ----------
    name : str
        Of the result's folder; no other job of the batch has it.
    folder, out : Path
        The run and its results, by paths that every process can use.
    asked : Asked
        The command `run` that gives the same.
    options : RunOptions
        Its files, by paths that every process can use.
    """

    name: str
    folder: Path
    out: Path
    asked: Asked
    options: RunOptions


@dataclass(frozen=True)
class Outcome:
    """What became of a job.

    Attributes
    ----------
    job : Job
    state : str
        `replayed`, `kept` (it was done already, and the same), or `failed`.
    said : str
        Why it failed, or why an earlier result was replaced.
    sums : tuple of (role, path, sha256)
        Of its inputs, as in `Made`.
    wall_s, cpu_s : float
        What it took.
    left_out : str
        Why its images were not believed, or "".
    """

    job: Job
    state: str
    said: str = ""
    sums: tuple[tuple[str, str, str], ...] = ()
    wall_s: float = 0.0
    cpu_s: float = 0.0
    left_out: str = ""


def run_job(job: Job) -> Outcome:
    """Replay one run; whatever goes wrong is its outcome."""
    wall_s, cpu_s = time.monotonic(), time.process_time()
    made, state, said, left_out = None, REPLAYED, "", ""
    try:
        for _, path in job.asked.inputs:
            check_finished(job.asked.where / path)
        made = job.asked.made(with_images=job.options.reads_images)
        earlier = read_manifest(job.out)
        if earlier is not None and earlier.verb == VERB and _is_whole(earlier, job.out):
            changes = changes_of(job.out)
            if earlier.made.get("identity") != made.identity:
                said = what_differs(earlier.made, made)
            elif changes.lost or changes.edited:
                said = (*changes.lost, *changes.edited)[0]
            else:
                return Outcome(job, KEPT, "", made.inputs)
        with one_thread():
            left_out = _replay(job, made)
    except (OdometryError, OSError, MemoryError) as error:
        state, said = FAILED, str(error) or type(error).__name__
    except Exception as error:  # one run that finds a fault of ours must not end the others
        state, said = FAILED, f"{type(error).__name__}: {error}"
    took = time.monotonic() - wall_s, time.process_time() - cpu_s
    inputs = made.inputs if made else ()
    return Outcome(job, state, " ".join(said.split()), inputs, *took, left_out)


def _replay(job: Job, made: Made) -> str:
    """Replay and write; why the images were not believed, or ""."""
    output = claim_folder(job.out, made)
    run, report = checked_run(job.folder, job.options.span, images=job.options.reads_images)
    run, options, left_out = job.options.believed(run, report)
    write_run(options.replay(run), output, [report])
    return left_out


def _is_whole(manifest: Manifest, folder: Path) -> bool:
    """Whether a result was finished, and all of it is still there."""
    return manifest.state == FINISHED and all((folder / name).is_file() for name in manifest.files)


def what_differs(earlier: Mapping[str, Any], made: Made) -> str:
    """Why an earlier result is not the requested one, in a few words."""
    sums = {one["role"]: one["sha256"] for one in earlier["inputs"]}
    changed = [role for role, _, sha256 in made.inputs if sums.get(role, sha256) != sha256]
    packages = [
        f"{name} {earlier['packages'].get(name, 'absent')}, now {version}"
        for name, version in made.packages.items()
        if earlier["packages"].get(name) != version
    ]
    words = [f"another {', '.join(changed)}"] if changed else []
    words += [f"made with {', '.join(packages)}"] if packages else []
    return "; ".join(words) or f"made by other settings: {earlier['command']}"
