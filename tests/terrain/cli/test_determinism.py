"""Files are the same, byte by byte, in any locale, time zone, hash seed, threads and processes."""

import os
import shlex
import shutil
import subprocess
import sys

import cv2
import pytest

from terrain.cli.main import main

VERBS = """
import shlex, sys
from terrain.cli.main import main
for line in sys.argv[1:]:
    sys.argv = ["terrain-odometry", *shlex.split(line)]
    try:
        main()
    except SystemExit as ended:
        if ended.code:
            sys.exit(f"{line}: {ended.code}")
"""
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "LOKY_MAX_CPU_COUNT")
UNUSUAL = {  # text is ASCII where no encoding is named
    "LC_ALL": "C",
    "PYTHONUTF8": "0",
    "PYTHONCOERCECLOCALE": "0",
    "TZ": "Asia/Kathmandu",
    "PYTHONHASHSEED": "random",
} | dict.fromkeys(THREADS, "2")


@pytest.fixture
def calls(curvy_run, across_run, training_patches, tmp_path_factory):
    """Calls of verbs on patches, a run with images, and one whose terrain's name is not ASCII."""
    grass = shutil.copytree(curvy_run, tmp_path_factory.mktemp("runs") / "grass")
    with (grass / "run.toml").open("a", encoding="utf-8") as settings:
        settings.write('[run]\nterrain = "Gr\u00e4ser"\n')
    patches = tmp_path_factory.mktemp("patches")
    for number, (image, label, _) in enumerate(zip(*training_patches, strict=True)):
        (patches / label).mkdir(exist_ok=True)
        assert cv2.imwrite(str(patches / label / f"{number}.png"), image)
    return [
        f"check '{across_run}'",
        f"identify '{grass}' --model icr --starts 2 --out set.toml",
        f"train '{patches}' --metres-per-pixel 0.006 --patch-size 32 --out terrain.model",
        f"run '{across_run}' --model terrain.model --terrain gravel --out across",
        f"run '{grass}' --no-vision --parameters set.toml --out grass",
    ]


def contents(folder):
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture
def usual(calls, tmp_path_factory, monkeypatch):
    """The files that the verbs write in this process, with one thread (`conftest.py`), by name."""
    folder = tmp_path_factory.mktemp("usual")
    monkeypatch.chdir(folder)
    for line in calls:
        monkeypatch.setattr(sys, "argv", ["terrain-odometry", *shlex.split(line)])
        with pytest.raises(SystemExit) as ended:
            main()
        assert not ended.value.code, line
    return contents(folder)


@pytest.fixture
def unusual(calls, tmp_path_factory):
    """Those that they write in another process and environment."""
    folder = tmp_path_factory.mktemp("unusual")
    kept = {name: text for name, text in os.environ.items() if not name.startswith("LC_")}
    ended = subprocess.run(
        [sys.executable, "-c", VERBS, *calls],
        cwd=folder,
        env=kept | UNUSUAL,
        check=False,
        capture_output=True,
    )
    assert ended.returncode == 0, ended.stderr.decode(errors="replace")
    return contents(folder)


@pytest.mark.slow
@pytest.mark.drawn
def test_files_are_the_same_in_another_environment(usual, unusual):
    assert unusual.keys() == usual.keys()
    assert {"set.toml", "terrain.model", "across/report.html", "grass/result.json"} <= usual.keys()
    assert [name for name in usual if unusual[name] != usual[name]] == []
