"""The action: its scripts are run as a runner does, with its files and variables."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from tests.helpers.ci_files import ACTION, CI, FACTORY, FROM_HERE, HOSTED, hooks_repository, hostile, planted, tool
from tests.helpers.paths import ROOT
from tests.helpers.sarif import checked

pytestmark = pytest.mark.slow  # each step of the action is a process


def steps_of(inputs: dict[str, str]) -> list[tuple[str, dict[str, str]]]:
    """(script, variables) of the action's steps, with inputs put in as GitHub does: in ``env`` only."""
    action = yaml.safe_load(ACTION.read_text("utf-8"))
    given = {name: str(said.get("default", "")) for name, said in action["inputs"].items()} | inputs
    found = []
    for step in action["runs"]["steps"]:
        assert "${{" not in step["run"]  # a script that an input could change
        assert step["shell"] == "bash"
        variables = {
            name: re.sub(r"\$\{\{ inputs\.([\w-]+) \}\}", lambda match: given[match[1]], value)
            for name, value in step["env"].items()
        }
        found.append((step["run"], variables))
    return found


def run_action(inputs: dict[str, str], runner: dict[str, str], cwd: Path) -> list[subprocess.CompletedProcess[str]]:
    done = []
    for script, variables in steps_of(inputs):
        environment = {**os.environ, **runner, **variables}
        command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", script]
        done.append(subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False))
        if done[-1].returncode:
            break
    return done


def outputs(runner: dict[str, str]) -> dict[str, str]:
    return dict(line.split("=", 1) for line in Path(runner["GITHUB_OUTPUT"]).read_text().splitlines())


def test_the_action_and_the_workflows_are_what_github_takes() -> None:
    kinds = {ACTION: "github-actions", CI / "privacy.yml": "github-workflows", HOSTED: "github-workflows"}
    for file, kind in kinds.items():
        done = tool("check_jsonschema", "--builtin-schema", f"vendor.{kind}", str(file))
        assert done.returncode == 0, done.stdout


def test_the_action_writes_sarif_json_a_summary_and_outputs(runner: dict[str, str], tmp_path: Path) -> None:
    shutil.copytree(FACTORY, tmp_path / "my policies")
    inputs = {"policies": "my policies/before.policy.xml\n", "labels": "my policies/run2.labels.yaml\n\n"}
    *_, done = run_action(inputs, runner, tmp_path)
    assert (done.returncode, done.stderr) == (1, "")
    assert outputs(runner) == {"verdict": "leak", "findings": "2"}
    checked(json.loads((tmp_path / "rosprivacy.sarif").read_text("utf-8")))
    assert len(json.loads((tmp_path / "rosprivacy.json").read_text("utf-8"))["findings"]) == 2
    summary = Path(runner["GITHUB_STEP_SUMMARY"]).read_text("utf-8").splitlines()
    assert "    leak: data can reach a leak" in summary
    assert all(line.startswith("    ") for line in summary)
    first, *lines, last = done.stdout.splitlines()
    assert first == f"::stop-commands::{last.strip(':')}"
    assert "leak: data can reach a leak" in lines


@pytest.mark.parametrize(("fail_on", "code"), [("never", 0), ("leak", 0), ("undetermined", 4), ("", 4)])
def test_the_action_fails_when_it_is_told_to(fail_on: str, code: int, runner: dict[str, str], tmp_path: Path) -> None:
    shutil.copytree(FACTORY, tmp_path / "p")
    inputs = {"policies": "p/before.policy.xml", "labels": "p/run1.labels.yaml"}
    inputs |= {"fail-on": fail_on} if fail_on else {}  # else as it is by default
    inputs |= {"options": "--view\nenforced" if fail_on == "never" else "", "json": "out.json"}
    *_, done = run_action(inputs, runner, tmp_path)
    assert done.returncode == code, done.stderr
    assert outputs(runner)["verdict"] == "undetermined"
    view = json.loads((tmp_path / "out.json").read_text("utf-8"))["view"]
    assert view == ("enforced" if fail_on == "never" else "declared")


def test_nothing_of_a_hostile_checkout_runs_in_the_action(runner: dict[str, str], tmp_path: Path) -> None:
    checkout = tmp_path / "checkout"
    shutil.copytree(FACTORY, checkout / "p")
    trace = hostile(checkout)
    inputs = {"policies": "p/before.policy.xml", "labels": "p/run2.labels.yaml"}
    tokens = set()
    for _ in range(2):
        *_, done = run_action(inputs, {**runner, **FROM_HERE}, checkout)
        assert not trace.exists(), trace.read_text("utf-8")
        assert done.returncode == 1, done.stderr
        assert outputs(runner) == {"verdict": "leak", "findings": "2"}
        tokens.add(re.match("::stop-commands::([0-9a-f]{32})\n", done.stdout)[1])  # type: ignore[index] # or it fails
    assert len(tokens) == 2
    assert (tmp_path / "victim").read_text("utf-8") == "mine"
    assert json.loads((checkout / "rosprivacy.json").read_text("utf-8"))["verdict"] == "leak"


