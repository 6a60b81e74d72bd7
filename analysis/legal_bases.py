"""The legal bases that an acceptance states, and those that are missing: a flag for a person, no verdict.

In: bases, the kinds of findings and categories that are accepted, what the law says of these. Out: ``Gap``s. Whether a
stated basis fits is for people to judge.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import ARTICLE_10, MAY_REVEAL, SPECIAL, THIRD_COUNTRY, is_article_9

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

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
    CHAPTER_V = (
        "is about a transfer out of the EEA and states no basis of chapter V (45, 46, 47 or 49), which Article 6 is not"
    )


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
