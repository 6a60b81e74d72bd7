"""What people use in CI and before a commit: the action, the hook, the example workflow and the comment that it makes.

The scripts of the action are run as a runner does, with its files and variables; the hook by pre-commit itself, in a
repository made for it.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.helpers.paths import ROOT
from tests.helpers.sarif import HOSTILE, checked

ACTION, HOOKS, CI = ROOT / "action.yml", ROOT / ".pre-commit-hooks.yaml", ROOT / "examples" / "ci"
HOSTED = ROOT / ".github" / "workflows" / "ci.yml"
FACTORY = ROOT / "examples" / "factory"
GIT = ["git", "-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "init.defaultBranch=main"]


def tool(*arguments: str, cwd: Path = ROOT, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **variables}
    return subprocess.run(
        [sys.executable, "-m", *arguments], cwd=cwd, env=environment, capture_output=True, text=True, check=False
    )


# ---------------------------------------------------------------- the action


@pytest.fixture
def runner(tmp_path: Path) -> dict[str, str]:
    """What a runner gives to a step; rosprivacy is there already, as after the first step."""
    bin_folder = tmp_path / "temp" / "rosprivacy" / "bin"
    bin_folder.mkdir(parents=True)
    for name, words in (("python", ""), ("rosprivacy", "-P -m rosprivacy")):
        (bin_folder / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        (bin_folder / name).chmod(0o755)
    return {
        "RUNNER_TEMP": str(tmp_path / "temp"),
        "GITHUB_ACTION_PATH": str(ROOT),
        "GITHUB_OUTPUT": str(tmp_path / "output"),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md"),
    }


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


@pytest.mark.slow
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


def test_bad_input_ends_the_action_with_the_problem(runner: dict[str, str], tmp_path: Path) -> None:
    *_, done = run_action({"policies": "-x; echo hello"}, runner, tmp_path)
    assert done.returncode == 2
    assert "-x; echo hello: " in done.stderr
    assert done.stdout.splitlines()[-1].startswith("::")  # commands are read again
    assert "hello" not in done.stdout


def hostile(folder: Path) -> Path:
    """Fill a checkout with what a tool might run or import, and return the file that is then there."""
    trace = folder.parent / "ran"
    for name in TAKEN_FOR_MODULES:
        planted(folder / name, f"open({str(trace)!r}, 'a').write(__file__ + ' ')\n")
    for name in TAKEN_FOR_COMMANDS:
        planted(folder / name, f"#!/bin/sh\necho {name} >> '{trace}'\n").chmod(0o755)
    script = folder / "sed"
    planted(
        folder / ".git" / "config",
        f"[core]\nfsmonitor = {script}\nhooksPath = .git/hooks\n[diff]\nexternal = {script}\n",
    )
    planted(folder / "pyproject.toml", '[build-system]\nrequires = []\nbuild-backend = "setup"\nbackend-path = ["."]\n')
    planted(folder / "setup.cfg", "[metadata]\nname = attr: json.name\n")
    planted(folder / "pip.conf", "[install]\nindex-url = http://127.0.0.1:9/\n")
    planted(folder / "requirements.lock", "evil==1\n")
    planted(folder / "evil.pth", f"import os; open({str(trace)!r}, 'a').write('pth')\n")
    for name in ("rosprivacy.sarif", "rosprivacy.json"):  # what is written there would be written elsewhere
        (folder / name).symlink_to("../victim")
    planted(folder.parent / "victim", "mine")
    return trace


def planted(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, "utf-8")
    return file


TAKEN_FOR_MODULES = (
    *("json.py", "secrets.py", "re.py", "typing.py", "resource.py", "_compat_pickle.py", "sitecustomize.py"),
    *(
        "usercustomize.py",
        "setup.py",
        "yaml.py",
        "lxml/__init__.py",
        "rosprivacy/__init__.py",
        "rosprivacy/__main__.py",
    ),
    *("pip/__init__.py", "pip/__main__.py", "venv/__init__.py", "venv/__main__.py", "ensurepip/__main__.py"),
    *("setuptools/__init__.py", "setuptools/build_meta.py"),
)
TAKEN_FOR_COMMANDS = (
    *("python", "python3", "sed", "cat", "rm", "dirname", "git", "jq", ".bashrc", ".profile", ".bash_profile"),
    *(
        ".git/hooks/post-checkout",
        ".git/hooks/post-index-change",
        ".git/hooks/pre-commit",
        ".git/hooks/fsmonitor-watchman",
    ),
)
FROM_HERE = {"PYTHONPATH": f"{os.pathsep}/nowhere"}  # as `export PYTHONPATH=$PYTHONPATH:…` makes it: the current folder


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


def test_an_answer_that_the_checkout_brings_is_not_taken_for_ours(runner: dict[str, str], tmp_path: Path) -> None:
    """If the analysis fails, a later step must not find one."""
    for name in ("rosprivacy.sarif", "rosprivacy.json"):
        planted(tmp_path / "checkout" / name, '{"verdict": "no-leak-found", "findings": []}')
    *_, done = run_action({"policies": "none.policy.xml"}, runner, tmp_path / "checkout")
    assert done.returncode == 2
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


@pytest.mark.slow
def test_nothing_of_a_hostile_checkout_runs_while_the_action_installs(tmp_path: Path) -> None:
    """The first step too; and what it installs is what the lock names."""
    action, checkout = hooks_repository(tmp_path / "action"), tmp_path / "checkout"
    shutil.copytree(FACTORY, checkout / "p")
    trace = hostile(checkout)
    (tmp_path / "temp").mkdir()
    runner = {
        "RUNNER_TEMP": str(tmp_path / "temp"),
        "GITHUB_ACTION_PATH": str(action),
        "GITHUB_OUTPUT": str(tmp_path / "output"),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md"),
    }
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


@pytest.mark.slow
def test_a_file_with_another_hash_is_not_installed(tmp_path: Path) -> None:
    action = hooks_repository(tmp_path / "action")
    lock = (action / "requirements.lock").read_text("utf-8")
    (action / "requirements.lock").write_text(re.sub("sha256:[0-9a-f]{8}", "sha256:00000000", lock), "utf-8")
    (tmp_path / "temp").mkdir()
    runner = {"RUNNER_TEMP": str(tmp_path / "temp"), "GITHUB_ACTION_PATH": str(action)}
    (done,) = run_action({"python": sys.executable, "policies": "p"}, runner, tmp_path)
    assert done.returncode == 1
    assert "DO NOT MATCH THE HASHES" in done.stderr
    assert not (tmp_path / "temp" / "rosprivacy" / "bin" / "rosprivacy").exists()


@pytest.mark.slow
def test_the_action_installs_itself(tmp_path: Path) -> None:
    shutil.copytree(FACTORY, tmp_path / "p")
    (tmp_path / "temp").mkdir()
    runner = {
        "RUNNER_TEMP": str(tmp_path / "temp"),
        "GITHUB_ACTION_PATH": str(hooks_repository(tmp_path / "action")),
        "GITHUB_OUTPUT": str(tmp_path / "output"),
        "GITHUB_STEP_SUMMARY": str(tmp_path / "summary.md"),
        "PYTHONPATH": "",
    }
    inputs = {"policies": "p/after.policy.xml", "labels": "p/run5.labels.yaml", "python": sys.executable}
    done = run_action(inputs, runner, tmp_path)
    assert [step.returncode for step in done] == [0, 0], done[-1].stderr
    assert outputs(runner) == {"verdict": "no-leak-found", "findings": "0"}


# ---------------------------------------------------------------- the hook


def hooks_repository(folder: Path) -> Path:
    """This repository as it is now, with one commit: what pre-commit and GitHub fetch."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, check=True)
    for name in listed.stdout.decode().splitlines():
        source, target = ROOT / name, folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_symlink():
            target.symlink_to(source.readlink())
        elif source.is_file():
            shutil.copy(source, target)
    return committed(folder)


