"""The same input gives the same bytes (rule S14); what a document holds is in ``test_contract``."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.helpers.paths import ROOT


@pytest.mark.slow
@pytest.mark.parametrize("form", ["text", "json", "turtle", "json-ld", "sarif", "cnil-pia"])
def test_the_bytes_are_the_same_in_every_process(form: str) -> None:
    """Across runs, hash seeds and the order in which files are named."""
    policies = ["examples/factory/after.policy.xml", "examples/care-home/care-home.policy.xml"]
    labels = ["examples/factory/run4.labels.yaml", "examples/care-home/care-home.labels.yaml"]
    outputs = set()
    for seed, order in (("0", 1), ("1", -1), ("4711", 1)):
        command = [sys.executable, "-m", "rosprivacy", "analyze", *policies[::order], "-f", form, "--paths", "all"]
        for file in labels:
            command += ["-l", file]
        environment = {**os.environ, "PYTHONHASHSEED": seed, "SOURCE_DATE_EPOCH": "1767225600"}
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, check=False)
        assert done.returncode == 1, done.stderr
        outputs.add(done.stdout)
    assert len(outputs) == 1
