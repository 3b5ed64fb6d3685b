import pickle
from dataclasses import replace
from hashlib import sha256

import pytest

from odometry.checks.recording import check_recording
from odometry.recording.run import Run
from tests.terrain.cli.identify_calls import command

__all__ = ["command"]


@pytest.fixture
def no_report(monkeypatch):
    """`run` without figures and page, for tests that read the other files."""
    monkeypatch.setattr("terrain.report.page.write_report", lambda *_, **__: None)


CHECKED = {}


@pytest.fixture(autouse=True)
def _checked_once(monkeypatch):
    """What the check finds in a recording of the same content: most verbs read the same drives."""

    def check(run):
        if not isinstance(run, Run):
            return check_recording(run)
        content = sha256(pickle.dumps(replace(run, folder=None))).digest()
        if content not in CHECKED:
            CHECKED[content] = check_recording(run)
        return replace(CHECKED[content], folder=run.folder)

    monkeypatch.setattr("terrain.checks.recording.check_recording", check)
