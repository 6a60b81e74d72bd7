"""A saved analysis of anybody -> what is wrong in it: by the published schema, and by what contradicts itself.

In: a JSON value. Out: where, and what is wrong; never what stands there, which may be of another file than ours.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.json_shape import misfits, validator

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from jsonschema.protocols import Validator


def problems(document: Any) -> list[str]:
    """Return what is wrong in a document, each with its place; what contradicts itself if nothing else is wrong.

    Complexity: O(its size).
    """
    return misfits(_validator(), document) or list(_contradictions(document))


@cache
def _validator() -> Validator:
    schema = files("rosprivacy.report.contract").joinpath("analysis.schema.json")
    return validator(json.loads(schema.read_text("utf-8")))


def _contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """Names of what is not there, and counts and words that cannot both be true."""
    findings = document["findings"]
    stands = any(not finding["dismissed"] and not finding["accepted"] for finding in findings)
    if stands != (document["verdict"] == "leak"):
        yield f"verdict is {document['verdict']}, and {'a finding' if stands else 'no finding'} stands in findings"
    yield from _twice("findings", "id", findings)
    kinds = {category["name"] for category in document["categories"]}
    for number, finding in enumerate(findings):
        at, way = f"findings[{number}]", finding["witness"]
        if finding["category"] not in kinds:
            yield f"{at}.category is not in categories"
        if not way or _key(way[0]) != _key(finding["source"]) or _key(way[-1]) != _key(finding["leak"]):
            yield f"{at}.witness does not lead from its source to its leak"
        if "steps" in finding and len(finding["steps"]) != len(way) - 1:
            yield f"{at}.steps are not as many as its witness has"
    if "fleet" in document:
        yield from _of_fleet(document["fleet"], {finding["id"] for finding in findings})


def _of_fleet(fleet: Mapping[str, Any], ids: set[str]) -> Iterator[str]:
    alike, patterns = fleet["alike"], fleet["patterns"]
    robots = [robot for group in alike for robot in group["robots"]]
    if len(set(robots)) != len(robots):
        yield "fleet.alike has a robot that stands twice"
    if len(robots) != fleet["robots"] or sum(fleet["models"].values()) != fleet["robots"]:
        yield "fleet.robots is not their number in fleet.alike and fleet.models"
    for number, group in enumerate(alike):
        if group["robot"] not in group["robots"]:
            yield f"fleet.alike[{number}].robot is not in its robots"
    yield from _twice("fleet.patterns", "id", patterns)
    for number, pattern in enumerate(patterns):
        if pattern["finding"] not in ids:
            yield f"fleet.patterns[{number}].finding is not in findings"
        if max(pattern[which] for which in ("dismissed", "pseudonymised", "accepted")) > pattern["findings"]:
            yield f"fleet.patterns[{number}].findings is less than it counts of them"


def _twice(where: str, key: str, rows: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    seen: set[str] = set()
    for number, row in enumerate(rows):
        if row[key] in seen:
            yield f"{where}[{number}].{key} stands twice"
        seen.add(row[key])


def _key(element: Mapping[str, Any]) -> tuple[str, ...]:
    return element["robot"], element["kind"], element["name"], element.get("leg", "")
