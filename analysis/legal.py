"""What the law says of categories, closed over the hierarchy; where on a path data become a special category.

In: categories with what the ontology states of each. Out: the same with what follows for narrower and broader ones. It
gives no verdict on a system: a provision is one that a person has to look at.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import ARTICLE_9, ARTICLE_9_VERDICTS, MAY_REVEAL, SPECIAL

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Category, Element, Legal

PROHIBITED = "AI Act Art. 5"  # the names of the provisions on prohibited practices begin with it
_STRENGTH = {verdict: number for number, verdict in enumerate(ARTICLE_9_VERDICTS)}


def close(categories: Mapping[str, Category], hierarchy: Hierarchy) -> dict[str, Category]:
    """Return the categories with all that follows from what is stated of them.

    A category of which nothing is stated takes what is stated of its nearest broader ones. A category with a narrower
    one under a provision may reveal it, since data of it may be of the narrower kind (rule S7): where something
    stronger is not stated of it already.

    Complexity: O(categories x depth x statements).

    >>> from rosprivacy.analysis.example import CATEGORIES
    >>> from rosprivacy.analysis.hierarchy import Hierarchy
    >>> closed = close(CATEGORIES, Hierarchy.of(CATEGORIES.values()))
    >>> {name: category.article9 for name, category in closed.items()}
    {'Biometric': 'may-reveal', 'FaceTemplate': 'conditional', 'Video': 'no'}
    """
    stated = {name: _inherited(category, categories, hierarchy) for name, category in categories.items()}
    narrower: dict[str, list[Category]] = {name: [] for name in categories}
    for name, category in stated.items():
        for above in hierarchy.broader(name):
            narrower[above].append(category)
    return {name: _with_narrower(category, narrower[name]) for name, category in stated.items()}


def _direct_provisions(category: Category) -> tuple[Legal, ...]:
    return tuple(legal for legal in category.law if legal.stated_of in ("", category.name))


def _says_something(category: Category) -> bool:
    return category.stated_of in ((), (category.name,)) and bool(_direct_provisions(category) or category.reason)


def _inherited(category: Category, categories: Mapping[str, Category], hierarchy: Hierarchy) -> Category:
    """The category with its own statements, or with those of the nearest broader ones that have some."""
    if _says_something(category):
        own = tuple(legal._replace(stated_of=category.name) for legal in _direct_provisions(category))
        return category._replace(law=own, stated_of=(category.name,))
    above = [categories[name] for name in hierarchy.broader(category.name) if _says_something(categories[name])]
    nearest = [up for up in above if not any(up.name in hierarchy.broader(other.name) for other in above)]
    law = {
        (legal.iri, legal.verdict, up.name): legal._replace(stated_of=up.name)
        for up in nearest
        for legal in _direct_provisions(up)
    }
    reasons = sorted({up.reason for up in nearest if up.reason})
    translations = category.translations
    if len(reasons) == 1:
        up = next(up for up in nearest if up.reason)
        translations = {
            language: {**texts, "reason": up.text("reason", language)} for language, texts in translations.items()
        }
    defined = category if category.gdpr else next((up for up in nearest if up.gdpr), category)
    if defined is not category:
        translations = {
            language: {**texts, "gdpr": defined.text("gdpr", language)} for language, texts in translations.items()
        }
    return category._replace(
        law=tuple(law[key] for key in sorted(law)),
        reason="; ".join(reasons),
        stated_of=tuple(up.name for up in nearest),
        gdpr=defined.gdpr,
        translations=translations,
    )


def _with_narrower(category: Category, narrower: Iterable[Category]) -> Category:
    """The category with what it may reveal because data of it may be of a narrower kind."""
    covered = {legal.name for legal in category.law}
    provisions: dict[str, list[tuple[Category, Legal]]] = {}
    for kind in sorted(narrower, key=lambda kind: kind.name):
        for legal in kind.law:
            if legal.name not in covered and not (legal.special and ARTICLE_9 in covered):
                provisions.setdefault(legal.name, []).append((kind, legal))
    more = [_may_reveal(kinds) for _, kinds in sorted(provisions.items())]
    law = tuple(sorted((*category.law, *more), key=lambda legal: (legal.name, legal.stated_of)))
    return category if law == category.law else category._replace(law=law)


def _may_reveal(kinds: list[tuple[Category, Legal]]) -> Legal:
    """What is said of narrower kinds, as said of the broad one: it holds if the data are of one of these."""
    legal = kinds[0][1]
    languages = {"en", *(language for kind, _ in kinds for language in kind.translations)}
    conditions = {
        language: ", ".join(dict.fromkeys(kind.text("title", language) for kind, _ in kinds)) for language in languages
    }
    translations = {
        language: {**legal.translations.get(language, {}), "condition": f"⊇ {conditions[language]}", "sources": ""}
        for language in sorted(languages - {"en"})
    }
    return legal._replace(
        verdict=MAY_REVEAL,
        condition=f"if the data are of a narrower kind: {conditions['en']}",
        stated_of=", ".join(dict.fromkeys(kind.name for kind, _ in kinds)),
        sources=(),
        translations=translations,
    )


def strongest_first(law: Iterable[Legal]) -> tuple[Legal, ...]:
    """Return provisions, what holds always first; the same said twice once.

    >>> from rosprivacy.analysis.example import LAW
    >>> [legal.verdict for legal in strongest_first([LAW._replace(verdict=MAY_REVEAL), LAW, LAW])]
    ['conditional', 'may-reveal']
    """
    distinct = {(legal.iri, legal.verdict, legal.condition): legal for legal in law}.values()
    return tuple(sorted(distinct, key=lambda legal: (_STRENGTH.get(legal.verdict, len(_STRENGTH)), legal.name)))


def recognises(category: Category) -> bool:
    """Return whether who makes such data recognises persons or judges them: that protects nobody, whatever it drops.

    It is so of special categories, of data of Article 10, and of what Article 5 of the AI Act speaks of.

    >>> from rosprivacy.analysis.example import CATEGORIES
    >>> recognises(CATEGORIES["FaceTemplate"]), recognises(CATEGORIES["Video"])
    (True, False)
    """
    return any(legal.verdict in SPECIAL for legal in category.law) or any(
        at.startswith(PROHIBITED) for at in category.look_at
    )


def turned_special(finding: Finding, categories: Mapping[str, Category]) -> Element | None:
    """Return the element of the witness that makes a special category of data that are none; None if nothing does.

    A face recogniser makes face templates, which can fall under Article 9(1), of video, which does not (recital 51).

    >>> from rosprivacy.analysis.example import CATEGORIES, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> faces, *_ = analyse(*factory()).findings
    >>> turned_special(faces, CATEGORIES).name
    '/face_id'
    """
    elements = [*(step.source for step in finding.steps), finding.leak]
    kinds = [*(step.category for step in finding.steps), finding.category]
    if len(set(kinds)) == 1:
        return None
    special = [categories[kind].article9 in SPECIAL for kind in kinds]
    changes = [i for i in range(1, len(kinds)) if special[i] and not special[i - 1]]
    return elements[changes[-1]] if changes and special[-1] else None
