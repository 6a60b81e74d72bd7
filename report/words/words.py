"""The words of a report in a language: sentences with places for names and numbers.

In: a key and values. Out: plain text; whoever writes a format escapes it. The tables are ``words_en.py``,
``words_de.py`` and ``words_fr.py``; a test holds that all have the same keys and places.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.durations import parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

DATE = 3  # parts of one
_ARTICLE = re.compile(r"(?P<article>\d+)(?:\((?P<paragraph>\d+)\))?(?:\((?P<point>[a-z])\))?")
PARTS = (
    "",
    "cnil_",
    "terminal_",
    "pictures_",
    "explorer_",
    "review_",
    "trials_",
    "cypher_",
    "doubts_",
)  # a module each


@cache
def table(language: str) -> Mapping[str, str]:
    """Return all words of a language; those of the others are not imported.

    >>> table("de")["thousands"]
    '.'
    """
    modules = (import_module(f"rosprivacy.report.words.words_{part}{language}") for part in PARTS)
    return {key: text for module in modules for key, text in module.WORDS.items()}


@dataclass(frozen=True, slots=True)
class Words:
    """One language."""

    language: str

    def __call__(self, key: str, **values: Any) -> str:
        """Return a sentence with its values in place; numbers as the language writes them."""
        said = {name: self.number(value) if isinstance(value, int) else value for name, value in values.items()}
        return table(self.language)[key].format(**said)

    def places(self, key: str) -> str:
        """Return a sentence with its places still open."""
        return table(self.language)[key]

    def number(self, number: int) -> str:
        """Return a number with its thousands apart.

        >>> Words("en").number(12345), Words("de").number(12345)
        ('12,345', '12.345')
        """
        return f"{number:,}".replace(",", self("thousands"))

    def date(self, date: str) -> str:
        """Return a date, ``YYYY-MM-DD``, as the language writes it; anything else as it is.

        >>> Words("de").date("2026-04-30")
        '30.04.2026'
        """
        parts = date.split("-")
        return self("date", **dict(zip(("year", "month", "day"), parts, strict=True))) if len(parts) == DATE else date

    def moment(self, time: str) -> str:
        """Return a time, ``YYYY-MM-DDThh:mm:ssZ``, as the language writes it; anything else as it is.

        >>> Words("de").moment("2026-04-30T10:00:00Z"), Words("fr").moment("?")
        ('30.04.2026, 10:00:00 Uhr UTC', '?')
        """
        day, utc, hours = time.partition("T")
        whole = utc and hours.endswith("Z") and day.count("-") == DATE - 1
        return self("moment", date=self.date(day), time=hours.removesuffix("Z")) if whole else time

    def duration(self, text: str) -> str:
        """Return an ISO 8601 duration in words; what is none as it is.

        >>> Words("en").duration("P30D"), Words("de").duration("P1Y6M"), Words("en").duration("PT12H")
        ('30 days', '1 Jahr, 6 Monate', '12 hours')
        """
        return self.row(self.count(number, unit) for unit, number in parts(text)) or text

    def basis(self, article: str) -> str:
        """Return an Article of the GDPR, written as in ``6(1)(f)``, as the language cites it; what is none as it is.

        >>> Words("en").basis("6(1)(f)"), Words("de").basis("6(1)(f)"), Words("fr").basis("9(2)(h)")
        ('6(1)(f)', 'Art. 6 Abs. 1 Buchst. f DSGVO', 'art. 9, par. 2, point h), du RGPD')
        """
        cited = _ARTICLE.fullmatch(article)
        if not cited:
            return article
        places = {name: part for name, part in cited.groupdict().items() if part}
        return self(f"cite.{list(places)[-1]}", **places)

    def count(self, number: int, thing: str, **values: Any) -> str:
        """Return how many of a thing there are; its key ends in ``.one`` or ``.many``. In French, none is as one.

        >>> Words("en").count(1, "robot"), Words("de").count(2, "robot"), Words("fr").count(0, "robot")
        ('1 robot', '2 Roboter', '0 robot')
        """
        one = number == 1 or (number == 0 and self.language == "fr")
        return self(f"{thing}.{'one' if one else 'many'}", n=number, **values)

    def pair(self, what: str, said: str) -> str:
        """Return what something is, after its name.

        >>> Words("en").pair("name", "value")
        'name: value'
        """
        return self("pair", what=what, said=said)

    def row(self, texts: Iterable[str]) -> str:
        """Return texts in a row."""
        return ", ".join(texts)

    def first(self, texts: Sequence[str], most: int) -> tuple[str, ...]:
        """Return the first of some texts, and how many more there are.

        >>> Words("en").first(["/a", "/b", "/c"], 2), Words("en").first(["/a", "/b"], 2)
        (('/a', '/b', 'and 1 more'), ('/a', '/b'))
        """
        return (*texts[:most], *([self("more", n=len(texts) - most)] if len(texts) > most else ()))

    def known(self, key: str, otherwise: str) -> str:
        """Return the word for a value of the contract, or the value itself if there is none yet."""
        return table(self.language).get(key, otherwise)

    def kind(self, element: Mapping[str, Any]) -> str:
        """Return what an element is.

        >>> Words("en").kind({"robot": "", "kind": "service", "name": "/add", "leg": "request"})
        'service, request'
        """
        parts = [self.known(f"kind.{element['kind']}", element["kind"])]
        parts += [self(f"leg.{element['leg']}")] if element.get("leg") else []
        parts += [self("wildcard")] if element.get("pattern") else []
        return self.row(parts)


IN_ENGLISH = Words("en")
