"""The hook before a commit, run by pre-commit itself in a repository made for it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import rosprivacy
from tests.helpers.ci_files import (
    FACTORY,
    FROM_HERE,
    HOOKS,
    TAKEN_FOR_MODULES,
    arguments,
    committed,
    hooks_repository,
    planted,
    tool,
)

pytestmark = pytest.mark.slow  # pre-commit is a process, and makes repositories


def users_repository(folder: Path, hooks: Path, hook: dict[str, Any]) -> Path:
    """A repository with a policy, labels and a hook."""
    shutil.copytree(FACTORY, folder / "policies")
    revision = subprocess.run(["git", "rev-parse", "HEAD"], cwd=hooks, capture_output=True, text=True, check=True)
    config = {"repos": [{"repo": str(hooks), "rev": revision.stdout.strip(), "hooks": [{"id": "rosprivacy", **hook}]}]}
    (folder / ".pre-commit-config.yaml").write_text(json.dumps(config))
    return committed(folder)


def run_hook(folder: Path, tmp_path: Path, *which: str, **more: str) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "PATH": path, "GIT_CONFIG_NOSYSTEM": "1", **more}
    command = [
        sys.executable,
        "-I",
        "-m",
        "pre_commit",
        "run",
        *(which or ["--all-files"]),
        "--verbose",
        "--color=never",
    ]
    environment = {**os.environ, **variables}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture
def hooks(tmp_path: Path) -> Path:
    """A repository that brings the hook alone."""
    (tmp_path / "hooks").mkdir()
    shutil.copy(HOOKS, tmp_path / "hooks")
    return committed(tmp_path / "hooks")


def test_the_hooks_are_what_pre_commit_takes() -> None:
    assert tool("pre_commit", "validate-manifest", str(HOOKS)).returncode == 0


def test_the_hook_fails_on_a_leak_and_passes_without_one(hooks: Path, tmp_path: Path) -> None:
    """In the environment of the tests, so that nothing is fetched; how it is installed is the last test's."""
    entry = {"language": "system", "entry": f"{sys.executable} -m rosprivacy analyze"}
    leak = run_hook(users_repository(tmp_path / "leak", hooks, {**entry, "args": arguments(2)}), tmp_path)
    assert leak.returncode == 1, leak.stderr
    assert "where personal data can go" in leak.stdout
    assert "exit code: 1" in leak.stdout
    assert "1. /archive_server: Video" in leak.stdout
    clean = run_hook(users_repository(tmp_path / "clean", hooks, {**entry, "args": arguments(5)}), tmp_path)
    assert clean.returncode == 0, clean.stdout
    assert "Passed" in clean.stdout


def test_nothing_of_a_hostile_repository_runs_in_the_hook(hooks: Path, tmp_path: Path) -> None:
    """Its own entry, in the environment of the tests; git and its hooks are pre-commit's business."""
    folder = users_repository(tmp_path / "user", hooks, {"language": "system", "args": arguments(2)})
    trace = tmp_path / "ran"
    for name in TAKEN_FOR_MODULES:
        planted(folder / name, f"open({str(trace)!r}, 'a').write(__file__ + ' ')\n")
    done = run_hook(folder, tmp_path, **FROM_HERE)
    assert not trace.exists(), trace.read_text("utf-8")
    assert "1. /archive_server: Video" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1


PROJECT = 'policies = "policies/before.policy.xml"\nlabels = "policies/run2.labels.yaml"\ndecisions = "d.yaml"\n'
LESS = {"language": "system", "entry": "python -I -m rosprivacy.cli.hook --fail-on leak"}


@pytest.mark.parametrize("words", [(), tuple(arguments(2))])
def test_in_ci_the_hook_takes_decisions_from_the_revision_that_is_compared_with(
    hooks: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    """A pull request accepts nothing of its own; and what is accepted already stays so. A person's own commit does."""
    labels = str(FACTORY / "run2.labels.yaml")
    findings = rosprivacy.analyze(str(FACTORY / "before.policy.xml"), labels).analysis.findings
    accepted = [f"- {{id: {one.id}, decision: accept, reason: it has to be, owner: A. P.}}\n" for one in findings]
    folder = users_repository(tmp_path / "user", hooks, {**LESS, "args": [*words]})
    revisions = []
    for text in ("", *accepted[:1], "".join(accepted), "".join(accepted) + "# more\n"):
        planted(folder / "rosprivacy.toml", PROJECT)
        planted(folder / "d.yaml", f"decisions: 1\nfindings:\n{text}")
        committed(folder)
        done = subprocess.run(["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True)
        revisions.append(done.stdout.strip())
    codes = []
    for base, head in pairwise(revisions):
        subprocess.run(["git", "checkout", "-q", head], cwd=folder, check=True)
        done = run_hook(folder, tmp_path, "--from-ref", base, "--to-ref", head)
        codes.append(done.returncode)
        assert ("exit code: 1" in done.stdout) == bool(done.returncode), done.stdout + done.stderr
    assert codes == [1, 1, 0]
    assert run_hook(folder, tmp_path).returncode == 0


def test_no_name_of_a_project_file_is_an_option_of_the_hook(hooks: Path, tmp_path: Path) -> None:
    """The pull request writes the project file that says which policies there are."""
    folder = users_repository(tmp_path / "user", hooks, LESS)
    shutil.copy(folder / "policies" / "before.policy.xml", folder / "policies" / "x.xml")
    hostile_name = '["policies/before.policy.xml", "--fail-on=never"]'
    planted(folder / "rosprivacy.toml", PROJECT.replace('"policies/before.policy.xml"', hostile_name))
    committed(folder)
    done = run_hook(folder, tmp_path, "--from-ref", "HEAD~1", "--to-ref", "HEAD")
    assert done.returncode == 1
    assert "--fail-on=never: file not found" in done.stdout


@pytest.mark.thorough  # an environment with all that rosprivacy needs is made
def test_pre_commit_installs_the_hook_from_this_repository(tmp_path: Path) -> None:
    hooks = hooks_repository(tmp_path / "hooks")
    done = run_hook(users_repository(tmp_path / "user", hooks, {"args": arguments(2)}), tmp_path)
    assert "1. /archive_server: Video" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1
