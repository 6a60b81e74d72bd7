"""The hook before a commit, run by pre-commit itself in a repository made for it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

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


def run_hook(folder: Path, tmp_path: Path, **more: str) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    variables = {"PRE_COMMIT_HOME": str(tmp_path / "home"), "PATH": path, "GIT_CONFIG_NOSYSTEM": "1", **more}
    command = [sys.executable, "-I", "-m", "pre_commit", "run", "--all-files", "--verbose", "--color=never"]
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
    assert "Video: /safety_camera -> /archive_server" in leak.stdout
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
    assert "Video: /safety_camera -> /archive_server" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1


@pytest.mark.thorough  # an environment with all that rosprivacy needs is made
def test_pre_commit_installs_the_hook_from_this_repository(tmp_path: Path) -> None:
    hooks = hooks_repository(tmp_path / "hooks")
    done = run_hook(users_repository(tmp_path / "user", hooks, {"args": arguments(2)}), tmp_path)
    assert "Video: /safety_camera -> /archive_server" in done.stdout, done.stdout + done.stderr
    assert done.returncode == 1
