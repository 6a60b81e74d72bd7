"""A JSON document that was saved, to compare with or to decide about: read, and checked whole before it is used.

In: a path. Out: ``Earlier``. For ``diff``, ``report --since`` and ``decide --report``, and for what Parquet holds.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, reason, shown
from rosprivacy.analysis.files_read import noted
from rosprivacy.analysis.json_values import misfits, parsed, validator
from rosprivacy.report.document.analysis import FORMAT, SHORT

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from jsonschema.protocols import Validator


HINT = "give what 'rosprivacy analyze --format json' printed"
NEWER = "use the version of rosprivacy that wrote it, or write it again"
SCHEMAS = {FORMAT: "analysis.schema.json", SHORT: "analysis-2.schema.json"}
LARGEST = 512 * 2**20  # bytes


class Earlier(NamedTuple):
    """A document to compare with, and the file that it comes from."""

    document: Mapping[str, Any]
    file: str
    sha256: str


def read_earlier(file: str) -> Earlier:
    """Read a document that was written before.

    Raises
    ------
    InputError
        If it cannot be read, or is no such document; with the first place where it is not, and how many more.
    """
    data = bytes_of(file, HINT)
    return Earlier(document_of(data, file, HINT), file, hashlib.sha256(data).hexdigest())


def document_of(data: bytes, file: str, remedy: str) -> Mapping[str, Any]:
    """Return the document that some bytes are, if they are one.

    Parameters
    ----------
    remedy
        How to get one: the hint.

    Raises
    ------
    InputError
        As ``read_earlier``.
    """
    document: dict[str, Any] = parsed(data, lambda *said: InputError(file, *said), remedy)
    said = document.get("format") if isinstance(document, dict) else None
    if said not in SCHEMAS:
        if isinstance(said, str) and said.startswith("rosprivacy.analysis/"):
            known = " and ".join(SCHEMAS)
            raise InputError(file, 0, f"is of the format {shown(said)}, and this version reads {known}", NEWER)
        raise InputError(file, 0, f"is not a document of the format {FORMAT}", remedy)
    wrong = problems(document)
    if wrong:
        more = f" ({len(wrong) - 1} more)" if len(wrong) > 1 else ""
        raise InputError(file, 0, f"damaged or changed: {wrong[0]}{more}", remedy)
    for category in document["categories"]:
        category.setdefault("translations", {})
    return document


def bytes_of(file: str, remedy: str) -> bytes:
    """Return what stands in a file that the program wrote before.

    Parameters
    ----------
    remedy
        How to get such a file: the hint.

    Raises
    ------
    InputError
        If it cannot be read, or is too large.
    """
    try:
        path = Path(file)
        if not path.is_file():
            raise InputError(file, 0, "is not a file" if path.exists() else "not found", remedy)
        if path.stat().st_size > LARGEST:
            raise InputError(file, 0, f"{path.stat().st_size / 2**20:.0f} MB are too large", remedy)
        with path.open("rb") as opened:
            return noted(opened, file).read()
    except (OSError, ValueError) as error:
        raise InputError(file, 0, f"cannot be read: {reason(error)}", remedy) from None


def problems(document: Any) -> list[str]:
    """Return what is wrong in a document, each with its place; what contradicts itself if nothing else is wrong.

    Complexity: O(its size).
    """
    return misfits(_validator(document["format"]), document) or list(_contradictions(document))


@cache
def _validator(form: str) -> Validator:
    schema = files("rosprivacy.report.schemas").joinpath(SCHEMAS[form])
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
