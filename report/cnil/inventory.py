"""What an analysis knows of each kind of data, in the words of a record of processing (GDPR, Article 30).

In: a ``Document``. Out: one ``Kind`` per emitted category: where it
comes from, where it gets, who cleans it, where it leaves. Nothing here decides anything.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.legal import strongest_first

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Category, Element, Legal
    from rosprivacy.report.document.contents import Document


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of data in the system.

    Attributes
    ----------
    law
        Provisions that a person has to look at, what holds always first.
    sources
        Elements that bring it in.
    derivations
        (element that makes it, category that it is made of).
    reached
        Elements that it gets to, or a narrower kind does, in the order of the graph; the legs of a service are one.
    cleaned
        Who cleans it where it, or a narrower kind, gets to; not who recognises persons or judges them.
    findings
        That are about it, those dismissed left out (rule S10).
    open
        Elements that it reaches and that nobody has reviewed (rule S11).
    """

    category: Category
    law: tuple[Legal, ...]
    sources: tuple[Element, ...]
    derivations: tuple[tuple[Element, str], ...]
    reached: tuple[Element, ...]
    cleaned: tuple[Cleaning, ...]
    findings: tuple[Finding, ...]
    open: tuple[Element, ...]


def kinds_of(document: Document) -> tuple[Kind, ...]:
    """Return what is known of each emitted category, sorted by its name."""
    analysis, categories = document.analysis, document.vocabulary.categories
    reached = _reached(analysis, document.vocabulary.hierarchy)
    here = {(name, element.identity) for name, elements in reached.items() for element in elements}
    shown = analysis.roles  # not of a robot of a fleet that another one stands for
    cleaned = [
        c
        for c in document.sanitizers
        if (c.category, c.element.identity) in here and c.element not in document.recognising
    ]
    makings = [making for making in document.derivations if making.element in shown]
    return tuple(
        Kind(
            category=categories[name],
            law=strongest_first(categories[name].law),
            sources=_distinct(e for e, said in analysis.roles.items() if "source" in said.get(name, ())),
            derivations=_each_once((making.element, making.made_of) for making in makings if making.target == name),
            reached=_distinct(reached[name]),
            cleaned=tuple(c for c in cleaned if c.category == name and c.element in shown),
            findings=tuple(f for f in analysis.findings if f.category == name and not f.dismissed),
            open=_distinct(question.element for question in analysis.open if name in question.categories),
        )
        for name in analysis.emitted
    )


def _reached(analysis: Analysis, hierarchy: Hierarchy) -> dict[str, list[Element]]:
    """Category -> elements that carry it; what is carried counts for broader categories too (rule S7)."""
    found: dict[str, list[Element]] = defaultdict(list)
    for carried in analysis.carried:
        names = {*carried.categories, *carried.pseudonymised}
        for name in {above for narrow in names for above in hierarchy.ancestors[narrow]}:
            found[name].append(carried.element)
    return found


def _each_once(rows: Iterable[tuple[Element, str]]) -> tuple[tuple[Element, str], ...]:
    return tuple(dict.fromkeys(rows))


def _distinct(elements: Iterable[Element]) -> tuple[Element, ...]:
    """One of each identity, the first, in order."""
    first: dict[tuple[str, str, str], Element] = {}
    for element in elements:
        first.setdefault(element.identity, element)
    return tuple(first.values())
