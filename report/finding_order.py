"""In which order a person decides about findings, in every report.

In: findings of a JSON document, and the document. Out: the same, the worst first: what is neither dismissed nor
accepted; what Article 9 or 10 names, then what may reveal it; data as it is; what robots do that most of their model do
not; then by the weight of the kind, and what others get before what is kept in a file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import MAY_REVEAL, PARTICIPANT, SPECIAL, weight

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.model import Weight

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
