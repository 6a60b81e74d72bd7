"""Legal bases as people write them in our files -> ``6(1)(f)``: one grammar for labels, fleets and decisions.

In: values that know their line. Out: articles of the GDPR; a problem for each that is none. Whether one fits is for
people to judge; what is missing is said by ``analysis/legal.py``.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Protocol

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.reading.yaml_values import Value

_ARTICLES = (  # 6 and 9 of the processing, 10, chapter V of a transfer
    r"6\(1\)\([a-f]\)|6\(4\)|9\(2\)\([a-j]\)|9\(3\)|10|45|46\(2\)\([a-f]\)|46\(3\)|47|49\(1\)\([a-g]\)"
)
_BASIS = re.compile(rf"(?:art(?:icle|\.)?\s*)?({_ARTICLES})(?:\s*gdpr)?", re.IGNORECASE)
_DPV = re.compile(r"(?:eu-gdpr:)?A(\d+)-(\d)-([a-j])")
HINT = "write such as 6(1)(f), 9(2)(h) for special categories, 46(2)(c) for a transfer"


class Reader(Protocol):
    """Who gathers problems."""

    def problem(self, line: int, problem: str, hint: str) -> None:
        """Take a problem."""


def legal_basis(written: str) -> str | None:
    """Return a legal basis as ``6(1)(f)`` or ``9(2)(h)``, however it is written; None if it is none.

    >>> legal_basis("Article 6(1)(f)"), legal_basis("eu-gdpr:A9-2-h"), legal_basis("consent")
    ('6(1)(f)', '9(2)(h)', None)
    """
    dpv = _DPV.fullmatch(written.strip())
    found = _BASIS.fullmatch(f"{dpv[1]}({dpv[2]})({dpv[3]})" if dpv else written.strip())
    return found[1].lower() if found else None


def read_bases(reader: Reader, value: Value) -> Iterator[str]:
    """Yield the legal bases of a list, or of one text; what is none is a problem."""
    for item in value.items if value.kind == "list" else (value,):
        found = legal_basis(item.text)
        if found:
            yield found
        else:
            reader.problem(item.line, f"legal basis {shown(item.text or item.kind)!r}", HINT)
