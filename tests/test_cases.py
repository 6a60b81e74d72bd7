"""Whole systems: each folder of ``cases/`` names an input among the examples and holds the expected answer.

``case.json``: policies, labels and options. ``expected.json``: the findings, open questions and verdict, by name.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import rosprivacy

ROOT = Path(__file__).resolve().parent.parent
CASES = sorted(path.parent for path in (ROOT / "tests" / "cases").glob("*/case.json"))


def name(element: dict[str, Any]) -> str:
    """``/node``, ``topic /t`` or ``service /s request``."""
    kind = "" if element["kind"] == "node" else f"{element['kind']} "
    return f"{kind}{element['name']} {element.get('leg', '')}".strip()


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