def committed(folder: Path) -> Path:
    for command in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "all"]):
        subprocess.run([*GIT, *command], cwd=folder, capture_output=True, check=True)
    return folder


def users_repository(folder: Path, hooks: Path, hook: dict[str, Any]) -> Path:
    """A repository with a policy, labels and a hook."""
    shutil.copytree(FACTORY, folder / "policies")
    revision = subprocess.run(["git", "rev-parse", "HEAD"], cwd=hooks, capture_output=True, text=True, check=True)
    config = {"repos": [{"repo": str(hooks), "rev": revision.stdout.strip(), "hooks": [{"id": "rosprivacy", **hook}]}]}
    (folder / ".pre-commit-config.yaml").write_text(json.dumps(config))
    return committed(folder)


def run_hook(folder: Path, tmp_path: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "PATH": path, "GIT_CONFIG_NOSYSTEM": "1"}
    return tool("pre_commit", "run", "--all-files", "--verbose", "--color=never", cwd=folder, **variables)


def arguments(run: int) -> list[str]:
    policy = "before" if run < 4 else "after"
    return [f"policies/{policy}.policy.xml", "--labels", f"policies/run{run}.labels.yaml"]


def test_the_hooks_are_what_pre_commit_takes() -> None:
    assert tool("pre_commit", "validate-manifest", str(HOOKS)).returncode == 0


