"""The remedy of noisy positions is printed by every verb; not all have --position-sigma."""

import re

import numpy as np

from odometry.checks.recording import check_recording
from terrain.cli.batch import batch
from terrain.cli.compare import compare
from terrain.cli.identify import identify
from terrain.cli.run import run
from terrain.config import Config
from tests.odometry.checks.test_other_robots import drive


def test_the_remedy_names_options_that_the_verbs_have(tmp_path):
    at_s = 0.05 * np.arange(4000)
    noisy = drive(np.full(4000, 0.7), 0.3 * np.sin(at_s / 4), sigma_m=0.5)
    (finding,) = [one for one in check_recording(noisy).findings if one.name == "noisy_positions"]
    *of_fits, of_run = re.findall(r"--[a-z-]+", finding.remedy)
    assert of_fits == ["--position-sigma", "--horizon"]
    for verb, options in {
        identify: of_fits,
        compare: of_fits,
        run: [of_run],
        batch: [of_run],
    }.items():
        assert set(options) <= {name for parameter in verb.params for name in parameter.opts}
        assert verb.name in finding.remedy
    (line,) = re.findall(r"position_sigma_m = [\d.]+", finding.remedy)
    file = tmp_path / "config.toml"
    file.write_text(f"[filter]\n{line}\n")
    assert 0.3 < Config.read(file).filter.position_sigma_m < 0.7
