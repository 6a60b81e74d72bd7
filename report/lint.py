"""Broken rules -> the JSON document ``rosprivacy.lint/1`` (a contract), lines for the terminal, and SARIF 2.1.0."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.sarif.locations import prose
from rosprivacy.report.sarif.log import LEVELS, SCHEMA
from rosprivacy.report.sarif.results import ROOT, Files

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from rosprivacy.analysis.model import Breach, LintRule
    from rosprivacy.report.schemas.policies import BreachEntry, LintDocument

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


def lint_lines(document: LintDocument) -> Iterator[str]:
    """Yield a line for each broken rule, then how often which rule is broken and what comes of it."""
    breaches = document["breaches"]
    for breach in breaches:
        place = f"{shown(breach['file'])}:{breach['line']}" if breach["line"] else shown(breach["file"])
        yield f"{place}: {breach['severity']} {breach['rule']}: {breach['message']}"
    if not breaches:
        yield f"no rule is broken in {counted(len(document['policies']), 'file')}"
        yield from _unseen(document)
        return
    yield ""
    times = Counter(breach["rule"] for breach in breaches)
    why = {breach["rule"]: breach["why"] for breach in breaches}
    for rule, count in times.items():
        yield f"{rule} ({count}): {why[rule]}"
    yield from _unseen(document)


def _unseen(document: LintDocument) -> Iterator[str]:
    for rule in document["not_looked_at"]:
        yield f"{rule} was not looked at: it needs labels; name them with -l"


def lint_sarif(
    breaches: Sequence[Breach], rules: Iterable[LintRule], files: Iterable[tuple[str, str]], version: str, root: Path
) -> dict[str, Any]:
    """Return a SARIF log of one run.

    Parameters
    ----------
    rules
        All that were looked at.
    files
        (file, SHA-256) of what was read.
    root
        Absolute folder that files are shown relative to.
    """
    named, looked_at = Files(root), list(rules)
    number = {rule.name: at for at, rule in enumerate(looked_at)}
    driver = {"name": "rosprivacy lint", "version": version, "rules": [_descriptor(rule) for rule in looked_at]}
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {ROOT: {"description": {"text": "The root of the repository."}}},
        "artifacts": [
            {"location": named.artifact(file), "roles": ["analysisTarget"], "hashes": {"sha-256": digest}}
            for file, digest in files
        ],
        "results": [
            {
                "ruleId": breach.rule.name,
                "ruleIndex": number[breach.rule.name],
                "level": LEVELS[breach.rule.severity],
                "message": {"text": prose(breach.message)},
                "locations": [{"physicalLocation": named.physical(breach.place)}],
            }
            for breach in breaches
        ],
    }
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _descriptor(rule: LintRule) -> dict[str, Any]:
    return {
        "id": rule.name,
        "shortDescription": {"text": f"{rule.about[0].upper()}{rule.about[1:]}."},
        "fullDescription": {"text": f"{rule.why[0].upper()}{rule.why[1:]}."},
        "defaultConfiguration": {"level": LEVELS[rule.severity]},
    }