def test_the_hook_fails_on_a_leak_and_passes_without_one(tmp_path: Path) -> None:
    """In the environment of the tests, so that nothing is fetched; how it is installed is the next test's."""
    hooks = tmp_path / "hooks"
    hooks.mkdir()
    shutil.copy(HOOKS, hooks)
    committed(hooks)
    entry = {"language": "system", "entry": f"{sys.executable} -m rosprivacy analyze"}
    leak = run_hook(users_repository(tmp_path / "leak", hooks, {**entry, "args": arguments(2)}), tmp_path)
    assert leak.returncode == 1, leak.stderr
    assert "where personal data can go" in leak.stdout
    assert "exit code: 1" in leak.stdout
    assert "Video: /safety_camera -> /archive_server" in leak.stdout
    clean = run_hook(users_repository(tmp_path / "clean", hooks, {**entry, "args": arguments(5)}), tmp_path)
    assert clean.returncode == 0, clean.stdout
    assert "Passed" in clean.stdout


def test_nothing_of_a_hostile_repository_runs_in_the_hook(tmp_path: Path) -> None:
    """Its own entry, in the environment of the tests; git and its hooks are pre-commit's business."""
    hooks = tmp_path / "hooks"
    hooks.mkdir()
    shutil.copy(HOOKS, hooks)
    committed(hooks)
    folder = users_repository(tmp_path / "user", hooks, {"language": "system", "args": arguments(2)})
    trace = tmp_path / "ran"
    for name in TAKEN_FOR_MODULES:
        planted(folder / name, f"open({str(trace)!r}, 'a').write(__file__ + ' ')\n")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "PATH": path, "GIT_CONFIG_NOSYSTEM": "1", **FROM_HERE}
    command = [sys.executable, "-I", "-m", "pre_commit", "run", "--all-files", "--verbose", "--color=never"]
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, **variables}, capture_output=True, text=True, check=False
    )
    assert not trace.exists(), trace.read_text("utf-8")
    assert "Video: /safety_camera -> /archive_server" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1


@pytest.mark.slow
def test_pre_commit_installs_the_hook_from_this_repository(tmp_path: Path) -> None:
    hooks = hooks_repository(tmp_path / "hooks")
    done = run_hook(users_repository(tmp_path / "user", hooks, {"args": arguments(2)}), tmp_path)
    assert "Video: /safety_camera -> /archive_server" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1


