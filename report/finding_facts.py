"""What every report tells alike of findings: their order, what their data is made of, which provisions are looked at.

In: findings, and the JSON document. Out: the findings in the order in which a person decides about them, the worst
first: what is neither dismissed nor accepted; what Article 9 or 10 names, then what may reveal it; data as it is; what
robots do that most of their model do not; then by the weight of the kind, and what others get before what is kept in a
file. Where data is made of other data on the way, of which and by whom: that a source can bring in what it never has
would be false. Of the provisions that a document points at, law of the Union and the national law that is called for:
that of the country where the system works, as label and fleet files state it (``country:``), whatever the language of
the report; without one it is for a person to find.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from rosprivacy.analysis.legal import acceptance_gaps
from rosprivacy.analysis.model import GDPR_DENIED, GDPR_OPEN, MAY_REVEAL, PARTICIPANT, SPECIAL, weight

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.legal import Gap
    from rosprivacy.analysis.model import Element as GraphElement
    from rosprivacy.analysis.model import Weight
    from rosprivacy.report.catalogs.words import Words

Row = TypeVar("Row")
REVEALS = (MAY_REVEAL, "unknown")
STRENGTHS: tuple[tuple[str, ...], ...] = (SPECIAL, REVEALS, ())
OTHERS_GET, KEPT = ("external-system", PARTICIPANT, "person"), ("storage",)  # kinds of elements


def in_order(findings: Iterable[Mapping[str, Any]], document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return findings in the order in which a person decides; else as they are.

    Parameters
    ----------
    document
        That they stand in: it knows the kinds of data, and of a fleet what differs from most of a model.
    """
    outliers = _outliers(document["fleet"]) if document.get("fleet") else set()
    forms = {kind["name"]: kind.get("data_types", ()) for kind in document["categories"]}
    return sorted(
        findings,
        key=lambda f: (
            f["dismissed"],
            bool(f.get("accepted")),
            STRENGTHS.index(strength(f)),
            f["pseudonymised"],
            f["id"] not in outliers,
            weight(_verdicts(f), forms.get(f["category"], ())),
            place_of(f["leak"]["kind"]),
        ),
    )


def grouped(rows: Iterable[Row], pattern: Callable[[Row], Hashable]) -> list[list[Row]]:
    """Return rows of one pattern together, in the order of the first of each.

    >>> grouped(["/up", "/disk", "/upper"], lambda name: name[:3])
    [['/up', '/upper'], ['/disk']]
    """
    groups: dict[Hashable, list[Row]] = {}
    for row in rows:
        groups.setdefault(pattern(row), []).append(row)
    return list(groups.values())


def place_of(kind: str) -> int:
    """Return the place of an element in the order of those where data get out, by what it is.

    >>> [place_of(kind) for kind in ("external-system", "node", "storage")]
    [0, 1, 2]
    """
    return 0 if kind in OTHERS_GET else 2 if kind in KEPT else 1


def weights(document: Mapping[str, Any]) -> dict[str, Weight]:
    """Return the weight of each kind of data of a document."""
    return {kind["name"]: weight(_verdicts(kind), kind.get("data_types", ())) for kind in document["categories"]}


def _verdicts(row: Mapping[str, Any]) -> set[str]:
    """What the law says of a finding or a category."""
    return {legal["verdict"] for legal in row["law"]} | {row["article9"]}


