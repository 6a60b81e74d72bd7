"""Broken rules -> SARIF 2.1.0, for code scanning and editors: each at its line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.sarif.flows import prose
from rosprivacy.report.sarif.log import LEVELS, SCHEMA
from rosprivacy.report.sarif.results import ROOT, Files

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from rosprivacy.analysis.model import Breach, LintRule


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
