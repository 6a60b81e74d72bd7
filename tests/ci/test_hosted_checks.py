"""Our own checks, hosted and before a commit."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest
import yaml

from rosprivacy.analysis.python_311 import tomllib
from tests.helpers.ci_files import HOSTED, tool
from tests.helpers.paths import ROOT


def test_the_hosted_checks_are_those_of_ci_run_on_each_python_and_may_only_read() -> None:
    hosted = yaml.safe_load(HOSTED.read_text("utf-8"))
    assert hosted["permissions"] == {}
    assert "pull_request_target" not in hosted[True]  # YAML reads 'on' so
    job, everyday = hosted["jobs"]["checks"], hosted["jobs"]["everyday"]
    assert all(each["permissions"] == {"contents": "read"} for each in hosted["jobs"].values())
    (run,) = (step for step in job["steps"] if "run" in step)
    assert run["run"] == ".ci/run 'not corpus' $THOROUGH"
    assert run["env"] == {"THOROUGH": "${{ github.event_name == 'schedule' && '--thorough' || '' }}"}
    assert set(hosted[True]) == {"pull_request", "push", "schedule"}
    for each in hosted["jobs"].values():
        (out,) = (step["with"] for step in each["steps"] if step.get("uses", "").startswith("actions/checkout@"))
        assert out["persist-credentials"] is False
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    supported = [name.rpartition(" ")[2] for name in project["classifiers"] if re.search(r":: 3\.\d+$", name)]
    oldest, newest = everyday["strategy"]["matrix"]["python"]
    assert [oldest, *job["strategy"]["matrix"]["python"], newest] == supported
    assert project["requires-python"] == f">={oldest}"


def test_before_a_commit_runs_what_ci_runs_from_the_same_environment() -> None:
    file = ROOT / ".pre-commit-config.yaml"
    done = tool("pre_commit", "validate-config", str(file))
    assert done.returncode == 0, done.stdout
    (local,) = yaml.safe_load(file.read_text("utf-8"))["repos"]
    assert local["repo"] == "local"
    commands = (ROOT / ".ci" / "run").read_text("utf-8").splitlines()
    checks = [line for line in commands if line.startswith(".venv/bin/") and not line.startswith(".venv/bin/python")]
    assert [hook["entry"] for hook in local["hooks"]] == checks
    assert {hook["language"] for hook in local["hooks"]} == {"system"}


@pytest.mark.slow
@pytest.mark.parametrize(("option", "taken"), [("--slow", False), ("--thorough", True)])
def test_only_the_run_of_each_week_builds_for_minutes(option: str, taken: bool) -> None:  # noqa: FBT001 - a row
    """What is not taken is not skipped either: CI calls a skip a failure."""
    file = "tests/ingest/running/test_ros2_client.py"
    command = [sys.executable, "-m", "pytest", "-n0", "--collect-only", "-q", option, file]
    environment = os.environ | {"PYTEST_ADDOPTS": ""}  # another verbosity lists them otherwise
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    assert (f"{file}::test_" in done.stdout) is taken, done.stdout
