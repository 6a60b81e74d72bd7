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

import rosprivacy
from tests.helpers.ci_files import (
    ACTION,
    CI,
    FACTORY,
    FROM_HERE,
    GIT,
    HOSTED,
    committed,
    hooks_repository,
    hostile,
    planted,
    tool,
)
from tests.helpers.paths import ROOT
from tests.helpers.sarif import checked

pytestmark = pytest.mark.slow  # each step of the action is a process


OF_PULL_REQUEST = "${{ github.event.pull_request.base.sha }}"  # nothing on a push


def steps_of(inputs: dict[str, str]) -> list[tuple[str, dict[str, str]]]:
    """(script, variables) of the action's steps, with inputs put in as GitHub does: in ``env`` only."""
    action = yaml.safe_load(ACTION.read_text("utf-8"))
    given = {name: str(said.get("default", "")) for name, said in action["inputs"].items()}
    given = {name: "" if value == OF_PULL_REQUEST else value for name, value in given.items()} | inputs
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


def test_the_action_takes_types(runner: dict[str, str], tmp_path: Path) -> None:
    shutil.copytree(FACTORY, tmp_path / "p")
    planted(tmp_path / "t.yaml", "types: 1\ntopics:\n  /safety_video: [{type: sensor_msgs/msg/Image}]\n")
    *_, done = run_action({**LEAK, "types": "t.yaml\n"}, runner, tmp_path)
    assert (done.returncode, done.stderr) == (1, "")
    assert "t.yaml" in (tmp_path / "rosprivacy.json").read_text("utf-8")


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


LEAK = {"policies": "p/before.policy.xml", "labels": "p/run2.labels.yaml"}
NOBODY = "decisions: 1\nfindings: []\n"


@pytest.fixture
def accepted() -> str:
    """A file of decisions that accepts all that the action finds in ``LEAK``."""
    (policy, labels) = (str(FACTORY / Path(name).name) for name in LEAK.values())
    found = rosprivacy.analyze(policy, labels).analysis.findings
    lines = [f"- {{id: {one.id}, decision: accept, reason: it has to be, owner: A. Person}}\n" for one in found]
    assert len(lines) == 2
    return f"decisions: 1\nfindings:\n{''.join(lines)}"


