"""What an analysis knows of each kind of data, in the words of a record of processing (GDPR, Article 30).

In: an ``Analysis``, its categories, what was said of its elements. Out: one ``Kind`` per emitted category: where it
comes from, where it gets, who cleans it, where it leaves. Nothing here decides anything.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import ARTICLE_9_VERDICTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Category, Element, Legal

_STRENGTH = {verdict: number for number, verdict in enumerate(ARTICLE_9_VERDICTS)}


@dataclass(frozen=True, slots=True)
class Cleaning:
    """That an element cleans a kind of data.

    Attributes
    ----------
    method
        As labelled; ``stated`` says whether the label states it (rule S8).
    """

    element: Element
    category: str
    method: str
    stated: bool


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of data in the system.

    Attributes
    ----------
    law
        Provisions that a person has to look at, what holds always first.
    sources
        Elements that bring it in.
    made
        (element that makes it, category that it is made of).
    reached
        Elements that it gets to, or a narrower kind does, in the order of the graph; the legs of a service are one.
    findings
        That are about it, those dismissed left out (rule S10).
    open
        Elements that it reaches and that nobody has reviewed (rule S11).
    """

    category: Category
    law: tuple[Legal, ...]
    sources: tuple[Element, ...]
    made: tuple[tuple[Element, str], ...]
    reached: tuple[Element, ...]
    cleaned: tuple[Cleaning, ...]
    findings: tuple[Finding, ...]
    open: tuple[Element, ...]


def kinds_of(analysis: Analysis, categories: Mapping[str, Category], hierarchy: Hierarchy) -> tuple[Kind, ...]:
    """Return what is known of each emitted category, sorted by its name."""
    reached = _reached(analysis, hierarchy)
    cleaned = list(cleanings(analysis, hierarchy))
    made = list(_made(analysis))
    return tuple(
        Kind(
            category=categories[name],
            law=law_of(categories[name]),
            sources=_distinct(e for e, said in analysis.roles.items() if "source" in said.get(name, ())),
            made=tuple(dict.fromkeys((element, of) for element, of, to in made if to == name)),
            reached=_distinct(reached[name]),
            cleaned=tuple(cleaning for cleaning in cleaned if cleaning.category == name),
            findings=tuple(f for f in analysis.findings if f.category == name and not f.dismissed),
            open=_distinct(question.element for question in analysis.open if name in question.categories),
        )
        for name in analysis.emitted
    )


def law_of(category: Category) -> tuple[Legal, ...]:
    """Return the provisions of a category, what holds always first; the same said twice once."""
    distinct = {(legal.iri, legal.verdict, legal.condition): legal for legal in category.law}.values()
    return tuple(sorted(distinct, key=lambda legal: (_STRENGTH.get(legal.verdict, len(_STRENGTH)), legal.name)))


def cleanings(analysis: Analysis, hierarchy: Hierarchy) -> Iterator[Cleaning]:
    """Yield what cleans what gets there, by the label that decides it, in the order of the graph."""
    reached = _reached(analysis, hierarchy)
    here = {(name, element.identity) for name, elements in reached.items() for element in elements}
    for vertex, element in enumerate(analysis.graph.elements):
        for category, roles in sorted(analysis.roles.get(element, {}).items()):
            fact = analysis.spread.facts[vertex][category]
            there = "sanitizer" in roles and (category, element.identity) in here
            for said in fact.by_role("sanitizer")[:1] if there else ():
                yield Cleaning(element, category, str(said.method), said.stated)


def _made(analysis: Analysis) -> Iterator[tuple[Element, str, str]]:
    """(element, of, to) of each derivation."""
    for vertex, decided in sorted(analysis.spread.facts.items()):
        if analysis.graph.elements[vertex] not in analysis.roles:  # a robot of a fleet that another one stands for
            continue
        for category, fact in sorted(decided.items()):
            for to in fact.derives:
                if to == category:  # what is a narrower kind already, made of itself
                    continue
                yield analysis.graph.elements[vertex], category, to


def _reached(analysis: Analysis, hierarchy: Hierarchy) -> dict[str, list[Element]]:
    """Category -> elements that carry it; what is carried counts for broader categories too (rule S7)."""
    found: dict[str, list[Element]] = defaultdict(list)
    for carried in analysis.carried:
        names = {*carried.categories, *carried.pseudonymised}
        for name in {above for narrow in names for above in hierarchy.ancestors[narrow]}:
            found[name].append(carried.element)
    return found


def _distinct(elements: Iterable[Element]) -> tuple[Element, ...]:
    """One of each identity, the first, in order."""
    first: dict[tuple[str, str, str], Element] = {}
    for element in elements:
        first.setdefault(element.identity, element)
    return tuple(first.values())
