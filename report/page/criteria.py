"""The nine criteria of WP 248 rev.01 for an impact assessment (GDPR, Article 35), and what is seen of each.

In: an ``Index``. Out: what the document shows; never that no assessment is needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import SENSED, SPECIAL
from rosprivacy.report.finding_order import REVEALS, strength
from rosprivacy.report.page.entries_of_robots import weight

if TYPE_CHECKING:
    from rosprivacy.report.page.index import Index

PERSONAL = {"CommunicationContent", "CommunicationMetadata", "Household", "Location", "Voice"}  # WP 248, criterion 4
SHOWN_AT_MOST = 6


@dataclass(frozen=True, slots=True)
class AssessmentCriterion:
    """One criterion: its name, and what the analysis shows of it, empty if only a person can say."""

    name: str
    shows: str


def criteria(index: Index) -> tuple[AssessmentCriterion, ...]:
    """Return all nine, in their order."""
    words = index.words
    makes = _makes(index)
    new = _innovative(makes, index)
    shows = [makes, "", _observes(index), _special(index), _scale(index), _combines(index), _subjects(index), new, ""]
    return tuple(AssessmentCriterion(words(f"criterion.{number}"), said) for number, said in enumerate(shows, 1))


def _row(texts: list[str], index: Index) -> str:
    return index.words.row(index.words.first(texts, SHOWN_AT_MOST))


def _makes(index: Index) -> str:
    rows = [row for row in index.document["derivations"] if row["reached"]]
    texts = [
        index.words("criterion.make", element=element, data=index.data(made), of=index.data(of))
        for of, made in dict.fromkeys((row["from"], row["to"]) for row in rows)
        for element in index.names([r["element"] for r in rows if (r["from"], r["to"]) == (of, made)])
    ]
    return index.words("criterion.makes", names=_row(texts, index)) if texts else ""


def _observes(index: Index) -> str:
    sources = [
        index.elements[element]
        for element, categories in index.of_role.get("source", {}).items()
        if any(not set(index.categories[category]["data_types"]).isdisjoint(SENSED) for category in categories)
    ]
    return index.words("criterion.observes", names=_row(list(index.names(sources)), index)) if sources else ""


def _special(index: Index) -> str:
    """Special categories, data of Article 10, and what is highly personal all the same, as WP 248 lists them."""
    kinds = index.categories.items()
    groups = {
        "criterion.special": [name for name, category in kinds if strength(category) == SPECIAL],
        "criterion.reveals": [name for name, category in kinds if strength(category) == REVEALS],
        "criterion.personal": [name for name in index.categories if PERSONAL.intersection(index.upwards(name))],
    }
    said = [index.words(key, names=index.all_data(names)) for key, names in groups.items() if names]
    return "; ".join(said) or (index.words("criterion.none") if index.categories else "")


def _innovative(makes: str, index: Index) -> str:
    if not index.of_role.get("source"):
        return makes
    return index.words("criterion.innovative", makes=f"; {makes}" if makes else "")


def _scale(index: Index) -> str:
    return index.words("criterion.scale", robots=index.words.count(max(1, len(index.robots())), "robot"))


def _combines(index: Index) -> str:
    """Elements that get kinds of data of which none is the broader one of another."""
    several = [row for row in index.document["carries"] if len({*row["categories"], *row["pseudonymised"]}) > 1]
    at = [row["element"] for row in several if row["element"]["kind"] not in ("topic", "service", "action")]
    if not at:
        return ""
    robots = {(element["kind"], element["name"], element["robot"]) for element in at}
    number = weight((robot for *_, robot in robots), index.alike)
    names = _row(list(index.names(at)), index)
    return index.words("criterion.combines", elements=index.words.count(number, "element"), names=names)


def _subjects(index: Index) -> str:
    groups = sorted({group for said in index.subjects.values() for group in said})
    return index.words("criterion.subjects", names=_row(groups, index)) if groups else ""
