"""Services and volumes of compose files and manifests, with their lines; nothing of an environment."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.outside.compose_files import read_compose

if TYPE_CHECKING:
    from pathlib import Path

COMPOSE = """\
version: "3"
services:
  broker:
    image: eclipse-mosquitto
    ports: ["1883:1883", "127.0.0.1:9001:9001", "80"]
    environment:
      PASSWORD: zqsecret
      - KEY=zqsecret
    volumes:
      - broker_data:/mosquitto/data
"""
GOOD = (
    COMPOSE.replace("      - KEY=zqsecret\n", "")
    + """\
      - ${FOOTAGE:-zqsecret}:/footage
      - /dev:/dev
      - type: bind
        source: ./config
        target: /config
  robot:
    command: ros2 launch robot robot.launch.py
volumes:
  broker_data:
  spare:
"""
)
MANIFEST = """\
apiVersion: apps/v1
kind: Deployment
metadata:
  name: cloud-sync
spec:
  template:
    spec:
      containers:
        - image: sync
          env: [{name: TOKEN, value: zqsecret}]
      volumes:
        - hostPath: {path: /data/bags}
---
kind: PersistentVolumeClaim
metadata:
  name: footage
"""


def test_services_and_volumes_of_a_compose_file(tmp_path: Path) -> None:
    (tmp_path / "docker").mkdir()
    (tmp_path / "docker/docker-compose.dev.yml").write_text(GOOD, "utf-8")
    found = read_compose(checkout_files(tmp_path))
    assert [(one.place.line, one.name) for one in found.externals] == [
        (3, "service broker (port 1883)"), (9, "volume broker_data"), (10, "volume ${FOOTAGE}"),
        (12, "volume ./config"), (15, "service robot"), (19, "volume spare"),
    ]  # fmt: skip
    assert {(one.place.file, one.sort, one.stated) for one in found.externals} == {
        ("docker/docker-compose.dev.yml", "compose", True)
    }
    assert "zqsecret" not in repr(found)


def test_manifests(tmp_path: Path) -> None:
    (tmp_path / "sync.yaml").write_text(MANIFEST, "utf-8")
    found = read_compose(checkout_files(tmp_path))
    assert [(one.place.line, one.name) for one in found.externals] == [
        (1, "service cloud-sync"), (12, "volume /data/bags"), (14, "volume footage"),
    ]  # fmt: skip
    assert "zqsecret" not in repr(found)


@pytest.mark.parametrize("text", [COMPOSE, "services: &x {a: 1}\n", "- : [\n", ""])
def test_what_cannot_be_read_is_a_gap_at_its_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "compose.yaml").write_text(text, "utf-8")
    found = read_compose(checkout_files(tmp_path))
    assert found.externals == ()
    assert [gap.place.file for gap in found.gaps] == (["compose.yaml"] if text else [])
    assert "zqsecret" not in repr(found)


def test_a_link_that_leads_out_is_a_gap_and_hidden_folders_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/compose.yaml").write_text(GOOD, "utf-8")
    root = tmp_path / "root"
    (root / ".git").mkdir(parents=True)
    (root / ".git/compose.yaml").write_text(GOOD, "utf-8")
    (root / "compose.yaml").symlink_to(tmp_path / "outside/compose.yaml")
    (root / "more").symlink_to(tmp_path / "outside")
    assert read_compose(checkout_files(root)).externals == ()
