"""Whole systems: each folder of ``cases/`` names an input among the examples and holds the expected answer.

``case.json``: policies, labels and options; or ``fleet.json``: a fleet file. ``expected.json``: the findings, open
questions and verdict, by name; of a fleet also on how many robots, and which differ.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from tests.helpers.cases import CASES, FLEETS
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path


def name(element: dict[str, Any]) -> str:
    """``/node``, ``topic /t`` or ``service /s request``."""
    kind = "" if element["kind"] == "node" else f"{element['kind']} "
    robot = f"{element['robot']}:" if element["robot"] else ""
    return f"{kind}{robot}{element['name']} {element.get('leg', '')}".strip()


def summary(document: dict[str, Any]) -> dict[str, Any]:
    return {
        "verdict": document["verdict"],
        "findings": [
            {
                "category": ("pseudonymised " if finding["pseudonymised"] else "") + finding["category"],
                "way": [name(element) for element in finding["witness"]],
                "lines": [step["policy"][0]["line"] if step["policy"] else 0 for step in finding["steps"]],
                "disjoint_paths": finding["disjoint_paths"],
                **({"only_through": [name(e) for e in finding["through"]]} if finding["dismissed"] else {}),
            }
            for finding in document["findings"]
        ],
        "open": {
            name(q["element"]): f"{', '.join(q['categories'])} at {q['distance']}" + (", frontier" * q["frontier"])
            for q in document["open"]
        },
    }


@pytest.mark.parametrize("case", CASES, ids=lambda path: str(path.name))
def test_case(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples")
    given = json.loads((case / "case.json").read_text())
    result = rosprivacy.analyze(given["policies"], given["labels"], **given.get("options", {}))
    assert summary(result.document()) == json.loads((case / "expected.json").read_text())


def fleet_summary(document: dict[str, Any]) -> dict[str, Any]:
    fleet = document["fleet"]
    patterns = {pattern["finding"]: pattern for pattern in fleet["patterns"]}
    whole = summary(document)
    for finding, row in zip(document["findings"], whole["findings"], strict=True):
        pattern = patterns[finding["id"]]
        row["kind"] = finding["kind"]
        row["robots"] = f"{len(pattern['robots'])}, from {pattern['robots'][0]} on"
        counts = {key: pattern[key] for key in ("findings", "dismissed", "pseudonymised", "across")}
        row.update({key: value for key, value in counts.items() if value})
    titles = {pattern["id"]: number for number, pattern in enumerate(fleet["patterns"])}
    differ = [
        {
            "robots": deviant["robots"],
            **{key: [titles[share["pattern"]] for share in deviant[key]] for key in ("more", "fewer")},
            "open": [name(element) for key in ("more_open", "fewer_open") for element in deviant[key]],
        }
        for deviant in fleet["deviants"]
    ]
    counts = {key: document[key] for key in ("elements", "flows", "standard_channels")}
    return {**whole, "models": fleet["models"], "deviants": differ, **counts}


@pytest.mark.parametrize("case", FLEETS, ids=lambda path: str(path.name))
def test_fleet(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples")
    given = json.loads((case / "fleet.json").read_text())
    result = rosprivacy.analyze_fleet(given["fleet"], **given.get("options", {}))
    assert fleet_summary(result.document()) == json.loads((case / "expected.json").read_text())
