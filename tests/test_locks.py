"""What the Action and the image install: every file by its hash, and all that pyproject.toml asks for."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from rosprivacy.analysis.python_311 import tomllib
from tests.helpers.paths import ROOT

LOCKS = {"requirements.lock": (), "docker/requirements.lock": ("neo4j-rust-ext",)}
FACTORY = ROOT / "examples" / "factory"


def entries(lock: str) -> list[tuple[Requirement, list[str]]]:
    """(what is pinned, its hashes)."""
    text = (ROOT / lock).read_text("utf-8").replace("\\\n", " ")
    lines = [line.split(" --hash=") for line in text.splitlines() if not line.startswith("#")]
    return [(Requirement(pin), [one.strip() for one in hashes]) for pin, *hashes in lines]


@pytest.mark.parametrize("lock", LOCKS)
def test_every_file_is_pinned_by_its_hash_and_no_index_is_named(lock: str) -> None:
    for pin, hashes in entries(lock):
        assert re.fullmatch(r"==[^*,]+", str(pin.specifier)), pin
        assert hashes
        assert all(re.fullmatch("sha256:[0-9a-f]{64}", one) for one in hashes)
    assert "://" not in (ROOT / lock).read_text("utf-8")


@pytest.mark.parametrize(("lock", "more"), LOCKS.items())
def test_the_lock_has_what_the_project_asks_for(lock: str, more: tuple[str, ...]) -> None:
    """If this fails: make locks."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    ontology = project["project"]["optional-dependencies"]["ontology"]  # a repository may have kinds of its own
    wanted = [*project["project"]["dependencies"], *ontology, *project["build-system"]["requires"], *more]
    pinned: dict[str, list[str]] = {}
    for pin, _ in entries(lock):
        pinned.setdefault(canonicalize_name(pin.name), []).append(str(pin.specifier).removeprefix("=="))
    for asked in map(Requirement, wanted):
        versions = pinned.get(canonicalize_name(asked.name), [])
        assert versions, asked
        assert all(asked.specifier.contains(version) for version in versions), asked


def test_graphviz_comes_with_the_image_and_not_with_the_core() -> None:
    """It is as large as all else together, and the Action draws nothing."""
    action, image = ({canonicalize_name(pin.name) for pin, _ in entries(lock)} for lock in LOCKS)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    core = {canonicalize_name(Requirement(asked).name) for asked in project["dependencies"]}
    views = {canonicalize_name(Requirement(asked).name) for asked in project["optional-dependencies"]["views"]}
    assert views <= image
    assert not views & (action | core)


def test_the_image_has_what_the_action_has() -> None:
    action, image = ({(str(pin), *hashes) for pin, hashes in entries(lock)} for lock in LOCKS)
    assert action <= image


@pytest.mark.thorough
def test_the_image_can_be_built_from_what_the_builder_gets(tmp_path: Path) -> None:
    """The command of its first part, run without docker, on the files that .dockerignore lets through."""
    ignored = (ROOT / ".dockerignore").read_text("utf-8").splitlines()
    for name in (line[1:] for line in ignored if line.startswith("!")):
        source, target = ROOT / name, tmp_path / "checkout" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, symlinks=True, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
        else:
            shutil.copy(source, target)
    dockerfile = (ROOT / "docker" / "Dockerfile").read_text("utf-8").replace("\\\n", " ")
    (build, _) = (line[4:] for line in dockerfile.splitlines() if line.startswith("RUN "))
    there = tmp_path / "rosprivacy"
    command = ["sh", "-c", build.replace("/opt/rosprivacy", str(there))]
    variables = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    variables["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command, cwd=tmp_path / "checkout", env=variables, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    policy, labels = FACTORY / "before.policy.xml", FACTORY / "run2.labels.yaml"
    program = [str(there / "bin" / "rosprivacy"), "analyze", str(policy), "--labels", str(labels)]
    assert subprocess.run(program, cwd=tmp_path, env=variables, capture_output=True, check=False).returncode == 1
