"""The legal bases that an acceptance states, and those that are missing: a flag for a person, no verdict.

In: a decision, the findings that it accepts, what the law says of their categories. Out: sentences. Whether a stated
basis fits is for people to judge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.legal import MAY_REVEAL, SPECIAL
from rosprivacy.analysis.model import THIRD_COUNTRY

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Legal

CHAPTER_V = ("45", "46", "47", "49")
ARTICLE_10 = "GDPR Art. 10"


def missing_bases(
    stated: Sequence[str], findings: Iterable[Finding], law: Mapping[str, Sequence[Legal]]
) -> Iterator[str]:
    """Yield what an acceptance lacks.

    Parameters
    ----------
    stated
        As ``ingest/decisions`` reads them: ``6(1)(f)``, ``9(2)(h)``, ``46(2)(c)``, …
    law
        Category -> what can apply to data of it.

    Notes
    -----
    Article 6(1) always; 9(2) where data fall or may fall under Article 9(1), and 9(3) beside 9(2)(h); the law that
    authorises data of Article 10; a basis of chapter V (Article 44) for a transfer, which Article 6 does not cure.

    Examples
    --------
    >>> from rosprivacy.analysis.example import LAW, factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> list(missing_bases(["6(1)(f)"], analyse(*factory()).findings, {"FaceTemplate": [LAW]}))
    ['states no ground under Article 9(2), and FaceTemplate can fall under GDPR Art. 9(1)']
    """
    held = list(findings)
    kinds = sorted({finding.category for finding in held})
    if not _any(stated, "6(1)"):
        yield "states no legal basis under Article 6(1)"
    if not _any(stated, "9(2)"):
        for category in kinds:
            yield from _article9(category, law.get(category, ()))
    if "9(2)(h)" in stated and "9(3)" not in stated:
        yield "rests on Article 9(2)(h) and does not state that 9(3) is met, professional secrecy"
    if "10" not in stated:
        for category in kinds:
            yield from _article10(category, law.get(category, ()))
    if any(finding.kind == THIRD_COUNTRY for finding in held) and not _any(stated, *CHAPTER_V):
        bases = f"{', '.join(CHAPTER_V[:-1])} or {CHAPTER_V[-1]}"
        yield f"is about a transfer out of the EEA and states no basis of chapter V ({bases}), which Article 6 is not"


def _any(stated: Sequence[str], *articles: str) -> bool:
    return any(basis == article or basis.startswith(f"{article}(") for basis in stated for article in articles)


def _article9(category: str, law: Sequence[Legal]) -> Iterator[str]:
    """At most one: the provision under which it can fall itself, or else one of which it may reveal something."""
    special = [legal for legal in law if legal.special]
    for verdicts, can in ((SPECIAL, "can fall under"), ((MAY_REVEAL,), "may reveal what is named in")):
        provision = next((legal.name for legal in special if legal.verdict in verdicts), "")
        if provision:
            yield f"states no ground under Article 9(2), and {category} {can} {provision}"
            return


def _article10(category: str, law: Sequence[Legal]) -> Iterator[str]:
    if any(legal.name == ARTICLE_10 and legal.verdict in SPECIAL for legal in law):
        yield f"names no law that authorises data of Article 10 (10), and {category} can be such data"
