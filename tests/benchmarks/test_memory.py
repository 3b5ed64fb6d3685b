"""Peak memory of `run`, with images, on the demo five times and 25 times over."""

import os
import shutil
import subprocess
import sys

import numpy as np

import odometry
from odometry.geometry import se2
from odometry.installed import shipped_data
from odometry.io.run_folder import write_run_folder

COMMAND = "from terrain.cli.main import main; main()"


def repeated(run, folder, copies):
    """The run so many times, one after the other; each begins where the last ended."""
    lasts_s = run.odometry.stamps_s[-1] + 0.1
    poses, at = run.pose.stack("x", "y", "yaw"), np.zeros(3)
    moved = []
    for _ in range(copies):
        moved.append(se2.compose(at, se2.between(poses[0], poses)))
        at = moved[-1][-1]
    tables = {}
    for name, table in (("odometry", run.odometry), ("pose", run.pose), ("images", run.images)):
        tables[name] = {of: np.tile(column, copies) for of, column in table.columns.items()}
        tables[name]["t"] = np.concatenate([table.stamps_s + k * lasts_s for k in range(copies)])
    tables["pose"] |= dict(zip(("x", "y", "yaw"), np.concatenate(moved).T, strict=True))
    write_run_folder(folder, dict(run.settings), tables)
    shutil.copytree(run.folder / "images", folder / "images")


def peak_kb(folder, model, out):
    """Of the whole process."""
    words = ["run", str(folder), "--model", str(model), "--out", str(out)]
    process = subprocess.Popen([sys.executable, "-c", COMMAND, *words], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    assert status == 0
    return usage.ru_maxrss


def test_peak_memory_of_a_long_run(benchmark, tmp_path):
    run = odometry.Run.read(shipped_data() / "runs" / "demo")
    model = tmp_path / "chen.model"
    words = ["train", str(shipped_data() / "patches"), "--preset", "chen2023", "--out", str(model)]
    subprocess.run([sys.executable, "-c", COMMAND, *words], check=True, stdout=subprocess.DEVNULL)
    peaks = {}
    for copies in (5, 25):
        repeated(run, tmp_path / f"{copies}", copies)

    def both():
        for copies in (5, 25):
            peaks[copies] = peak_kb(tmp_path / f"{copies}", model, tmp_path / f"out{copies}")

    benchmark.pedantic(both, rounds=1)
    benchmark.extra_info["figure"] = peaks[25] / peaks[5]
