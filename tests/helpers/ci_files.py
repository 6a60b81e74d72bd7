"""The files that people use in CI, and a hostile checkout."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

ACTION, HOOKS, CI = ROOT / "action.yml", ROOT / ".pre-commit-hooks.yaml", ROOT / "examples" / "ci"
HOSTED = ROOT / ".github" / "workflows" / "ci.yml"
FACTORY = ROOT / "examples" / "factory"
GIT = ["git", "-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "init.defaultBranch=main"]


def tool(*arguments: str, cwd: Path = ROOT, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **variables}
    return subprocess.run(
        [sys.executable, "-m", *arguments], cwd=cwd, env=environment, capture_output=True, text=True, check=False
    )


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
    *(".git/hooks/post-checkout", ".git/hooks/post-index-change", ".git/hooks/pre-commit"),
    ".git/hooks/fsmonitor-watchman",
)
FROM_HERE = {"PYTHONPATH": f"{os.pathsep}/nowhere"}  # as `export PYTHONPATH=$PYTHONPATH:…` makes it: the current folder


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


def arguments(run: int) -> list[str]:
    policy = "before" if run < 4 else "after"
    return [f"policies/{policy}.policy.xml", "--labels", f"policies/run{run}.labels.yaml"]
