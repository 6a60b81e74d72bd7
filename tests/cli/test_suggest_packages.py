"""``rosprivacy suggest`` and packages: the catalogue, a user's file, what installed packages ship."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import cli
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]

OWN = """package: 1
name: acme_blur
about: Blurs the faces in pictures.
sources: [{at: https://example.org/acme_blur, version: "2.1", read: 2026-11-23}]
nodes:
  - names: [acme_blur]
    subscribes: {image_raw: sensor_msgs/msg/Image}
    publishes: {~/image: sensor_msgs/msg/Image}
    says:
      - sanitizer: {FaceImage: anonymise}
        why: it blurs each face
      - leak: [Video]
        to: file
        why: it keeps the last pictures
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    nodes = ("/usb_cam>/image_raw,/camera_info", "/acme_blur>/acme_blur/image</image_raw", "/rviz2</acme_blur/image")
    (tmp_path / "p.xml").write_text(policy(*nodes), "utf-8")
    (tmp_path / "acme.yaml").write_text(OWN, "utf-8")
    return tmp_path


def said(cli: Cli, folder: Path, *more: str) -> dict[tuple[str, str, str], tuple[str, str]]:
    """(name, role, kind) -> confidence, and the reason of the package."""
    document = json.loads(cli("suggest", "p.xml", "-f", "json", *more, cwd=folder).stdout)
    found = {}
    for one in document["suggestions"]:
        for reason in one["evidence"]:
            if reason["reason"].startswith("package "):
                found[one["name"], one["role"], one["kind"]] = (one["confidence"], reason["reason"])
    return found


def test_the_catalogue_is_asked_without_being_named(cli: Cli, robot: Path) -> None:
    found = said(cli, robot)
    confidence, reason = found["/usb_cam", "source", "Video"]
    assert confidence == "likely"
    assert reason.startswith("package usb_cam 0.8.1: it publishes what the camera films (its name, 2 of 3 ")
    assert ("/rviz2", "leak", "PersonalData") in found
    assert not [name for name, _, _ in found if name == "/acme_blur"]


def test_a_file_of_a_user_adds_a_package(cli: Cli, robot: Path) -> None:
    found = said(cli, robot, "--packages", "acme.yaml")
    assert found["/acme_blur", "leak", "Video"] == (
        "likely",
        "package acme_blur 2.1, to a file: it keeps the last pictures (its name, 2 of 2 of its interfaces)",
    )
    assert found["/acme_blur", "sanitizer", "FaceImage"][0] == "likely"


def test_installed_packages_are_asked_if_a_person_says_so(
    cli: Cli, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = robot / "install" / "share" / "acme_blur" / "rosprivacy"
    place.mkdir(parents=True)
    (place / "package.yaml").write_text(OWN, "utf-8")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(robot / "install"))
    assert ("/acme_blur", "leak", "Video") not in said(cli, robot)
    assert ("/acme_blur", "leak", "Video") in said(cli, robot, "--packages", "ament")


def test_a_bad_file_is_told_at_its_lines_and_ends_with_2(cli: Cli, robot: Path) -> None:
    (robot / "acme.yaml").write_text(OWN.replace("FaceImage", "FaceImag").replace("to: file", "to: moon"), "utf-8")
    done = cli("suggest", "p.xml", "--packages", "acme.yaml", cwd=robot)
    assert done.returncode == 2
    told = [line.partition("; ")[0] for line in done.stderr.splitlines()]
    assert told == ["acme.yaml:10: unknown category 'FaceImag'", "acme.yaml:13: to 'moon'"]


def test_what_a_package_says_is_written_and_accepted_like_the_rest(cli: Cli, robot: Path) -> None:
    cli("suggest", "p.xml", "--packages", "acme.yaml", "--into", "l.yaml", cwd=robot)
    cli("labels", "--accept", "/acme_blur", "--by", "A", "-l", "l.yaml", cwd=robot)
    text = (robot / "l.yaml").read_text("utf-8")
    (line,) = (one for one in text.splitlines() if one.strip().startswith("/acme_blur:"))
    assert "leak: [Video]" in line
    assert "(likely): package acme_blur 2.1, to a file" in text
