"""Which files of packages are read: the catalogue, files, folders, and what installed packages ship."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.known_packages.package_folders import (
    AMENT,
    PREFIXES,
    catalogue,
    read_packages,
    replacements,
    rests_on,
)
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from rosprivacy.analysis.suggesting.packages import Package

TEXT = """package: 1
name: {name}
about: Shows what it gets.
sources: [{{at: https://example.org, version: "1", read: 2026-11-23}}]
nodes:
  - names: [{node}]
    says: [{{leak: [Video], to: display, why: it shows pictures}}]
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(PREFIXES, raising=False)


def write(file: str, name: str = "own", node: str = "own_node") -> str:
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    Path(file).write_text(TEXT.format(name=name, node=node), "utf-8")
    return file


def names_of(*named: str) -> list[str]:
    """Names of the packages that are read beside, or in place of, those that are shipped."""
    shipped = catalogue(load())
    return [package.name for package in read_packages(named, load()) if package not in shipped]


def refused(*named: str) -> list[str]:
    with pytest.raises(InputErrors) as error:
        read_packages(named, load())
    return str(error.value).splitlines()


def test_without_a_name_the_catalogue_is_read() -> None:
    assert read_packages((), load()) == catalogue(load())
    assert names_of() == []


def test_files_and_folders_are_read() -> None:
    write("one.yaml", "one")
    write("many/b.yml", "bee")
    write("many/a.yaml", "ant")
    Path("many/README.md").write_text("not one", "utf-8")
    assert names_of("one.yaml", "many") == ["ant", "bee", "one"]


def test_a_file_of_a_user_stands_in_place_of_a_shipped_one_of_the_same_name() -> None:
    own = write("usb_cam.yaml", "usb_cam", "my_camera")
    read = read_packages((own,), load())
    package, left = (one for one in read if one.name == "usb_cam")
    assert (package.nodes[0].names, package.place.file) == (("my_camera",), own)
    assert left.place.file == "rosprivacy:packages/usb_cam.yaml"
    assert [file for file, _ in rests_on(read)] == ["rosprivacy:packages", own]


def ends(package: Package) -> set[tuple[str, str, str]]:
    return {(name, one.role, one.kind) for node in package.nodes for name in node.names for one in node.claims}


@pytest.mark.parametrize(
    ("node", "stated", "asked"),
    [
        ("camera", "leak: [Video], to: file", {("source", "Video"), ("leak", "DepthImage")}),
        ("camera", "leak: [PersonalData], to: file", {("source", "Video")}),  # a broader kind states the narrower ones
        ("camera", "leak: [FaceImage], to: file", {("source", "Video"), ("leak", "Video"), ("leak", "DepthImage")}),
        ("camera", "source: [Video]", {("leak", "Video"), ("leak", "DepthImage")}),
        ("camera", "conduit: all", {("source", "Video"), ("leak", "Video"), ("leak", "DepthImage")}),
        ("other", "leak: [PersonalData], to: file", {("source", "Video"), ("leak", "Video"), ("leak", "DepthImage")}),
    ],
)
def test_no_source_or_leak_of_a_shipped_file_vanishes(node: str, stated: str, asked: set[tuple[str, str]]) -> None:
    own = write("mine.yaml", "orbbec_camera", node)
    Path(own).write_text(Path(own).read_text("utf-8").replace("leak: [Video], to: display", stated), "utf-8")
    read = read_packages((own,), load())
    _, left = (one for one in read if one.name == "orbbec_camera")
    watched = {("source", "Video"), ("leak", "Video"), ("leak", "DepthImage")}
    assert {(role, kind) for name, role, kind in ends(left) if name == "camera"} & watched == asked
    assert {role for _, role, _ in ends(left)} <= {"source", "leak"}
    (said,) = replacements(read)
    assert str(said.place) == f"{own}:1"
    assert said.message.startswith("it stands in place of the shipped package orbbec_camera; what it does not state of")


def test_what_is_replaced_whole_is_told_too() -> None:
    own = write("mine.yaml", "usb_cam", "usb_cam, usb_cam_node_exe")
    Path(own).write_text(Path(own).read_text("utf-8").replace("leak: [Video], to: display", "source: [Video]"), "utf-8")
    (said,) = replacements(read_packages((own,), load()))
    assert said.message == "it stands in place of the shipped package usb_cam"
    assert replacements(read_packages((write("own.yaml"),), load())) == ()


def test_installed_packages_ship_theirs_and_an_overlay_comes_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write("overlay/share/blur/rosprivacy/package.yaml", "blur", "new_name")
    write("underlay/share/blur/rosprivacy/package.yaml", "blur", "old_name")
    write("underlay/share/uplink/rosprivacy/package.yaml", "uplink")
    write("underlay/share/elsewhere/package.yaml", "elsewhere")
    monkeypatch.setenv(PREFIXES, os.pathsep.join(str(tmp_path / one) for one in ("overlay", "underlay", "missing")))
    assert names_of() == [], "only when asked for"
    assert names_of(AMENT) == ["blur", "uplink"]
    (blur,) = (one for one in read_packages((AMENT,), load()) if one.name == "blur")
    assert blur.nodes[0].names == ("new_name",)


def test_what_installed_packages_lack_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert refused(AMENT) == [f"ament: {PREFIXES} is not set; source the setup file of ROS, or name a file"]
    monkeypatch.setenv(PREFIXES, str(tmp_path))
    told = "ament: no installed package has a file rosprivacy/package.yaml in its share folder; name a file or a folder"
    assert refused(AMENT) == [told]
    file = write("share/blur/rosprivacy/package.yaml", "uplink")
    told = f"{tmp_path / file}:1: it speaks of uplink, and lies in the package blur; name the package that ships it"
    assert refused(AMENT) == [told]


def test_all_problems_of_all_files_are_told() -> None:
    Path("empty").mkdir()
    Path("bad.yaml").write_text("package: 1\n", "utf-8")
    write("a.yaml", "same")
    write("b.yaml", "same")
    told = refused("a.yaml", "b.yaml", "bad.yaml", "empty", "nowhere.yaml")
    assert told[0] == "b.yaml:1: package same again, first in a.yaml; keep one"
    assert [line for line in told if line.startswith("bad.yaml:1: no 'nodes'; ")]
    assert "empty: a folder without files that end in .yaml, .yml, .json; name the folder that the files lie in" in told
    assert told[-1].startswith("nowhere.yaml: file not found")
