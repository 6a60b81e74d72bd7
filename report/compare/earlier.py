"""A JSON document that was saved, to compare with: read, and checked as far as a comparison needs it.

In: a path. Out: ``Earlier``. For ``diff`` and for ``report --since``.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputError, reason, shown
from rosprivacy.analysis.files_read import noted
from rosprivacy.report.document.analysis import FORMAT

if TYPE_CHECKING:
    from collections.abc import Mapping

HINT = "give what 'rosprivacy analyze --format json' printed"
LARGEST = 512 * 2**20  # bytes
TEXT, TRUTH, NUMBER = str, bool, int
ELEMENT = {"robot": TEXT, "kind": TEXT, "name": TEXT}
FINDING = {
    "id": TEXT, "kind": TEXT, "category": TEXT, "pseudonymised": TRUTH, "dismissed": TRUTH, "disjoint_paths": NUMBER,
    "source": ELEMENT, "leak": ELEMENT, "witness": [ELEMENT],
}  # fmt: skip
ENTRY = {"file": TEXT, "sha256": TEXT}
PATTERN = {"finding": TEXT, "across": TRUTH, "findings": NUMBER, "dismissed": NUMBER, "pseudonymised": NUMBER}
DOCUMENT = {
    "verdict": TEXT,
    "findings": [FINDING],
    "open": [{"element": ELEMENT, "categories": [TEXT]}],
    "carries": [{"element": ELEMENT, "categories": [TEXT], "pseudonymised": [TEXT]}],
    "roles": [{"element": ELEMENT, "category": TEXT, "roles": [TEXT]}],
    "categories": [{"name": TEXT, "title": TEXT}],
    "assumptions": {"policies": [ENTRY], "labels": [ENTRY]},
}


FLEET = {
    "alike": [{"robot": TEXT, "model": TEXT, "robots": [TEXT]}],
    "patterns": [PATTERN | {"robots": [TEXT]}],
}
OUTSIDE = [{"element": ELEMENT}]


@dataclass(frozen=True, slots=True)
class Earlier:
    """A document to compare with, and the file that it comes from."""

    document: Mapping[str, Any]
    file: str
    sha256: str


def read_earlier(file: str) -> Earlier:
    """Read a document that was written before.

    Raises
    ------
    InputError
        If it cannot be read, or is no such document.
    """
    try:
        path = Path(file)
        if not path.is_file():
            raise InputError(file, 0, "is not a file", HINT)
        if path.stat().st_size > LARGEST:
            raise InputError(file, 0, f"{path.stat().st_size / 2**20:.0f} MB are too large", HINT)
        with path.open("rb") as opened:
            data = noted(opened, file).read()
        document = json.loads(data.decode("utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        line = getattr(error, "lineno", 0)
        raise InputError(file, line, f"cannot be read: {reason(error)}", HINT) from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError(file, 0, f"is not a document of the format {FORMAT}", HINT)
    if wrong := _wrong(document, DOCUMENT | _more(document), ""):
        raise InputError(file, 0, f"{shown(wrong)} is missing or of another type", HINT)
    for category in document["categories"]:
        category.setdefault("translations", {})
    return Earlier(document, file, hashlib.sha256(data).hexdigest())


def _more(document: dict[str, Any]) -> dict[str, Any]:
    """What a document may lack."""
    return {key: shape for key, shape in (("fleet", FLEET), ("outside", OUTSIDE)) if key in document}


def _wrong(value: Any, expected: Any, at: str) -> str:
    """Where a value is not what is expected; empty if nowhere."""
    if isinstance(expected, type):
        fits = isinstance(value, expected) and (expected is not int or not isinstance(value, bool))
        return "" if fits else at
    if isinstance(expected, list):
        if not isinstance(value, list):
            return at
        return next((w for i, item in enumerate(value) if (w := _wrong(item, expected[0], f"{at}[{i}]"))), "")
    if not isinstance(value, dict):
        return at or "the document"
    checked = ((key, value.get(key), kind) for key, kind in expected.items())
    return next((w for key, item, kind in checked if (w := _wrong(item, kind, f"{at}.{key}".strip(".")))), "")
