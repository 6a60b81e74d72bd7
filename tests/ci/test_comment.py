"""The comment on a pull request, and the example workflow that makes it."""

from __future__ import annotations

import json
import os
import re
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.helpers.ci_files import ACTION, CI, FACTORY, FROM_HERE, hostile, planted, tool
from tests.helpers.sarif import HOSTILE

WORKFLOW: Any = yaml.safe_load((CI / "privacy.yml").read_text("utf-8"))
STEPS = WORKFLOW["jobs"]["paths-to-assess"]["steps"]
(COMPARING,) = (step for step in STEPS if "NOTHING" in step.get("env", {}))
pytestmark = pytest.mark.slow  # each comment is made by processes


def compare(tmp_path: Path, before: dict[str, Any], after: dict[str, Any]) -> str:
    for name, report in (("before.json", before), ("after.json", after)):
        (tmp_path / name).write_text(json.dumps(report))
    command = ("rosprivacy", "diff", "before.json", "after.json", "--format", "markdown", "--fail-on", "never")
    done = tool(*command, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@cache
def _report_text(run: int) -> str:
    policy = "before" if run < 4 else "after"
    command = ("rosprivacy", "analyze", f"{policy}.policy.xml", "-l", f"run{run}.labels.yaml", "-f", "json")
    return tool(*command, cwd=FACTORY).stdout


def report_of(run: int) -> dict[str, Any]:
    """What is said of one of the factory's runs."""
    report: dict[str, Any] = json.loads(_report_text(run))
    return report


def test_the_comment_says_what_is_new_and_what_is_gone(tmp_path: Path) -> None:
    run1, run2, run5 = report_of(1), report_of(2), report_of(5)
    new = compare(tmp_path, run1, run2)
    assert "**New paths to assess: 2**" in new
    assert "- `Video`: `node /safety_camera` → `node /archive_server`, allowed at `before.policy.xml:14`\n" in new
    assert "Verdict: `undetermined` before, `leak` now." in new
    assert "**Gone: 2**" in compare(tmp_path, run2, run5)
    same = compare(tmp_path, run2, run2)
    assert "No path to assess is new, gone or changed." in same
    assert "this is no legal verdict" in same


def test_what_was_not_analysed_before_is_all_new(tmp_path: Path) -> None:
    """The report that the workflow takes in its place."""
    (tmp_path / "nothing.xml").write_text(COMPARING["env"]["NOTHING"], "utf-8")
    before = tool("rosprivacy", "analyze", "nothing.xml", "--fail-on", "never", "--format", "json", cwd=tmp_path)
    comment = compare(tmp_path, json.loads(before.stdout), report_of(2))
    assert "**New paths to assess: 2**" in comment
    assert "Verdict: `undetermined` before, `leak` now." in comment
    assert "Asked otherwise" not in comment


def test_no_name_can_link_or_mention_anybody(tmp_path: Path) -> None:
    after = report_of(2)
    for finding in after["findings"]:
        finding["leak"]["name"] = f"`@everyone ![x](http://e)\n# {HOSTILE}"
        finding["leak"]["robot"] = "`<img>"
        finding["witness"][-1] = finding["leak"]
    comment = compare(tmp_path, report_of(1), after)
    (line, *_) = [line for line in comment.splitlines() if "@everyone" in line]
    spans = re.fullmatch(r"- `[^`]+`: `[^`]+` → `[^`]+`, allowed at `[^`]+`", line)
    assert spans  # all that is named is inside code
    assert len(line) < 400
    assert line.isprintable()


def test_long_lists_are_cut_and_say_so(tmp_path: Path) -> None:
    after = report_of(2)
    one = after["findings"][0]
    leaks = [{**one["leak"], "name": f"/l{i}x"} for i in range(500)]
    witness = one["witness"][:-1]
    after["findings"] = [
        {**one, "id": f"{i:016x}", "leak": leak, "witness": [*witness, leak]} for i, leak in enumerate(leaks)
    ]
    comment = compare(tmp_path, report_of(1), after)
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
    ours = [step["with"] for step in STEPS if step.get("uses", "").endswith("/rosprivacy@main")]
    assert len(ours) == 2
    assert all(set(given) <= set(inputs) for given in ours)
    assert "pull_request_target" not in WORKFLOW[True]  # YAML reads 'on' so
    assert not any("${{" in step.get("run", "") for job in WORKFLOW["jobs"].values() for step in job["steps"])