def pull_request(folder: Path, before: dict[str, str], after: dict[str, str]) -> str:
    """Make a repository whose checkout is a pull request; return the revision that it is for."""
    shutil.copytree(FACTORY, folder / "p")
    for name, text in before.items():
        planted(folder / name, text)
    committed(folder)
    done = subprocess.run([*GIT, "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True)
    for name in before.keys() - after.keys():
        (folder / name).unlink()
    for name, text in after.items():
        planted(folder / name, text)
    for command in (["add", "-A"], ["commit", "-qm", "mine", "--allow-empty"]):
        subprocess.run([*GIT, *command], cwd=folder, capture_output=True, check=True)
    return done.stdout.strip()


PROJECT = 'decisions = "d/decisions.yaml"\nfail-on = "{}"\n'


def test_a_pull_request_cannot_accept_its_own_findings(accepted: str, runner: dict[str, str], tmp_path: Path) -> None:
    """Neither by the project file and its decisions, nor by decisions that the workflow names."""
    before = {"rosprivacy.toml": PROJECT.format("undetermined"), "d/decisions.yaml": NOBODY}
    after = {"rosprivacy.toml": PROJECT.format("never"), "d/decisions.yaml": accepted}
    base = pull_request(tmp_path / "checkout", before, after)
    for more in ({}, {"options": "--decisions=d/decisions.yaml"}, {"decisions": "d/decisions.yaml"}):
        *_, done = run_action({**LEAK, "base": base, **more}, runner, tmp_path / "checkout")
        assert (done.returncode, done.stderr) == (1, "")
        assert outputs(runner)["findings"] == "2"


def test_what_the_base_accepts_is_accepted(accepted: str, runner: dict[str, str], tmp_path: Path) -> None:
    """Even if the pull request takes the files away."""
    before = {"rosprivacy.toml": PROJECT.format("leak"), "d/decisions.yaml": accepted}
    base = pull_request(tmp_path / "checkout", before, {})
    *_, done = run_action({**LEAK, "base": base}, runner, tmp_path / "checkout")
    assert (done.returncode, done.stderr) == (0, "")
    assert outputs(runner)["findings"] == "0"
    assert not any((tmp_path / "checkout" / name).exists() for name in before)
    *_, done = run_action({**LEAK, "base": base, "fail-on": "undetermined"}, runner, tmp_path / "checkout")
    assert done.returncode == 4  # the workflow asks for more


@pytest.mark.parametrize(("stated", "given", "code"), [("leak", "", 0), ("undetermined", "", 4), ("leak", "doubt", 4)])
def test_the_job_fails_on_what_the_base_says_if_the_workflow_says_nothing(
    stated: str, given: str, code: int, runner: dict[str, str], tmp_path: Path
) -> None:
    before = {"pyproject.toml": f'[tool.rosprivacy]\nfail-on = "{stated}"\n'}
    after = {"pyproject.toml": '[tool.rosprivacy]\nfail-on = "never"\n'}
    base = pull_request(tmp_path / "checkout", before, after)
    inputs = {"policies": "p/before.policy.xml", "labels": "p/run1.labels.yaml", "base": base}
    options = f"--fail-on={given}" if given else ""
    for more in ({"fail-on": given}, {"options": options}, {"options": options.replace("=", "\n")}):
        *_, done = run_action({**inputs, **more}, runner, tmp_path / "checkout")
        assert (done.returncode, done.stderr) == (code, "")


@pytest.mark.parametrize("link", [False, True])
def test_decisions_that_the_base_does_not_have_count_for_nothing(
    accepted: str, runner: dict[str, str], tmp_path: Path, *, link: bool
) -> None:
    planted(tmp_path / "elsewhere.yaml", accepted)
    base = pull_request(tmp_path / "checkout", {}, {} if link else {"decisions.yaml": accepted})
    if link:
        (tmp_path / "checkout" / "decisions.yaml").symlink_to("../elsewhere.yaml")
    inputs = {**LEAK, "base": base, "options": "--decisions\ndecisions.yaml"}
    *_, done = run_action(inputs, runner, tmp_path / "checkout")
    assert done.returncode == 1
    assert done.stderr == f"decisions.yaml: not in {base[:12]}, so nothing in it counts\n"
    outside = {**LEAK, "base": base, "options": f"--decisions\n{tmp_path / 'elsewhere.yaml'}", "fail-on": "leak"}
    *_, done = run_action(outside, runner, tmp_path / "checkout")
    assert (done.returncode, done.stderr) == (0, "")  # it is no part of the pull request


def test_a_base_that_has_none_of_it_changes_nothing(runner: dict[str, str], tmp_path: Path) -> None:
    base = pull_request(tmp_path / "checkout", {}, {"rosprivacy.toml": 'fail-on = "never"\n'})
    answers = []
    for given in ({"base": base}, {}):
        *_, done = run_action({**LEAK, **given}, runner, tmp_path / "checkout")
        answers.append((done.returncode, done.stderr, (tmp_path / "checkout" / "rosprivacy.json").read_bytes()))
    assert answers[0] == answers[1]
    assert answers[0][:2] == (1, "")


def test_a_base_that_is_not_there_is_fetched_or_refused(accepted: str, runner: dict[str, str], tmp_path: Path) -> None:
    whole = tmp_path / "whole"
    base = pull_request(whole, {"rosprivacy.toml": PROJECT.format("leak"), "d/decisions.yaml": accepted}, {})
    url, checkout = f"file://{whole}", tmp_path / "checkout"
    subprocess.run([*GIT, "clone", "-q", "--depth=1", url, str(checkout)], capture_output=True, check=True)
    *_, done = run_action({**LEAK, "base": base}, runner, checkout)
    assert (done.returncode, done.stderr) == (0, "")
    *_, done = run_action({**LEAK, "base": "0" * 40}, runner, checkout)
    assert done.returncode == 2
    assert re.fullmatch(f"{'0' * 40}: .+; .*fetch-depth: 0.*\n", done.stderr)


def pull_request_of_code(folder: Path, *edits: tuple[str, str, str]) -> str:
    """Make a repository of a robot's code whose checkout is a pull request; return the revision that it is for."""
    committed(shutil.copytree(ROOT / "examples" / "scan_robot", folder))
    for name, old, new in edits:
        text = (folder / name).read_text("utf-8")
        assert old in text
        planted(folder / name, text.replace(old, new))
    done = subprocess.run([*GIT, "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.strip()


NEW = {"policies": ".", "fail-on": "new"}
UPLOADER = "guide_perception/guide_perception/uploader.py"


def test_the_action_fails_on_a_new_way_out_of_code_and_names_its_line(runner: dict[str, str], tmp_path: Path) -> None:
    edits = [(UPLOADER, "pictures.example.org", "pictures.example.com")]
    base = pull_request_of_code(tmp_path / "checkout", *edits)
    *_, done = run_action({**NEW, "base": base}, runner, tmp_path / "checkout")
    assert (done.returncode, done.stderr) == (1, "")
    assert outputs(runner)["verdict"] == "undetermined"
    summary = Path(runner["GITHUB_STEP_SUMMARY"]).read_text("utf-8")
    assert "pictures.example.com" in summary
    assert f"{UPLOADER}:" in summary
    checked(json.loads((tmp_path / "checkout" / "rosprivacy.sarif").read_text("utf-8")))


def test_the_action_passes_code_that_has_nothing_new(runner: dict[str, str], tmp_path: Path) -> None:
    """Though a scan is undetermined, and though a pull request states that it never fails."""
    base = pull_request_of_code(tmp_path / "checkout", (UPLOADER, "import rclpy\n", "# a comment\n\nimport rclpy\n"))
    *_, done = run_action({**NEW, "base": base}, runner, tmp_path / "checkout")
    assert (done.returncode, done.stderr) == (0, "")
    *_, done = run_action({**NEW, "base": base, "fail-on": ""}, runner, tmp_path / "checkout")
    assert done.returncode == 4
    *_, done = run_action(NEW, runner, tmp_path / "checkout")  # a push: there is nothing to compare with
    assert (done.returncode, done.stderr) == (0, "")


def test_the_action_compares_policies_too(runner: dict[str, str], tmp_path: Path) -> None:
    """What the base has is not new, and what a label file of a pull request makes a finding of is."""
    base = pull_request(
        tmp_path / "checkout", {"l.yaml": "labels: 1\n"}, {"l.yaml": (FACTORY / "run2.labels.yaml").read_text()}
    )
    inputs = {**LEAK, "labels": "l.yaml", "fail-on": "new", "base": base}
    *_, done = run_action(inputs, runner, tmp_path / "checkout")
    assert done.returncode == 1
    *_, done = run_action({**inputs, "labels": "p/run2.labels.yaml"}, runner, tmp_path / "checkout")
    assert (done.returncode, done.stderr) == (0, "")


def test_nothing_of_a_hostile_checkout_of_code_runs_in_the_action(runner: dict[str, str], tmp_path: Path) -> None:
    checkout = tmp_path / "checkout"
    base = pull_request_of_code(checkout)
    config = (checkout / ".git" / "config").read_text("utf-8")
    trace = hostile(checkout)
    planted(checkout / ".git" / "config", config + (checkout / ".git" / "config").read_text("utf-8"))
    *_, done = run_action({**NEW, "base": base}, {**runner, **FROM_HERE}, checkout)
    assert not trace.exists(), trace.read_text("utf-8")
    assert done.returncode in (0, 1), done.stderr
    assert (tmp_path / "victim").read_text("utf-8") == "mine"
