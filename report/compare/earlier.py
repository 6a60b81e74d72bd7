"""A JSON document that was saved, to compare with or to decide about: read, and checked whole before it is used.

In: a path. Out: ``Earlier``. For ``diff``, ``report --since`` and ``decide --report``, and for what Parquet holds.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputError, reason, shown
from rosprivacy.analysis.files_read import noted
from rosprivacy.analysis.json_values import parsed
from rosprivacy.report.compare.validity import problems
from rosprivacy.report.document.analysis import FORMAT

if TYPE_CHECKING:
    from collections.abc import Mapping

HINT = "give what 'rosprivacy analyze --format json' printed"
NEWER = "use the version of rosprivacy that wrote it, or write it again"
LARGEST = 512 * 2**20  # bytes


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
        If it cannot be read, or is no such document; with the first place where it is not, and how many more.
    """
    data = bytes_of(file, HINT)
    return Earlier(document_of(data, file, HINT), file, hashlib.sha256(data).hexdigest())


def document_of(data: bytes, file: str, again: str) -> Mapping[str, Any]:
    """Return the document that some bytes are, if they are one.

    Parameters
    ----------
    again
        How to get one: the hint.

    Raises
    ------
    InputError
        As ``read_earlier``.
    """
    document: dict[str, Any] = parsed(data, lambda *said: InputError(file, *said), again)
    said = document.get("format") if isinstance(document, dict) else None
    if said != FORMAT:
        if isinstance(said, str) and said.startswith("rosprivacy.analysis/"):
            raise InputError(file, 0, f"is of the format {shown(said)}, and this version reads {FORMAT}", NEWER)
        raise InputError(file, 0, f"is not a document of the format {FORMAT}", again)
    wrong = problems(document)
    if wrong:
        more = f" ({len(wrong) - 1} more)" if len(wrong) > 1 else ""
        raise InputError(file, 0, f"damaged or changed: {wrong[0]}{more}", again)
    for category in document["categories"]:
        category.setdefault("translations", {})
    return document


def bytes_of(file: str, again: str) -> bytes:
    """Return what stands in a file that the program wrote before.

    Parameters
    ----------
    again
        How to get such a file: the hint.

    Raises
    ------
    InputError
        If it cannot be read, or is too large.
    """
    try:
        path = Path(file)
        if not path.is_file():
            raise InputError(file, 0, "is not a file" if path.exists() else "not found", again)
        if path.stat().st_size > LARGEST:
            raise InputError(file, 0, f"{path.stat().st_size / 2**20:.0f} MB are too large", again)
        with path.open("rb") as opened:
            return noted(opened, file).read()
    except (OSError, ValueError) as error:
        raise InputError(file, 0, f"cannot be read: {reason(error)}", again) from None
