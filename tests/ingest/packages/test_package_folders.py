"""Which files of packages are read: the catalogue, files, folders, and what installed packages ship (issue 21)."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.packages.package_folders import AMENT, PREFIXES, catalogue, read_packages, rests_on
from rosprivacy.ontology.vocabulary import load

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
    assert len(read_packages((own,), load())) == len(catalogue(load()))
    assert names_of(own) == ["usb_cam"]
    (package,) = (one for one in read_packages((own,), load()) if one.name == "usb_cam")
    assert package.nodes[0].names == ("my_camera",)
    assert package.place.file == own
    assert [file for file, _ in rests_on(read_packages((own,), load()))] == ["rosprivacy:packages", own]


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