# ---------------------------------------------------------------- the comment on a pull request


def compare(tmp_path: Path, before: dict[str, Any], after: dict[str, Any]) -> str:
    files = [tmp_path / "before.json", tmp_path / "after.json"]
    for file, report in zip(files, (before, after), strict=True):
        file.write_text(json.dumps(report))
    done = tool("rosprivacy", "diff", *map(str, files), "--format", "markdown", "--fail-on", "never")
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def report_of(run: int) -> dict[str, Any]:
    policy = "before" if run < 4 else "after"
    done = tool(
        "rosprivacy", "analyze", f"{policy}.policy.xml", "-l", f"run{run}.labels.yaml", "-f", "json", cwd=FACTORY
    )
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_the_comment_says_what_is_new_and_what_is_gone(tmp_path: Path) -> None:
    run1, run2, run5 = report_of(1), report_of(2), report_of(5)
    new = compare(tmp_path, run1, run2)
    assert "**New ways to assess: 2**" in new
    assert "- `Video`: `node /safety_camera` → `node /archive_server`, allowed at `before.policy.xml:14`\n" in new
    assert "Verdict: `undetermined` before, `leak` now." in new
    assert "**Gone: 2**" in compare(tmp_path, run2, run5)
    same = compare(tmp_path, run2, run2)
    assert "No way to assess is new, gone or changed." in same
    assert "this is no legal verdict" in same


def test_what_was_not_analysed_before_is_all_new(tmp_path: Path) -> None:
    """The report that the workflow takes in its place."""
    steps = yaml.safe_load((CI / "privacy.yml").read_text("utf-8"))["jobs"]["paths-to-assess"]["steps"]
    (nothing,) = (step["env"]["NOTHING"] for step in steps if "NOTHING" in step.get("env", {}))
    comment = compare(tmp_path, json.loads(nothing), report_of(2))
    assert "**New ways to assess: 2**" in comment
    assert "Verdict: `not analysed before` before, `leak` now." in comment
    assert "Asked otherwise" not in comment


def test_no_name_can_link_or_mention_anybody(tmp_path: Path) -> None:
    after = report_of(2)
    for finding in after["findings"]:
        finding["leak"]["name"] = f"`@everyone ![x](http://e)\n# {HOSTILE}"
        finding["leak"]["robot"] = "`<img>"
    comment = compare(tmp_path, report_of(1), after)
    (line, *_) = [line for line in comment.splitlines() if "@everyone" in line]
    spans = re.fullmatch(r"- `[^`]+`: `[^`]+` → `[^`]+`, allowed at `[^`]+`", line)
    assert spans  # all that is named is inside code
    assert len(line) < 400
    assert line.isprintable()


def test_long_lists_are_cut_and_say_so(tmp_path: Path) -> None:
    after = report_of(2)
    one = after["findings"][0]
    after["findings"] = [{**one, "id": f"{i:016x}", "leak": {**one["leak"], "name": f"/l{i}x"}} for i in range(500)]
    comment = compare(tmp_path, report_of(1), after)
    assert "**New ways to assess: 500**" in comment
    assert "- and 480 more" in comment
    assert len(comment) < 10_000


def workflow() -> Any:
    return yaml.safe_load((CI / "privacy.yml").read_text("utf-8"))


def say_what_changes(runner: dict[str, str], checkout: Path, outcome: str, **more: str) -> str:
    """Run that step of the workflow, after an analysis of the pull request; return its comment."""
    (step,) = (step for step in workflow()["jobs"]["paths-to-assess"]["steps"] if "NOTHING" in step.get("env", {}))
    variables = {name: value for name, value in step["env"].items() if "${{" not in value} | {"BEFORE": outcome}
    environment = {**os.environ, **runner, **variables, **more, "FORK": "true"}
    command = ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]]
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
    assert "**New ways to assess: 2**" in comment
    assert ("**There is no baseline**: " in comment) == (outcome == "failure")
    before = "not analysed before" if outcome == "failure" else "undetermined"
    assert f"Verdict: `{before}` before, `leak` now." in comment