def test_bad_input_ends_the_action_with_the_problem(runner: dict[str, str], tmp_path: Path) -> None:
    """No input is part of a script; and answers that the checkout brings are not there for a later step."""
    for name in ("rosprivacy.sarif", "rosprivacy.json"):
        planted(tmp_path / "checkout" / name, '{"verdict": "no-leak-found", "findings": []}')
    *_, done = run_action({"policies": "-x; echo hello"}, runner, tmp_path / "checkout")
    assert done.returncode == 2
    assert "-x; echo hello: " in done.stderr
    assert done.stdout.splitlines()[-1].startswith("::")  # commands are read again
    assert "hello" not in done.stdout
    assert list((tmp_path / "checkout").iterdir()) == []
    assert not Path(runner["GITHUB_OUTPUT"]).exists()


def test_the_action_writes_through_no_linked_folder(runner: dict[str, str], tmp_path: Path) -> None:
    shutil.copytree(FACTORY, tmp_path / "checkout" / "p")
    planted(tmp_path / "elsewhere" / "out.json", "mine")
    (tmp_path / "checkout" / "out").symlink_to(tmp_path / "elsewhere")
    inputs = {"policies": "p/before.policy.xml", "labels": "p/run2.labels.yaml", "json": "out/out.json"}
    *_, done = run_action(inputs, runner, tmp_path / "checkout")
    assert done.returncode == 2
    assert done.stderr == "out/out.json: it is behind a link of the checkout; name a file in a real folder\n"
    assert (tmp_path / "elsewhere" / "out.json").read_text("utf-8") == "mine"


@pytest.mark.thorough
def test_nothing_of_a_hostile_checkout_runs_while_the_action_installs(runner: dict[str, str], tmp_path: Path) -> None:
    """The first step too; and what it installs is what the lock names."""
    action, checkout = hooks_repository(tmp_path / "action"), tmp_path / "checkout"
    shutil.copytree(FACTORY, checkout / "p")
    trace = hostile(checkout)
    shutil.rmtree(runner["RUNNER_TEMP"] + "/rosprivacy")
    runner["GITHUB_ACTION_PATH"] = str(action)
    inputs = {"policies": "p/before.policy.xml", "labels": "p/run2.labels.yaml", "python": sys.executable}
    done = run_action(inputs, {**runner, **FROM_HERE}, checkout)
    assert not trace.exists(), trace.read_text("utf-8")
    assert [step.returncode for step in done] == [0, 1], done[-1].stderr
    assert outputs(runner) == {"verdict": "leak", "findings": "2"}
    pip = [str(tmp_path / "temp" / "rosprivacy" / "bin" / "python"), "-I", "-m", "pip", "freeze", "--all"]
    there = subprocess.run(pip, capture_output=True, text=True, check=True).stdout
    lock = (ROOT / "requirements.lock").read_text("utf-8")
    locked, known = ({alike(line.split(" ")[0]) for line in text.splitlines()} for text in (lock, there))
    assert {line for line in known - locked if not line.startswith("pip==")} == {"rosprivacy"}
    assert any(line.startswith("setuptools==") for line in known)


def alike(pin: str) -> str:
    """A pin with its name written as all tools take for the same."""
    return re.sub("[-_.]+", "-", pin.lower())


def test_a_file_with_another_hash_is_not_installed(runner: dict[str, str], tmp_path: Path) -> None:
    action = hooks_repository(tmp_path / "action")
    lock = (action / "requirements.lock").read_text("utf-8")
    (action / "requirements.lock").write_text(re.sub("sha256:[0-9a-f]{8}", "sha256:00000000", lock), "utf-8")
    shutil.rmtree(runner["RUNNER_TEMP"] + "/rosprivacy")
    runner["GITHUB_ACTION_PATH"] = str(action)
    (done,) = run_action({"python": sys.executable, "policies": "p"}, runner, tmp_path)
    assert done.returncode == 1
    assert "DO NOT MATCH THE HASHES" in done.stderr
    assert not (tmp_path / "temp" / "rosprivacy" / "bin" / "rosprivacy").exists()
