"""What a person has to decide: each flow of a kind of data from a source to a place, once.

In: an ``Index`` and the entries of the report, in the order of weight. Out: ``ToDecide``, in plain texts; what waits
for a decision first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.legal import CHAPTER_V
from rosprivacy.analysis.model import NO_BASIS, THIRD_COUNTRY
from rosprivacy.analysis.non_ros import INSIDE
from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.finding_facts import data_made, grouped
from rosprivacy.report.naming import key, name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index

SHOWN_AT_MOST = 3  # elements in one row
VALID = "valid"
WITH_A_CONTRACT = ("processor", "joint-controller")  # Articles 28 and 26
TO_DECIDE = ("open", "decided")  # states of entries

Fact = tuple[str, str]  # what it is about, as a part of a key of words, and its value; empty if it is not stated


class ToDecide(NamedTuple):
    """One flow to decide: a kind of data, from where, to whom.

    Attributes
    ----------
    waits
        Whether nobody has decided yet, or the decision no longer holds.
    content
        The data, with what they are made of and where, if they are.
    kinds
        Of the findings, in words.
    entries
        The entries of the report that it is; several where one flow is several findings.
    spread
        On which robots, in sentences; empty where there is one.
    facts
        Whose data, provisions, legal basis, owner, state.
    persons
        Whose data, in words, also where that is not stated.
    """

    waits: bool
    data: str
    content: str
    source: str
    leak: str
    article9: str
    kinds: tuple[str, ...]
    spread: tuple[str, ...]
    facts: tuple[Fact, ...]
    persons: str
    entries: tuple[PathEntry, ...]


def flows(index: Index, entries: Iterable[PathEntry]) -> list[ToDecide]:
    """Return the flows that are decided by themselves, what waits for somebody first, what is accepted last."""
    decided = [entry for entry in entries if entry.state != "dismissed"]
    rows = [_row(group, index) for group in grouped(decided, _flow)]
    return sorted(rows, key=lambda row: (row.entries[0].state not in TO_DECIDE, not row.waits))


def _flow(entry: PathEntry) -> Any:
    same = (entry.category, entry.source, entry.leak, entry.robots, entry.pseudonymised)
    return same, entry.mark, entry.state in TO_DECIDE


def first_names(names: Sequence[str], index: Index) -> str:
    """Return the first of some names, and how many more there are, in words."""
    return index.words.row(index.words.first(names, SHOWN_AT_MOST))


def _row(group: Sequence[PathEntry], index: Index) -> ToDecide:
    findings = [index.by_id[entry.id] for entry in group]
    first, entry = findings[0], group[0]
    many = len(entry.robots) > 1

    def name_of(element: Mapping[str, Any]) -> str:
        return _name(element, index, many=many)

    return ToDecide(
        waits=any(_waits(finding, index) for finding in findings),
        data=entry.data,
        content=data_made(first, entry.data, index.words, index.data, name_of),
        source=name_of(first["source"]),
        leak=name_of(first["leak"]),
        article9=entry.article9,
        kinds=tuple(index.words(f"finding.{kind}") for kind in _kinds(findings, index)),
        spread=entry.spread,
        facts=tuple(_facts(findings, index)),
        persons=_persons(first, index) or index.words("not.stated"),
        entries=tuple(group),
    )


def _kinds(findings: Sequence[Mapping[str, Any]], index: Index) -> Iterator[str]:
    """What the findings are, and a transfer also where a basis is stated: that its place is in a third country."""
    kinds = dict.fromkeys(finding["kind"] for finding in findings)
    yield from kinds
    abroad = any(index.outside.get(key(f["leak"]), {}).get("area", INSIDE) not in ("", INSIDE) for f in findings)
    if abroad and THIRD_COUNTRY not in kinds:
        yield THIRD_COUNTRY


def _name(element: Mapping[str, Any], index: Index, *, many: bool) -> str:
    """A name; without its robot where it stands for several."""
    return fit(element["name"]) if many and element["robot"] in index.alike else name(element)


def _waits(finding: Mapping[str, Any], index: Index) -> bool:
    """Whether nobody has decided about it, or the decision is over, about something else now, or about some robots."""
    said = finding.get("decision")
    return not said or said["state"] != VALID or bool(said.get("changed") or _robots_decided(finding, index))


def _robots_decided(finding: Mapping[str, Any], index: Index) -> str:
    """Return the robots that a decision names, where the finding stands for more."""
    said, pattern = finding.get("decision"), index.patterns.get(finding["id"], {})
    robots = pattern.get("robots", ())
    if not said or len(robots) <= 1:
        return ""
    place = said["file"], said["line"]
    decisions = index.document.get("decisions", ())
    target: Mapping[str, Any] = next((d["target"] for d in decisions if (d["file"], d["line"]) == place), {})
    listed = target.get("from_robots") or target.get("robots", ())
    if listed and (pattern["across"] or not set(robots) <= set(listed)):
        return first_names([fit(one) for one in listed], index)
    return fit(target.get("robot", ""))


def _facts(findings: Sequence[Mapping[str, Any]], index: Index) -> Iterator[Fact]:
    words = index.words
    yield "whose", _persons(findings[0], index)
    yield "law", "; ".join(dict.fromkeys(_provisions(findings, index)))
    yield "basis", words.row(_bases(findings, index))
    yield "owner", words.row(_owners(findings))
    yield "state", words.row(dict.fromkeys(_state(finding, index) for finding in findings))


def _persons(finding: Mapping[str, Any], index: Index) -> str:
    return index.words.row(index.subjects.get(key(finding["source"]), ()))


def _provisions(findings: Sequence[Mapping[str, Any]], index: Index) -> Iterator[str]:
    for finding in findings:
        yield index.words(f"opening.law.{finding['kind']}")
        for legal in finding["law"]:
            cited = index.provision(finding["category"], legal["provision"])
            yield cited.partition(" (")[0]  # without its title, which stands where the law is told
    for finding in findings:
        yield from _of_recipient(index.outside.get(key(finding["leak"]), {}), index)


def _of_recipient(stated: Mapping[str, Any], index: Index) -> Iterator[str]:
    """Provisions on who gets the data, whatever the finding is about: a transfer with a stated basis is one."""
    if stated.get("transfer", NO_BASIS) != NO_BASIS and stated.get("area") != INSIDE:
        yield index.words(f"opening.law.{THIRD_COUNTRY}")
    if stated.get("recipient") in WITH_A_CONTRACT:
        yield index.words(f"opening.law.{stated['recipient']}")


def _bases(findings: Sequence[Mapping[str, Any]], index: Index) -> list[str]:
    """The legal bases that decisions record, and those that labels state where the data get to."""
    ends = [index.processed_for.get((key(finding["leak"]), finding["category"]), {}) for finding in findings]
    decided = [basis for finding in findings for basis in _decided(finding, "legal_basis")]
    stated = [basis for end in ends for basis in end.get("legal_bases", ())]
    bases = dict.fromkeys((*decided, *stated))
    leaves = any(finding["kind"] == THIRD_COUNTRY for finding in findings)
    lacks = bases and leaves and not any(basis.startswith(CHAPTER_V) for basis in bases)
    return [
        *map(index.words.basis, map(printable, bases)),
        *([index.words("opening.basis.chapter_v")] if lacks else []),
    ]


def _owners(findings: Iterable[Mapping[str, Any]]) -> list[str]:
    owners = (_decided(finding, "owner") for finding in findings)
    return [printable(owner) for owner in dict.fromkeys(owners) if owner]


def _decided(finding: Mapping[str, Any], key: str) -> Any:
    return (finding.get("decision") or {}).get(key) or ""


def _state(finding: Mapping[str, Any], index: Index) -> str:
    """What was decided, and whether it still holds."""
    words, said = index.words, finding.get("decision")
    if not said:
        return words("state.open")
    decided = words.of_value(f"decision.{said['choice']}", printable(said["choice"]))
    if only := _robots_decided(finding, index):
        decided = words("opening.only", decided=decided, robot=only)
    if said.get("changed"):
        decided = words("opening.changed", decided=decided)
    state = words.of_value(f"decision.state.{said['state']}", printable(said["state"]))
    return decided if said["state"] == VALID else f"{decided}; {state}"
