"""What an analysis knows of each kind of data, in the words of a record of processing (GDPR, Article 30).

In: a ``Document``. Out: one ``Kind`` per emitted category: where it comes from, where it gets, who cleans it, where it
leaves; as ``Html`` (112, 211, 212 of the CNIL's tool) who is responsible, what data are processed for and on which
basis, empty where nobody stated anything: the tool counts an empty answer as work begun. Nothing here decides anything.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.processed import BASIS, PURPOSE
from rosprivacy.analysis.legal import strongest_first
from rosprivacy.report.cnil.told import Html, bullets, escaped, joined, paragraph, prose, strong

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Category, Element, Legal
    from rosprivacy.report.cnil.told import Told
    from rosprivacy.report.document.contents import Document

    Rows = Iterable[Processed]


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


def responsible(rows: Rows, words: Told) -> Html:
    """Return the answer to 112: who is responsible, and the data-protection officers."""
    controllers = dict.fromkeys(one for row in rows for one in row.controllers)
    officers = dict.fromkeys(one for row in rows for one in row.officers)
    said = [words.pair(words("cnil.controller"), prose(one)) for one in controllers]
    said += [words.pair(words("cnil.officer"), prose(one)) for one in officers]
    return joined(bullets(said), paragraph(words("cnil.responsible.open"))) if said else Html("")


def purposes(rows: Rows, kinds: Iterable[Kind], words: Told) -> Html:
    """Return the answer to 211: what each kind of data is processed for, and where."""
    return _by_kind(rows, kinds, words, lambda row: _stated(row, row.purposes, PURPOSE, words, str))


def bases(rows: Rows, kinds: Iterable[Kind], words: Told) -> Html:
    """Return the answer to 212: on which basis each kind of data is processed, and where; no word that it fits."""
    said = _by_kind(rows, kinds, words, lambda row: _stated(row, row.bases, BASIS, words, words.words.basis))
    return joined(said, paragraph(words("cnil.bases.open"))) if said else said


def _by_kind(rows: Rows, kinds: Iterable[Kind], words: Told, statement: Callable[[Processed], Html]) -> Html:
    parts = []
    for kind in kinds:
        here = [(row, statement(row)) for row in rows if row.category == kind.category.name]
        lines = [words.pair(escaped(words.name(row.element)), text) for row, text in here if text]
        if lines:
            title = kind.category.text("title", words.words.language)
            parts += [paragraph(strong(escaped(title))), bullets(lines)]
    return joined(*parts)


def _stated(row: Processed, texts: Iterable[str], fact: str, words: Told, say: Callable[[str], str]) -> Html:
    """What is stated of one end, and whether more is to be completed; empty where nothing is."""
    stated = [prose(say(one)) for one in texts]
    more = [words("record.open")] if stated and fact in row.missing else []
    return Html("; ".join([*stated, *more]))


def purposes_of(rows: Rows, category: str, words: Told) -> Iterator[Html]:
    """Yield what a kind of data is processed for, in one line for the answer to 121."""
    here = [row for row in rows if row.category == category]
    texts = dict.fromkeys(one for row in here for one in row.purposes)
    if texts:
        more = [words("record.open")] if any(PURPOSE in row.missing for row in here) else []
        yield words.line("cnil.purposes", Html("; ".join([*map(prose, texts), *more])))
