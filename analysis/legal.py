"""What the law says of categories, closed over the hierarchy; and the legal bases that an acceptance states or lacks.

In: categories with what the ontology states of each. Out: the same with what follows for narrower and broader ones. In:
bases, the kinds of findings and categories that are accepted. Out: ``Gap``s, a flag for a person. None of it is a
verdict on a system: a provision is one that a person has to look at, and whether a stated basis fits is for people to
judge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import (
    ARTICLE_9,
    ARTICLE_9_VERDICTS,
    ARTICLE_10,
    MAY_REVEAL,
    SPECIAL,
    THIRD_COUNTRY,
    is_article_9,
)
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Category, Element, Legal


class LegalQuestion(StrEnum):
    """What is asked of a row of the register before it is accepted: a code, under which the answer is logged."""

    ASSESSMENT = "assessment"  # of a transfer under Article 46 or 47: where is it?
    OCCASIONAL = "occasional"  # Article 49
    PROCESSOR = "processor"  # Article 28: where is the contract?
    JOINT = "joint"  # Article 26
    UNENCRYPTED = "unencrypted"  # Article 32
    CRIMINAL = "criminal"  # Article 10
    SPECIAL = "special"  # Article 9(2)
    SECRECY = "secrecy"  # Article 9(3), where 9(2)(h) is stated


PROHIBITED = "AI Act Art. 5"  # on prohibited practices; a paragraph of it follows in brackets
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
    special = any(legal.verdict in SPECIAL for legal in category.law)
    return special or any(map(on_prohibited_practices, category.look_at))


def on_prohibited_practices(provision: str) -> bool:
    """Return whether the name of a provision is that of Article 5 of the AI Act, or of a part of it.

    >>> [on_prohibited_practices(name) for name in ("AI Act Art. 5", "AI Act Art. 5(1)(f)", "AI Act Art. 50(3)")]
    [True, True, False]
    """
    article, _, _ = provision.partition("(")
    return article == PROHIBITED


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


CHAPTER_V = ("45", "46", "47", "49")
GROUPS = (("6",), ("9",), ("10",), CHAPTER_V)
TRANSFER_OF = {  # article -> the basis of a transfer as labels call it (``non_ros.TRANSFERS``)
    "45": "adequacy",
    "46(2)(a)": "public-instrument",
    "46(2)(b)": "binding-corporate-rules",
    "47": "binding-corporate-rules",
    "46(2)(c)": "standard-clauses",
    "46(2)(d)": "standard-clauses",
    "46(2)(e)": "code-of-conduct",
    "46(2)(f)": "certification",
    "46(3)": "authorised-clauses",
    "49": "derogation",
}
Verdicts = tuple[tuple[str, str], ...]  # (provision, verdict)


class Lack(StrEnum):
    """What is missing; the value is the sentence."""

    ARTICLE_6 = "states no legal basis under Article 6(1)"
    ARTICLE_9 = "states no ground under Article 9(2), and {category} can fall under {provision}"
    REVEALS = "states no ground under Article 9(2), and {category} may reveal what is named in {provision}"
    SECRECY = "rests on Article 9(2)(h) and does not state that 9(3) is met, professional secrecy"
    ARTICLE_10 = "names no law that authorises data of Article 10 (10), and {category} can be such data"
    OCCASIONAL = "rests on a derogation (Article 49) for a transfer out of the EEA: is it occasional?"
    NO_END = "states no day on which it ends: nobody will be asked to look again"
    CHAPTER_V = (
        "is about a transfer out of the EEA and states no basis of chapter V (45, 46, 47 or 49), which Article 6 is not"
    )


UNFOUNDED = (Lack.ARTICLE_9, Lack.ARTICLE_10, Lack.CHAPTER_V, Lack.NO_END)  # a person is asked twice about these


class Gap(NamedTuple):
    """One thing that an acceptance lacks."""

    lack: Lack
    category: str = ""
    provision: str = ""

    def __str__(self) -> str:
        """Return the sentence, without its subject."""
        return self.lack.format(category=self.category, provision=self.provision)


def gaps(stated: Sequence[str], accepted: Iterable[tuple[str, str]], law: Mapping[str, Verdicts]) -> Iterator[Gap]:
    """Yield what an acceptance lacks.

    Parameters
    ----------
    stated
        As ``ingest/decisions`` reads them: ``6(1)(f)``, ``9(2)(h)``, ``46(2)(c)``, …
    accepted
        (kind, category) of the findings.
    law
        Category -> what can apply to data of it.

    Notes
    -----
    Article 6(1) always; 9(2) where data fall or may fall under Article 9(1), and 9(3) beside 9(2)(h); the law that
    authorises data of Article 10; a basis of chapter V (Article 44) for a transfer, which Article 6 does not cure. A
    transfer on Article 49 alone is asked about: that is for specific situations (recital 111), and robots that send
    all the time are none.

    Examples
    --------
    >>> law = {"FaceTemplate": (("GDPR Art. 9(1)", "conditional"),)}
    >>> [gap] = gaps(["6(1)(f)"], [("disclosure", "FaceTemplate")], law)
    >>> str(gap)
    'states no ground under Article 9(2), and FaceTemplate can fall under GDPR Art. 9(1)'
    """
    held = list(accepted)
    kinds = sorted({category for _, category in held})
    if not _matches(stated, "6(1)"):
        yield Gap(Lack.ARTICLE_6)
    if not _matches(stated, "9(2)"):
        for category in kinds:
            yield from _article9(category, law.get(category, ()))
    if "9(2)(h)" in stated and "9(3)" not in stated:
        yield Gap(Lack.SECRECY)
    if "10" not in stated:
        yield from (Gap(Lack.ARTICLE_10, category) for category in kinds if _article10(law.get(category, ())))
    if any(kind == THIRD_COUNTRY for kind, _ in held):
        if not _matches(stated, *CHAPTER_V):
            yield Gap(Lack.CHAPTER_V)
        elif not _matches(stated, *(article for article in CHAPTER_V if article != "49")):
            yield Gap(Lack.OCCASIONAL)


def acceptance_gaps(
    stated: Sequence[str], expires: str, accepted: Iterable[tuple[str, str]], law: Mapping[str, Verdicts]
) -> Iterator[Gap]:
    """Yield what an acceptance lacks: a legal basis, see ``gaps``, and an end.

    >>> [gap] = acceptance_gaps(["6(1)(f)"], "", [("disclosure", "Video")], {})
    >>> gap.lack.name
    'NO_END'
    """
    yield from gaps(stated, accepted, law)
    if not expires:
        yield Gap(Lack.NO_END)


def transfer_of(basis: str) -> str:
    """Return the basis of a transfer that an article is, as labels call it; empty if it is none of chapter V.

    >>> transfer_of("46(2)(c)"), transfer_of("49(1)(a)"), transfer_of("6(1)(f)")
    ('standard-clauses', 'derogation', '')
    """
    return TRANSFER_OF.get(basis) or TRANSFER_OF.get(basis.partition("(")[0], "")


def group_of(basis: str) -> tuple[str, ...]:
    """Return the articles that are looked up together with a legal basis: one of ``GROUPS``.

    >>> group_of("9(3)"), group_of("46(2)(c)") == CHAPTER_V
    (('9',), True)
    """
    return next((group for group in GROUPS if _matches([basis], *group)), ())


def _matches(stated: Sequence[str], *articles: str) -> bool:
    return any(basis == article or basis.startswith(f"{article}(") for basis in stated for article in articles)


def _article9(category: str, law: Verdicts) -> Iterator[Gap]:
    """At most one: the provision under which it can fall itself, or else one of which it may reveal something."""
    special = [(name, verdict) for name, verdict in law if is_article_9(name)]
    for verdicts, lack in ((SPECIAL, Lack.ARTICLE_9), ((MAY_REVEAL,), Lack.REVEALS)):
        provision = next((name for name, verdict in special if verdict in verdicts), "")
        if provision:
            yield Gap(lack, category, provision)
            return


def _article10(law: Verdicts) -> bool:
    return any(name == ARTICLE_10 and verdict in SPECIAL for name, verdict in law)
