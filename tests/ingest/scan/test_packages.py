"""What a package can run: entry points, scripts, executables and components, each with its sources."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.packages import read_packages
from rosprivacy.ingest.scan.scan_facts import Executable

if TYPE_CHECKING:
    from pathlib import Path

MANIFEST = "<package format='3'><name>{}</name><export><build_type>{}</build_type></export></package>"
SETUP = """
from setuptools import setup
package_name = 'care'
setup(name=package_name, packages=[package_name], scripts=['scripts/tool.py'], {})
"""


def checkout(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def python(points: str) -> dict[str, str]:
    return {
        "care/package.xml": MANIFEST.format("care", "ament_python"),
        "care/setup.py": SETUP.format(points),
        "care/care/talker.py": "",
        "care/scripts/tool.py": "",
    }


@pytest.mark.parametrize(
    "points",
    [
        "entry_points={'console_scripts': ['talker = care.talker:main']}",
        "entry_points={'console_scripts': [f'talker = {package_name}.talker:main']}",
        "entry_points={'console_scripts': ['talker = ' + package_name + '.talker:main']}",
        "entry_points={'console_scripts': ['%s = care.talker:main' % n for n in ['talker']]}",
        "entry_points='''\n[console_scripts]\ntalker = care.talker:main\n'''",
    ],
)
def test_an_entry_point_is_an_executable(tmp_path: Path, points: str) -> None:
    found = read_packages(checkout_files(checkout(tmp_path, python(points))))
    assert found.executables == (
        Executable("care", "talker", ("care/care/talker.py",), "main"),
        Executable("care", "tool.py", ("care/scripts/tool.py",)),
    )
    assert found.gaps == ()


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("setup.cfg", "[options.entry_points]\nconsole_scripts =\n    talker = care.talker:main\n"),
        ("pyproject.toml", "[project.scripts]\ntalker = 'care.talker:main'\n"),
    ],
)
def test_entry_points_stand_in_other_files_too(tmp_path: Path, name: str, text: str) -> None:
    files = {**python(""), f"care/{name}": text}
    found = read_packages(checkout_files(checkout(tmp_path, files)))
    assert Executable("care", "talker", ("care/care/talker.py",), "main") in found.executables


@pytest.mark.parametrize(
    "points",
    [
        "entry_points=read('points')",
        "entry_points={'console_scripts': ['talker = care.nowhere:main']}",
        "entry_points={'console_scripts': [anything()]}",
    ],
)
def test_what_cannot_be_told_of_entry_points_is_a_gap(tmp_path: Path, points: str) -> None:
    found = read_packages(checkout_files(checkout(tmp_path, python(points))))
    assert {(gap.place.file, gap.place.line, gap.sort) for gap in found.gaps} == {("care/setup.py", 4, "file")}


def test_a_setup_that_is_not_python_is_a_gap(tmp_path: Path) -> None:
    found = read_packages(checkout_files(checkout(tmp_path, {**python(""), "care/setup.py": "<<<<<<< HEAD\n"})))
    assert [(gap.place.file, gap.sort) for gap in found.gaps] == [("care/setup.py", "file")]


def test_a_package_of_ros_1_is_left_out(tmp_path: Path) -> None:
    old = "<package><name>old</name><buildtool_depend>catkin</buildtool_depend></package>"
    files = {**python(""), "old/package.xml": old, "old/launch/a.launch": "<launch/>"}
    found = read_packages(checkout_files(checkout(tmp_path, files)))
    assert [package.name for package in found.packages] == ["care"]
    assert found.left_out == ("old",)
    assert "old/launch/a.launch" not in found.files


def test_a_manifest_with_entities_is_a_gap(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE p [<!ENTITY a "a"><!ENTITY b "&a;&a;">]><package><name>&b;</name></package>'
    found = read_packages(checkout_files(checkout(tmp_path, {"care/package.xml": bomb})))
    assert found.packages == ()
    assert [(gap.place.file, gap.sort) for gap in found.gaps] == [("care/package.xml", "file")]
