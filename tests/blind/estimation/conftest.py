import numpy as np
import pytest

from tests.blind.faults.recordings import read_recording, table_text


@pytest.fixture
def recording(tmp_path):
    """A drive of 120 s: circles of changing radius at 0.8 m/s with a stop in the midst."""
    t = np.round(np.arange(0, 120, 0.1), 6)
    speed = 0.8 * np.clip(np.abs(t - 60) / 2, 0, 1)
    rate = 0.4 * np.sin(t / 9)
    yaw = np.r_[0, np.cumsum(rate[:-1] * np.diff(t))]
    x, y = (np.r_[0, np.cumsum((speed * f(yaw))[:-1] * np.diff(t))] for f in (np.cos, np.sin))
    folder = tmp_path / "clean"
    folder.mkdir()
    (folder / "run.toml").write_text("[robot]\ntrack_width = 0.5\n")
    odometry = {"t": t, "v_left": speed - rate / 2, "v_right": speed + rate / 2, "gyro_z": rate}
    (folder / "odometry.csv").write_text(table_text(odometry))
    (folder / "pose.csv").write_text(table_text({"t": t, "x": x, "y": y, "yaw": yaw}))
    return read_recording(folder)
