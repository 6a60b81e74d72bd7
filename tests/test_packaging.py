"""What is shipped is what is here: sdist -> wheel -> a fresh environment -> the main job, away from the checkout."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from importlib.resources import files
from pathlib import Path

import pytest

from rosprivacy.analysis.python_311 import tomllib
from tests.helpers.paths import ROOT

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


def pythons() -> list[str]:
    """The Pythons of this machine that we support, a version each: of the path, and of pyenv."""
    classifiers = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["classifiers"]
    versions = [name.rpartition(" ")[2] for name in classifiers if re.search(r":: 3\.\d+$", name)]
    others = Path.home() / ".pyenv" / "versions"
    found = {"{}.{}".format(*sys.version_info): sys.executable}
    for version in versions:
        of_pyenv = [str(path) for path in sorted(others.glob(f"{version}.*/bin/python"))]
        for python in [*of_pyenv, shutil.which(f"python{version}")]:
            if python and _answers(python):
                found.setdefault(version, python)
    return [found[version] for version in versions if version in found]


def _answers(python: str) -> bool:
    """Whether it runs, and can make environments: one of pyenv need not, where another version is chosen."""
    return not subprocess.run([python, "-c", "import ensurepip"], capture_output=True, check=False).returncode


MOST = 150 * 2**20  # bytes of the core and all that it needs, with the bytecode that pip makes; on x86_64


@pytest.mark.slow
def test_package_indexes_take_what_is_built(built: Path) -> None:
    for check in (["twine", "check", "--strict", *built.iterdir()], ["check_wheel_contents", *built.glob("*.whl")]):
        command = [sys.executable, "-m", *map(str, check)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("base", pythons())
def test_the_main_job_runs_in_a_fresh_environment_of_each_python(built: Path, tmp_path: Path, base: str) -> None:
    (wheel,) = built.glob("*.whl")
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV"))}
    subprocess.run([base, "-m", "venv", "--without-pip", str(tmp_path / "env")], check=True, env=environment)
    python = tmp_path / "env" / "bin" / "python"
    install = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet", str(wheel)]
    subprocess.run(install, check=True, env=environment)
    (packages,) = tmp_path.glob("env/lib/python*/site-packages")
    assert (packages / "numpy" / "__pycache__").is_dir()
    assert sum(path.lstat().st_size for path in packages.rglob("*") if path.is_file()) <= MOST

    def ran(*command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    factory = ROOT / "examples" / "factory"
    program = str(tmp_path / "env" / "bin" / "rosprivacy")
    system = [str(factory / "before.policy.xml"), "--labels", str(factory / "run2.labels.yaml")]
    done = ran(program, "analyze", *system, "--format", "json")
    assert done.returncode == 1, done.stderr
    assert json.loads(done.stdout)["verdict"] == "leak"
    report = ran(program, "report", *system, "--output", "report.html")  # without Graphviz, which is an extra
    assert (report.returncode, report.stderr.count("\n")) == (0, 1), report.stderr
    assert str(tmp_path) in ran(str(python), "-c", "import rosprivacy.ingest as room; print(room.__path__[0])").stdout
    (tmp_path / "own.ttl").write_text("", "utf-8")
    unchecked = ran(program, "analyze", *system, "--ontology", "own.ttl")  # without pyshacl, which is an extra
    assert (unchecked.returncode, unchecked.stdout, unchecked.stderr.count("\n")) == (2, "", 1), unchecked.stderr
    assert "pip install 'pyshacl" in unchecked.stderr
