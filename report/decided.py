"""What people decided about findings, as a report shows it.

In: the ``decisions`` of a document, where there are any. Out: ``Decision`` by id of the finding, and those that match
none. What the law asks for and nobody wrote down is named (GDPR, Article 6(1) and 9(2)).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.report.index import CAN_BE_SPECIAL
from rosprivacy.report.naming import printable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.index import Index

FIELDS = ("reason", "owner", "legal_basis", "special_basis", "expires", "state")
ACCEPT, EXPIRED, ORPHANED = "accept", "expired", "orphaned"


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision, in words.

    Attributes
    ----------
    decision
        What was decided.
    rows
        (name of the field, value).
    flags
        What is missing.
    findings
        Ids that it is about; empty if it matches none.
    """

    decision: str
    rows: tuple[tuple[str, str], ...]
    flags: tuple[str, ...]
    findings: tuple[str, ...]


def decisions(index: Index) -> tuple[Decision, ...]:
    """Return the decisions of a document, in its order."""
    return tuple(_decision(said, index) for said in index.document.get("decisions", ()))


def by_finding(found: tuple[Decision, ...]) -> dict[str, Decision]:
    """Return the decision of each finding."""
    return {finding: decision for decision in found for finding in decision.findings}


def _decision(said: Mapping[str, Any], index: Index) -> Decision:
    words = index.words
    what = said.get("decision", "")
    known = {finding["id"]: finding for finding in index.findings}
    named = said.get("findings") or [said[key] for key in ("finding", "id") if said.get(key)]
    findings = tuple(finding for finding in named if finding in known)
    rows = [(words(f"d.{key}"), _value(said[key], key, index)) for key in FIELDS if said.get(key)]
    if not findings and said.get("state") != ORPHANED:
        rows.append((words("d.state"), words(f"d.state.{ORPHANED}")))
    flags = tuple(_flags(said, [known[finding] for finding in findings], index)) if what == ACCEPT else ()
    return Decision(words.known(f"d.{what}", what), tuple(rows), flags, findings)


def _value(value: Any, key: str, index: Index) -> str:
    if key == "state":
        return index.words.known(f"d.state.{value}", printable(str(value)))
    return index.words.row(printable(str(part)) for part in (value if isinstance(value, list) else [value]))


def _flags(said: Mapping[str, Any], findings: list[Mapping[str, Any]], index: Index) -> Iterator[str]:
    """What an acceptance lacks: a basis; an exception where the data can be a special category."""
    if not said.get("legal_basis"):
        yield index.words("d.basis.missing")
    if not said.get("special_basis") and any(finding["article9"] in CAN_BE_SPECIAL[:2] for finding in findings):
        yield index.words("d.special.missing")
