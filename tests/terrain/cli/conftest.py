import pytest

from tests.terrain.cli.identify_calls import command

__all__ = ["command"]


@pytest.fixture
def no_report(monkeypatch):
    """`run` without figures and page, for tests that read the other files."""
    monkeypatch.setattr("terrain.report.page.write_report", lambda *_, **__: None)
