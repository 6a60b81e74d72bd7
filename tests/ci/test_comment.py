"""The comment on a pull request, and the example workflow that makes it."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml

import rosprivacy
from tests.helpers.ci_files import ACTION, CI, FACTORY, FROM_HERE, hostile, planted
from tests.helpers.sarif import HOSTILE

if TYPE_CHECKING:
    from tests.helpers.command import Cli

WORKFLOW: Any = yaml.safe_load((CI / "privacy.yml").read_text("utf-8"))
STEPS = WORKFLOW["jobs"]["paths-to-assess"]["steps"]
(COMPARING,) = (step for step in STEPS if "NOTHING" in step.get("env", {}))


def compare(cli: Cli, folder: Path, before: dict[str, Any], after: dict[str, Any]) -> str:
    for name, report in (("before.json", before), ("after.json", after)):
        (folder / name).write_text(json.dumps(report))
    done = cli("diff", "before.json", "after.json", "--format", "markdown", "--fail-on", "never", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def report_of(run: int) -> dict[str, Any]:
    """What is said of one of the factory's runs."""
    policy = FACTORY / f"{'before' if run < 4 else 'after'}.policy.xml"
    report: dict[str, Any] = json.loads(rosprivacy.analyze(policy, FACTORY / f"run{run}.labels.yaml").to("json"))
    return report


def test_the_comment_says_what_is_new_and_what_is_gone(cli: Cli, tmp_path: Path) -> None:
    run1, run2, run5 = report_of(1), report_of(2), report_of(5)
    new = compare(cli, tmp_path, run1, run2)
    assert "**New paths to assess: 2**" in new
    assert "- `Video`: `node /safety_camera` → `node /archive_server`, allowed at `" in new
    assert "before.policy.xml:14`\n" in new
    assert "Verdict: `undetermined` before, `leak` now." in new
    assert "**Gone: 2**" in compare(cli, tmp_path, run2, run5)
    same = compare(cli, tmp_path, run2, run2)
    assert "No path to assess is new, gone or changed." in same
    assert "this is no legal verdict" in same


def test_what_was_not_analysed_before_is_all_new(cli: Cli, tmp_path: Path) -> None:
    """The report that the workflow takes in its place."""
    (tmp_path / "nothing.xml").write_text(COMPARING["env"]["NOTHING"], "utf-8")
    before = cli("analyze", "nothing.xml", "--fail-on", "never", "--format", "json", cwd=tmp_path)
    comment = compare(cli, tmp_path, json.loads(before.stdout), report_of(2))
    assert "**New paths to assess: 2**" in comment
    assert "Verdict: `undetermined` before, `leak` now." in comment
    assert "Asked otherwise" not in comment


@pytest.mark.slow
def test_no_name_can_link_or_mention_anybody_and_long_lists_are_cut(cli: Cli, tmp_path: Path) -> None:
    after = report_of(2)
    first = after["findings"][0]
    names = [f"`@everyone ![x](http://e)\n# {HOSTILE}{i}" for i in range(500)]
    leaks = [{**first["leak"], "name": name, "robot": "`<img>"} for name in names]
    after["findings"] = [
        {**first, "id": f"{i:016x}", "leak": leak, "witness": [*first["witness"][:-1], leak]}
        for i, leak in enumerate(leaks)
    ]
    comment = compare(cli, tmp_path, report_of(1), after)
    lines = [line for line in comment.splitlines() if "@everyone" in line]
    inside_code = re.compile(r"- `[^`]+`: `[^`]+` → `[^`]+`, allowed at `[^`]+`")
    assert all(inside_code.fullmatch(line) and len(line) < 400 and line.isprintable() for line in lines)
    assert lines
    assert "**New paths to assess: 500**" in comment
    assert "- and 480 more" in comment
    assert len(comment) < 10_000


def say_what_changes(runner: dict[str, str], checkout: Path, outcome: str, **more: str) -> str:
    """Run that step of the workflow, after an analysis of the pull request; return its comment."""
    variables = {name: value for name, value in COMPARING["env"].items() if "${{" not in value} | {"BEFORE": outcome}
    environment = {**os.environ, **runner, **variables, **more, "FORK": "true"}
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", COMPARING["run"]]
    done = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return Path(runner["GITHUB_STEP_SUMMARY"]).read_text("utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("outcome", ["failure", "success"])
def test_a_pull_request_is_not_its_own_baseline(outcome: str, runner: dict[str, str], tmp_path: Path) -> None:
    """It brings a before.json that says that nothing is new; and an analysis that failed leaves one half done."""
    new, old = json.dumps(report_of(2)), json.dumps(report_of(1))
    for name in ("before.json", "after.json"):
        planted(tmp_path / "checkout" / name, new)
    planted(Path(runner["RUNNER_TEMP"], "after.json"), new)
    planted(Path(runner["RUNNER_TEMP"], "before.json"), new if outcome == "failure" else old)
    comment = say_what_changes(runner, tmp_path / "checkout", outcome)
    assert "**New paths to assess: 2**" in comment
    assert ("**There is no baseline**: " in comment) == (outcome == "failure")
    assert "Verdict: `undetermined` before, `leak` now." in comment


@pytest.mark.slow
def test_nothing_of_a_hostile_checkout_runs_while_it_is_compared(runner: dict[str, str], tmp_path: Path) -> None:
    trace = hostile(tmp_path / "checkout")
    for name in ("before.json", "after.json"):
        planted(Path(runner["RUNNER_TEMP"], name), json.dumps(report_of(2)))
    comment = say_what_changes(runner, tmp_path / "checkout", "success", **FROM_HERE)
    assert not trace.exists(), trace.read_text("utf-8")
    assert "No path to assess is new, gone or changed." in comment


def test_who_reads_a_pull_request_can_write_nothing() -> None:
    """And who can write checks nothing out; the baseline is made before the pull request is there."""
    assert WORKFLOW["permissions"] == {}
    for job in WORKFLOW["jobs"].values():
        outs = [step["with"] for step in job["steps"] if step.get("uses", "").startswith("actions/checkout@")]
        assert all(out["persist-credentials"] is False for out in outs)
        assert not outs or job["permissions"] == {"contents": "read"}
    at = {step.get("name"): i for i, step in enumerate(STEPS)}
    assert at["Check out what the pull request is for"] < at["As it is"] < at["Check out what would be"]
    assert at["Check out what would be"] < at["As it would be"] < at["Say what changes"]
    for name in ("As it is", "As it would be"):
        assert all(STEPS[at[name]]["with"][kind].startswith("${{ runner.temp }}/") for kind in ("sarif", "json"))


def test_the_workflow_runs_what_is_there() -> None:
    inputs = yaml.safe_load(ACTION.read_text("utf-8"))["inputs"]
    ours = [step["with"] for step in STEPS if step.get("uses", "").endswith("/rosprivacy@v0.2.0")]
    assert len(ours) == 2
    assert all(set(given) <= set(inputs) for given in ours)
    assert "pull_request_target" not in WORKFLOW[True]  # YAML reads 'on' so
    assert not any("${{" in step.get("run", "") for job in WORKFLOW["jobs"].values() for step in job["steps"])
