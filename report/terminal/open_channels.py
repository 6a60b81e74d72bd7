"""Findings of unprotected channels that one line of a governance stands behind, told as one in the list of findings.

In: findings of a JSON document, in order. Out: groups; and what is said of one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import UNPROTECTED
from rosprivacy.report.naming import key

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words

NAMED = 4  # kinds of data in one line


def by_line(findings: Iterable[Mapping[str, Any]]) -> list[list[Mapping[str, Any]]]:
    """Return findings in their order; those that stand for one reason with a line of a governance are together."""
    groups: dict[Any, list[Mapping[str, Any]]] = {}
    for finding in findings:
        stands = finding["kind"] == UNPROTECTED and not finding["accepted"]
        groups.setdefault(finding["reason"] if stands else finding["id"], []).append(finding)
    return list(groups.values())


def group_line(group: Sequence[Mapping[str, Any]], reason: str, words: Words) -> str:
    """Return what is said of findings that one line stands behind.

    Parameters
    ----------
    reason
        That of each of them, in words.
    """
    kinds = words.row(words.first(list(dict.fromkeys(finding["category"] for finding in group)), NAMED))
    channels = {key(finding["leak"]) for finding in group}
    counts = [words.count(len(group), "tty.finding"), words.count(len(channels), "tty.channel")]
    return f"{words(f'tty.kind.{UNPROTECTED}', data=kinds)}, {', '.join(counts)}; {reason}"