def test_nothing_of_a_hostile_checkout_runs_while_it_is_compared(runner: dict[str, str], tmp_path: Path) -> None:
    trace = hostile(tmp_path / "checkout")
    for name in ("before.json", "after.json"):
        planted(Path(runner["RUNNER_TEMP"], name), json.dumps(report_of(2)))
    comment = say_what_changes(runner, tmp_path / "checkout", "success", **FROM_HERE)
    assert not trace.exists(), trace.read_text("utf-8")
    assert "No way to assess is new, gone or changed." in comment


def test_who_reads_a_pull_request_can_write_nothing() -> None:
    """And who can write checks nothing out; the baseline is made before the pull request is there."""
    assert workflow()["permissions"] == {}
    for job in workflow()["jobs"].values():
        outs = [step["with"] for step in job["steps"] if step.get("uses", "").startswith("actions/checkout@")]
        assert all(out["persist-credentials"] is False for out in outs)
        assert not outs or job["permissions"] == {"contents": "read"}
    steps = workflow()["jobs"]["paths-to-assess"]["steps"]
    at = {step.get("name"): i for i, step in enumerate(steps)}
    assert at["Check out what the pull request is for"] < at["As it is"] < at["Check out what would be"]
    assert at["Check out what would be"] < at["As it would be"] < at["Say what changes"]
    for name in ("As it is", "As it would be"):
        assert all(steps[at[name]]["with"][kind].startswith("${{ runner.temp }}/") for kind in ("sarif", "json"))


def test_the_workflow_runs_what_is_there() -> None:
    steps = workflow()["jobs"]["paths-to-assess"]["steps"]
    inputs = yaml.safe_load(ACTION.read_text("utf-8"))["inputs"]
    ours = [step["with"] for step in steps if step.get("uses", "").endswith("/rosprivacy@main")]
    assert len(ours) == 2
    assert all(set(given) <= set(inputs) for given in ours)
    assert "pull_request_target" not in workflow()[True]  # YAML reads 'on' so
    assert not any("${{" in step.get("run", "") for job in workflow()["jobs"].values() for step in job["steps"])


# ---------------------------------------------------------------- our own checks, hosted and before a commit


def test_the_hosted_checks_are_those_of_ci_run_on_each_python_and_may_only_read() -> None:
    hosted = yaml.safe_load(HOSTED.read_text("utf-8"))
    assert hosted["permissions"] == {}
    assert "pull_request_target" not in hosted[True]  # YAML reads 'on' so
    (job,) = hosted["jobs"].values()
    assert job["permissions"] == {"contents": "read"}
    assert [step["run"] for step in job["steps"] if "run" in step] == [".ci/run 'not corpus'"]
    (out,) = (step["with"] for step in job["steps"] if step.get("uses", "").startswith("actions/checkout@"))
    assert out["persist-credentials"] is False
    classifiers = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["classifiers"]
    supported = [name.rpartition(" ")[2] for name in classifiers if re.search(r":: 3\.\d+$", name)]
    assert job["strategy"]["matrix"]["python"] == supported


def test_before_a_commit_runs_what_ci_runs_from_the_same_environment() -> None:
    file = ROOT / ".pre-commit-config.yaml"
    done = tool("pre_commit", "validate-config", str(file))
    assert done.returncode == 0, done.stdout
    (local,) = yaml.safe_load(file.read_text("utf-8"))["repos"]
    assert local["repo"] == "local"
    commands = (ROOT / ".ci" / "run").read_text("utf-8").splitlines()
    assert [hook["entry"] for hook in local["hooks"]] == [line for line in commands if line.startswith(".venv/bin/")]
    assert {hook["language"] for hook in local["hooks"]} == {"system"}
