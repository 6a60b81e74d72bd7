"""What is shipped is what is here: sdist -> wheel -> a fresh environment -> the main job, away from the checkout."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import zipfile
from importlib.resources import files
from typing import TYPE_CHECKING

import pytest

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

ROOMS = sorted(path.name for path in (ROOT / "src" / "rosprivacy").iterdir() if path.is_symlink())


def test_the_rooms_import_from_the_package_and_bring_their_data() -> None:
    assert ROOMS == ["analysis", "ingest", "ontology", "queries", "report"]
    for room, names in {
        "ontology": ("categories.ttl", "law.ttl", "packages/nav2.yaml"),
        "ingest": ("labels/standard.yaml",),
        "queries": ("leak-paths.cypher",),
        "explorer": ("web/templates/page.html.j2", "web/static/explore.js", "web/static/review.css"),
        "report": ("page/templates/report.html.j2", "catalogs/en.json", "rdf/findings.shapes.ttl"),
    }.items():
        for name in names:
            assert files(f"rosprivacy.{room}").joinpath(*name.split("/")).is_file(), name


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of an sdist, and of the wheel that is made from it."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, "-m", "build", "--outdir", str(folder), str(ROOT)], check=True, capture_output=True)
    return folder


@pytest.mark.slow
def test_the_wheel_holds_every_module_and_data_file(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    (sdist,) = built.glob("*.tar.gz")
    inside = set(zipfile.ZipFile(wheel).namelist())
    ours = {
        f"rosprivacy/{room}/{path.relative_to(ROOT / room)}"
        for room in ROOMS
        for path in (ROOT / room).rglob("*")
        if path.suffix in {".py", ".ttl", ".yaml", ".json", ".cypher", ".j2", ".css", ".js"}
    }
    assert ours <= inside
    assert "rosprivacy/py.typed" in inside
    with tarfile.open(sdist) as archive:
        assert not any(member.issym() for member in archive.getmembers())  # real files, for systems without links


@pytest.mark.slow
def test_package_indexes_take_what_is_built(built: Path) -> None:
    for check in (["twine", "check", "--strict", *built.iterdir()], ["check_wheel_contents", *built.glob("*.whl")]):
        command = [sys.executable, "-m", *map(str, check)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_the_main_job_runs_in_a_fresh_environment(built: Path, tmp_path: Path) -> None:
    (wheel,) = built.glob("*.whl")
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV"))}
    subprocess.run([sys.executable, "-m", "venv", str(tmp_path / "env")], check=True)
    python = tmp_path / "env" / "bin" / "python"
    install = [str(python), "-m", "pip", "install", "--quiet", str(wheel)]
    subprocess.run(install, check=True, env=environment)
    factory = ROOT / "examples" / "factory"
    program = tmp_path / "env" / "bin" / "rosprivacy"
    policy, labels = factory / "before.policy.xml", factory / "run2.labels.yaml"
    command = [str(program), "analyze", str(policy), "--labels", str(labels), "--format", "json"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    assert json.loads(done.stdout)["verdict"] == "leak"
    where = [str(python), "-c", "import rosprivacy.ingest.policies.policy_xml as p; print(p.__file__)"]
    file = subprocess.run(where, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True).stdout
    assert str(tmp_path) in file
