"""Broken rules -> the JSON document ``rosprivacy.lint/1``, which is a contract."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Breach
    from rosprivacy.report.contract.policies import BreachEntry, LintDocument

FORMAT = "rosprivacy.lint/1"


def lint_document(
    breaches: Iterable[Breach], files: Iterable[tuple[str, str]], unseen: Iterable[str], version: str
) -> LintDocument:
    """Return the document.

    Parameters
    ----------
    files
        (file, SHA-256) of what was read.
    unseen
        Names of rules that were not looked at, since no labels are named.
    """
    return {
        "format": FORMAT,
        "breaches": [_entry(breach) for breach in breaches],
        "not_looked_at": list(unseen),
        "policies": [{"file": file, "sha256": digest} for file, digest in files],
        "rosprivacy": version,
    }


def _entry(breach: Breach) -> BreachEntry:
    return {
        "rule": breach.rule.name,
        "severity": str(breach.rule.severity),
        "file": breach.place.file,
        "line": breach.place.line,
        "message": breach.message,
        "why": breach.rule.why,
    }