def strength(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return how far data of a finding or a category can be special, under Article 9 or 10.

    ``SPECIAL``, or else ``REVEALS``, or neither.
    """
    verdicts = _verdicts(row)
    return next((some for some in (SPECIAL, REVEALS) if verdicts.intersection(some)), ())


def _outliers(fleet: Mapping[str, Any]) -> set[str]:
    """Findings that some robots have and most of their model have not, or not so."""
    patterns = {share["pattern"] for deviant in fleet["deviants"] for share in deviant["more"]}
    return {pattern["finding"] for pattern in fleet["patterns"] if pattern["id"] in patterns}


Element = TypeVar("Element")


def makers(witness: Sequence[Element], kinds: Sequence[str]) -> list[Element]:
    """Return the elements that make another kind of data of what they get.

    Parameters
    ----------
    kinds
        What leaves each element of the witness, and last what arrives: as many as elements.

    >>> makers(["/scan", "/laser", "/slam", "/map"], ["LaserScan", "LaserScan", "HomeMap", "HomeMap"])
    ['/slam']
    """
    return [element for element, before, after in zip(witness[1:], kinds, kinds[1:], strict=False) if before != after]


def made_of(finding: Mapping[str, Any]) -> tuple[str, list[Mapping[str, Any]]]:
    """Return the kind that the source of a finding brings in, and who makes the finding's kind of it, step by step.

    Complexity: O(steps).

    >>> made_of({"category": "Video", "witness": [{"name": "/camera"}], "steps": []})
    ('Video', [])
    """
    kinds = [*(step["category"] for step in finding["steps"]), finding["category"]]
    return kinds[0], makers(finding["witness"], kinds)


def making(finding: Finding) -> tuple[str, list[GraphElement]]:
    """Return the same of a finding that is no document yet.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> faces, *_ = analyse(*factory()).findings
    >>> kind, by = making(faces)
    >>> kind, [element.name for element in by]
    ('Video', ['/face_id'])
    """
    kinds = [*(step.category for step in finding.steps), finding.category]
    return kinds[0], makers(finding.witness, kinds)


def data_made(
    finding: Mapping[str, Any],
    data: str,
    words: Words,
    title: Callable[[str], str],
    name: Callable[[Mapping[str, Any]], str],
) -> str:
    """Return a finding's data in words, with what they are made of and where, if they are.

    Parameters
    ----------
    data
        The same without.
    title, name
        What a kind of data, and an element, is called.
    """
    kind, by = made_of(finding)
    return words("entry.made", data=data, of=title(kind), makers=words.row(map(name, by))) if by else data


def countries_of_use(document: Mapping[str, Any]) -> list[str]:
    """Return the countries where the system works, as people state them."""
    return sorted({row["country"] for row in document.get("surroundings", ()) if row.get("country")})


def scope_sentences(document: Mapping[str, Any], words: Words) -> list[str]:
    """Return what is asked, or denied, of whether the GDPR applies to systems outside the EEA (Article 3)."""
    places = [row for row in document.get("surroundings", ()) if "gdpr" in row]
    return [
        words(f"law.gdpr.{scope}", countries=words.row(sorted(countries)))
        for scope in (GDPR_OPEN, GDPR_DENIED)
        if (countries := {row["country"] for row in places if row["gdpr"] == scope})
    ]


def looked_at(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the provisions to look at.

    >>> rows = [{"provision": "BDSG § 22", "country": "DE"}, {"provision": "AI Act", "country": ""}]
    >>> [row["provision"] for row in looked_at({"look_at": rows})]
    ['AI Act']
    """
    countries = {"", *countries_of_use(document)}
    return [row for row in document.get("look_at", ()) if row["country"] in countries]


def of_every_system(rows: list[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Return those that no kind of data and no context calls for, but every system.

    >>> of_every_system([{"provision": "AI Act", "categories": [], "contexts": []}])
    [{'provision': 'AI Act', 'categories': [], 'contexts': []}]
    """
    return [row for row in rows if not row["categories"] and not row["contexts"]]


def gaps_of(decision: Mapping[str, Any], findings: Sequence[Mapping[str, Any]]) -> list[Gap]:
    """Return what an acceptance of findings lacks, as rows of a document tell what the law says of their data."""
    law = {f["category"]: tuple(_provisions(f["category"], findings)) for f in findings}
    held = [(f["kind"], f["category"]) for f in findings]
    return list(acceptance_gaps(decision["legal_basis"], decision["expires"] or "", held, law))


def _provisions(category: str, findings: Iterable[Mapping[str, Any]]) -> Iterator[tuple[str, str]]:
    """What can apply to data of a category, where their sources work too."""
    rows = (row for f in findings if f["category"] == category for row in (*f["law"], *f.get("in_context", ())))
    yield from dict.fromkeys((row["provision"], row["verdict"]) for row in rows)
