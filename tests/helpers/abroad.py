"""A workplace and public space whose data end on four continents: every sort of finding, context and basis at once."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import rosprivacy
from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

PROFILES: dict[str, tuple[list[str], list[str]]] = {
    "camera": (["/image"], []),
    "mic": (["/audio"], []),
    "wifi": (["/phones"], []),
    "feelings": (["/mood"], ["/image"]),
    "guard": (["/alarm"], ["/image"]),
    "blur": (["/blurred"], ["/image"]),
    "recorder": ([], ["/image", "/audio", "/mood", "/alarm"]),
    "trainer": ([], ["/blurred", "/phones"]),
    "teleop": ([], ["/image", "/audio"]),
}
NODES: dict[str, Any] = {
    "/camera": {"source": ["Video"], "subjects": ["children", "staff", "visitors"]},
    "/mic": {"source": ["Voice"], "subjects": ["staff", "visitors"]},
    "/wifi": {"source": ["WirelessDeviceId"], "subjects": ["passers-by"]},
    "/feelings": {"derives": [{"from": "Video", "to": "EmotionEstimate"}], "sanitizer": {"Video": "drop"}},
    "/guard": {
        "derives": [{"from": "Video", "to": "WatchListMatch"}],
        "sanitizer": {"Video": "drop"},
        "legal_basis": ["6(1)(f)", "10"],
    },
    "/blur": {"sanitizer": {"Video": "pseudonymise"}},
    **dict.fromkeys(("/recorder", "/trainer", "/teleop"), "conduit"),
}
ELEMENTS: dict[str, dict[str, Any]] = {
    "store": {
        "kind": "storage", "country": "US", "operator": "Store Inc.", "recipient": "processor",
        "contract": "Article 28, 2026-03-01", "retention": {"Video": "P90D", "PersonalData": "P1Y"}, "backups": "P30D",
        "encrypted": False, "transfer": "standard-clauses",
    },
    "models": {"kind": "storage", "country": "BR", "operator": "Models Ltda.", "recipient": "third-party"},
    "second store": {
        "kind": "storage", "country": "IN", "operator": "Disks Pvt.", "recipient": "processor", "retention": "P30D",
        "transfer": "none",
    },
    "seat": {"kind": "person", "country": "JP", "operator": "Seats KK", "recipient": "processor"},
    "calls": {
        "kind": "external-system", "country": "TN", "operator": "Calls SARL", "recipient": "processor",
        "transfer": "derogation",
    },
}  # fmt: skip
FLOWS: list[dict[str, Any]] = [
    {"from": "/recorder", "to": "store"},
    {"from": "store", "to": "second store", "only": ["Video"]},
    {"from": "/trainer", "to": "models"},
    {"from": "/teleop", "to": "seat"},
    {"from": "/teleop", "to": "calls", "only": ["Voice"]},
]


def abroad(folder: Path) -> dict[str, Any]:
    """The document of the system, as ``analyze`` writes it."""
    return json.loads(json.dumps(abroad_answer(folder).document()))  # type: ignore[no-any-return]  # JSON


def abroad_answer(folder: Path) -> rosprivacy.Result:
    """The system, analysed."""
    labels = {
        "labels": 1,
        "context": ["workplace", "public-space"],
        "country": "DE",
        "controller": "Yard GmbH",
        "dpo": "D. Officer",
        "purpose": "protection of the yard",
        "legal_basis": ["6(1)(f)"],
        "nodes": NODES,
        "channels": dict.fromkeys(("/image", "/audio", "/phones", "/mood", "/alarm", "/blurred"), "sensitive"),
        "elements": ELEMENTS,
        "limits": {"Video": "P30D"},
        "flows": FLOWS,
    }
    (folder / "yard.policy.xml").write_text(policy(PROFILES), "utf-8")
    (folder / "yard.labels.json").write_text(json.dumps(labels, indent=1), "utf-8")
    return rosprivacy.analyze([str(folder / "yard.policy.xml")], [str(folder / "yard.labels.json")])
