"""What a release needs is here, and a release is refused while a part of it is not true (``.ci/release_check.py``)."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from types import ModuleType

pytest.importorskip("tomllib", reason="the check before a release needs Python 3.11")
SCHEMAS = {
    "vendor.github-workflows": [".github/workflows/*.yml", "examples/ci/*.yml"],
    "vendor.github-actions": ["action.yml"],
    "vendor.dependabot": [".github/dependabot.yml"],
    "vendor.github-issue-forms": [".github/ISSUE_TEMPLATE/w*.yml"],
    "vendor.github-issue-config": [".github/ISSUE_TEMPLATE/config.yml"],
    "vendor.citation-file-format": ["CITATION.cff"],
}


def _check() -> ModuleType:
    spec = importlib.util.spec_from_file_location("release_check", ROOT / ".ci" / "release_check.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


CHECK = _check()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """The files that the check reads, as they would be on the day of a release."""
    for name in (*CHECK.VERSIONS, *CHECK.ADDRESSED, "pyproject.toml", "CHANGELOG.md"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
        _change(tmp_path / name, "OWNER/", "robots/")
    _change(tmp_path / "ros2privacy/package.xml", "rosprivacy@example.org", "keeper@robots.test")
    _change(tmp_path / "CHANGELOG.md", "0.2.0 (unreleased)", "0.2.0 (2026-12-01)")
    return tmp_path


def _change(file: Path, before: str, after: str) -> None:
    file.write_text(file.read_text("utf-8").replace(before, after), "utf-8")


def test_a_tree_that_is_filled_in_may_be_released(tree: Path) -> None:
    assert CHECK.problems(tree, "v0.2.0") == []


def test_this_tree_lacks_an_address_a_maintainer_and_a_day_and_nothing_else() -> None:
    places = [line.partition(":")[0] for line in CHECK.problems(ROOT, "v0.2.0")]
    assert places == ["pyproject.toml", "ros2privacy/package.xml", "CHANGELOG.md"]


@pytest.mark.parametrize("name", [*CHECK.ADDRESSED])
def test_another_address_is_named(tree: Path, name: str) -> None:
    _change(tree / name, "robots/rosprivacy", "strangers/rosprivacy")
    assert [line.partition(":")[0] for line in CHECK.problems(tree, "v0.2.0")] == [name]


@pytest.mark.parametrize("name", [*CHECK.VERSIONS])
def test_another_version_is_named(tree: Path, name: str) -> None:
    _change(tree / name, "0.2.0", "0.1.9")
    assert any(name in line for line in CHECK.problems(tree, "v0.2.0"))


def test_a_tag_of_another_version_is_named(tree: Path) -> None:
    (line,) = CHECK.problems(tree, "v0.3.0")
    assert "v0.3.0" in line


def test_the_command_ends_with_1_and_a_line_for_each_problem() -> None:
    done = subprocess.run(
        [sys.executable, str(ROOT / ".ci" / "release_check.py"), "v9"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == len(CHECK.problems(ROOT, "v9"))


@pytest.mark.parametrize(("schema", "globs"), SCHEMAS.items())
def test_files_for_the_host_are_what_it_reads(schema: str, globs: list[str]) -> None:
    files = [str(file) for glob in globs for file in sorted(ROOT.glob(glob))]
    assert files
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema, *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_workflows_have_no_known_weakness() -> None:
    """By zizmor, which reads them without asking the network."""
    program = [str(Path(sys.executable).with_name("zizmor")), "--offline", "--no-progress", "--min-severity=medium"]
    done = subprocess.run(
        [*program, str(ROOT / ".github"), str(ROOT / "action.yml")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


def test_each_action_is_named_by_commit_and_by_one_commit() -> None:
    named: dict[str, set[str]] = {}
    for file in sorted((ROOT / ".github/workflows").glob("*.yml")):
        for job in yaml.safe_load(file.read_text("utf-8"))["jobs"].values():
            for step in job["steps"]:
                action, _, commit = step.get("uses", "./").partition("@")
                if action != "./":
                    named.setdefault("/".join(action.split("/")[:2]), set()).add(commit)
    assert all(len(commits) == 1 for commits in named.values()), named
    assert all(len(commit) == 40 for commits in named.values() for commit in commits)
