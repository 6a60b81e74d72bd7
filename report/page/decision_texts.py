"""What people decided about findings, as a report shows it.

In: a document with decisions, where there are any. Out: ``DecisionText`` of a finding, and those that match none. What
the law asks for and nobody wrote down is named (``analysis/legal_bases.py``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.legal_bases import gaps
from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.page.index import Index

FIELDS = ("reason", "owner", "legal_basis", "date", "expires", "ticket", "state")
DATES = ("date", "expires")
ACCEPT, ORPHANED = "accept", "orphaned"


@dataclass(frozen=True, slots=True)
class DecisionText:
    """One decision, in words.

    Attributes
    ----------
    decision
        What was decided.
    rows
        (name of the field, value).
    flags
        What has changed since, and what is missing.
    """

    decision: str
    rows: tuple[tuple[str, str], ...]
    flags: tuple[str, ...]


def decision_of(finding: Mapping[str, Any], index: Index) -> DecisionText | None:
    """Return the decision that holds for a finding, or held until it expired; None if there is none."""
    said = finding.get("decision")
    return _decision(said, (finding,), index) if said else None


def orphans(index: Index) -> tuple[DecisionText, ...]:
    """Return the decisions that match no finding, in the order of their file."""
    said = index.document.get("decisions", ())
    return tuple(_decision(entry, (), index) for entry in said if entry["state"] == ORPHANED)


def _decision(decision: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], index: Index) -> DecisionText:
    words, what = index.words, decision["choice"]
    rows = [(words(f"decision.{key}"), _value(decision[key], key, index)) for key in FIELDS if decision[key]]
    flags = (*_changed(decision, index), *(_flags(decision, findings, index) if what == ACCEPT else ()))
    return DecisionText(words.of_value(f"decision.{what}", what), tuple(rows), flags)


def _changed(decision: Mapping[str, Any], index: Index) -> Iterator[str]:
    """What is not as it was when it was decided."""
    for change in decision.get("changed", ()):
        yield index.words(
            f"decision.changed.{change['what']}", before=printable(change["before"]), now=printable(change["now"])
        )


def _value(value: Any, key: str, index: Index) -> str:
    words, text = index.words, printable(str(value))
    if key == "state":
        return words.of_value(f"decision.state.{value}", text)
    if key == "legal_basis":
        return "; ".join(words.basis(printable(str(part))) for part in value)
    return words.date(text) if key in DATES else text


def _flags(decision: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], index: Index) -> Iterator[str]:
    """What an acceptance lacks: a legal basis, a ground for special categories, one of chapter V."""
    held = list(findings)
    law = {f["category"]: tuple(_provisions(f["category"], held)) for f in held}
    for gap in gaps(decision["legal_basis"], [(f["kind"], f["category"]) for f in held], law):
        provision = index.provision(gap.category, gap.provision)
        yield index.words(f"decision.gap.{gap.lack.name.lower()}", data=index.data(gap.category), provision=provision)


def _provisions(category: str, findings: Iterable[Mapping[str, Any]]) -> Iterator[tuple[str, str]]:
    """What can apply to data of a category, where their sources work too."""
    rows = (row for f in findings if f["category"] == category for row in (*f["law"], *f.get("in_context", ())))
    yield from dict.fromkeys((row["provision"], row["verdict"]) for row in rows)
