"""A robot whose video goes to a call centre abroad, and whose face templates rest on a disk: rows to decide about."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.explorers import Explorer

NODES = {
    "door_camera": (["video"], []),
    "hall_camera": (["video"], []),
    "greeter": (["faces"], ["video"]),
    "teleop": ([], ["video"]),
    "recorder": ([], ["faces"]),
    "scanner": ([], []),
}
LABELS: dict[str, Any] = {
    "labels": 1,
    "country": "DE",
    "purpose": "greeting of visitors",
    "nodes": {
        "/door_camera": {"source": ["Video"], "subjects": ["visitors"]},
        "/hall_camera": {"source": ["Video"], "subjects": ["staff"]},
        "/greeter": {"derives": [{"from": "Video", "to": "FaceTemplate"}]},
        "/teleop": "conduit",
        "/recorder": "conduit",
        "/scanner": {"source": ["ContactData"], "leak": ["ContactData"]},
    },
    "elements": {
        "cabin": {
            "kind": "person", "country": "TN", "operator": "Example Teleop", "recipient": "processor",
            "transfer": "derogation",
        },
        "archive": {"kind": "storage", "country": "DE", "operator": "Example Cloud", "recipient": "processor"},
    },
    "flows": [{"from": "/teleop", "to": "cabin"}, {"from": "/recorder", "to": "archive"}],
}  # fmt: skip
ANSWERS = {"answer-occasional": "once a year", "answer-processor": "DMS 12"}


def written(folder: Path) -> tuple[Path, Path]:
    """Return its policy and its label file."""
    (folder / "p.xml").write_text(policy(NODES), "utf-8")
    (folder / "l.json").write_text(json.dumps(LABELS), "utf-8")
    return folder / "p.xml", folder / "l.json"


def at(explorer: Explorer, place: str) -> list[str]:
    """Return the ids of the findings that end at a place."""
    return [finding.id for finding in explorer.session.findings if finding.leak.name == place]
