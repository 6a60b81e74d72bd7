"""In which order a person decides about findings, in every report (users.md, B2).

In: findings of a JSON document, and its fleet. Out: the same, the worst first: what is neither dismissed nor accepted;
what Article 9 or 10 names, then what may reveal it; data as it is; what robots do that most of their model do not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import ARTICLE_9_VERDICTS, MAY_REVEAL, SPECIAL

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

REVEALS = (MAY_REVEAL, "unknown")
STRENGTHS: tuple[tuple[str, ...], ...] = (SPECIAL, REVEALS, ())


def in_order(findings: Iterable[Mapping[str, Any]], fleet: Mapping[str, Any] | None = None) -> list[Mapping[str, Any]]:
    """Return findings in the order in which a person decides; else as they are.

    Parameters
    ----------
    fleet
        Of the document, where there is one: it knows what differs from most of a model.
    """
    outliers = _outliers(fleet) if fleet else set()
    return sorted(
        findings,
        key=lambda f: (
            f["dismissed"],
            bool(f.get("accepted")),
            STRENGTHS.index(strength(f)),
            f["pseudonymised"],
            f["id"] not in outliers,
            ARTICLE_9_VERDICTS.index(f["article9"]),
        ),
    )


def strength(row: Mapping[str, Any]) -> tuple[str, ...]:
    """Return how far data of a finding or a category can be special, under Article 9 or 10.

    ``SPECIAL``, or else ``REVEALS``, or neither.
    """
    verdicts = {legal["verdict"] for legal in row["law"]} | {row["article9"]}
    return next((some for some in (SPECIAL, REVEALS) if verdicts.intersection(some)), ())


def _outliers(fleet: Mapping[str, Any]) -> set[str]:
    """Findings that some robots have and most of their model have not, or not so."""
    patterns = {share["pattern"] for deviant in fleet["deviants"] for share in deviant["more"]}
    return {pattern["finding"] for pattern in fleet["patterns"] if pattern["id"] in patterns}
