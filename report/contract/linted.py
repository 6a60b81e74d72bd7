"""The document ``rosprivacy.lint/1``."""

from __future__ import annotations

from typing import TypedDict


class BreachEntry(TypedDict):
    """A rule that is broken at a line; line 0 where it is the file as a whole."""

    rule: str
    severity: str
    file: str
    line: int
    message: str
    why: str


class LintedFile(TypedDict):
    """A file that was read."""

    file: str
    sha256: str


class LintDocument(TypedDict):
    """What is wrong with how policies are written."""

    format: str
    breaches: list[BreachEntry]
    not_looked_at: list[str]
    policies: list[LintedFile]
    rosprivacy: str
