"""The words of outputs for people, in a language: sentences with places for names and numbers.

In: a key and values. Out: plain text; whoever writes a format escapes it. The catalogues ``en.json``, ``de.json`` and
``fr.json`` are in the style of i18next, which translators' tools read: one entry a line, sorted, plural forms as
``KEY_one`` and ``KEY_other``, places as ``{name}``. A test holds that all have the same keys and places.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from rosprivacy.analysis.durations import parts
from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import Reason

Thing = TypeVar("Thing")
DATE = 3  # parts of one
REST = 2  # things that are named although there is no room: as short as how many they are
_ARTICLE = re.compile(r"(?P<article>\d+)(?:\((?P<paragraph>\d+)\))?(?:\((?P<point>[a-z])\))?")
WIDE, NARROW = "\u00a0", "\u202f"  # as the Imprimerie nationale has them: before a colon and in quotes; before ; ? !
_FRENCH = ((re.compile(r" (?=[:»])|(?<=«) "), WIDE), (re.compile(r" (?=[;?!])"), NARROW))


@cache
def table(language: str) -> Mapping[str, str]:
    """Return all words of a language; those of the others are not read.

    >>> table("de")["thousands"]
    '.'
    """
    words: dict[str, str] = json.loads(Path(__file__).with_name(f"{language}.json").read_text("utf-8"))
    return words


def shown_of(number: int, limit: int) -> int:
    """Return how many of some things are named where there is room for ``limit``; one or two more are named, too.

    'and 1 more' is no shorter than a name, and leaves a reader without it.

    >>> shown_of(3, 3), shown_of(5, 3), shown_of(6, 3)
    (3, 5, 3)
    """
    return number if number <= limit + REST else limit


def first_of(things: Sequence[Thing], limit: int) -> tuple[tuple[Thing, ...], int]:
    """Return the first of some things, see ``shown_of``, and how many are left.

    >>> first_of(["/a", "/b", "/c", "/d"], 1)
    (('/a',), 3)
    """
    shown = shown_of(len(things), limit)
    return tuple(things[:shown]), len(things) - shown


@dataclass(frozen=True, slots=True)
class Words:
    """One language."""

    language: str

    def __call__(self, key: str, **values: Any) -> str:
        """Return a sentence with its values in place; numbers as the language writes them."""
        written = {name: self.number(value) if isinstance(value, int) else value for name, value in values.items()}
        return table(self.language)[key].format(**written)

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

    def count(self, number: int, noun: str, **values: Any) -> str:
        """Return how many of a thing there are; its key ends in ``_one`` or ``_other``. In French, none is as one.

        >>> Words("en").count(1, "robot"), Words("de").count(2, "robot"), Words("fr").count(0, "robot")
        ('1 robot', '2 Roboter', '0 robot')
        """
        one = number == 1 or (number == 0 and self.language == "fr")
        return self(f"{noun}_{'one' if one else 'other'}", n=number, **values)

    def pair(self, name: str, value: str) -> str:
        """Return what something is, after its name.

        >>> Words("en").pair("name", "value")
        'name: value'
        """
        return self("pair", name=name, value=value)

    def row(self, texts: Iterable[str]) -> str:
        """Return texts in a row."""
        return ", ".join(texts)

    def first(self, texts: Sequence[str], limit: int) -> tuple[str, ...]:
        """Return the first of some texts, see ``shown_of``, and how many more there are.

        >>> Words("en").first(["/a", "/b", "/c", "/d"], 1), Words("en").first(["/a", "/b", "/c"], 1)
        (('/a', 'and 3 more'), ('/a', '/b', '/c'))
        """
        shown, left = first_of(texts, limit)
        return (*shown, *([self("more", n=left)] if left else ()))

    def of_value(self, key: str, otherwise: str) -> str:
        """Return the word for a value of the contract, or the value itself if there is none yet."""
        return table(self.language).get(key, otherwise)

    def kind(self, element: Mapping[str, Any]) -> str:
        """Return what an element is.

        >>> Words("en").kind({"robot": "", "kind": "service", "name": "/add", "leg": "request"})
        'service, request'
        """
        parts = [self.of_value(f"kind.{element['kind']}", element["kind"])]
        parts += [self(f"leg.{element['leg']}")] if element.get("leg") else []
        parts += [self("wildcard")] if element.get("pattern") else []
        return self.row(parts)


IN_ENGLISH = Words("en")


def finding_reason(finding: Mapping[str, Any], words: Words, title: Callable[[str], str]) -> str:
    """Return why something is a finding; empty for a disclosure. Documents of earlier versions say it in English only.

    Parameters
    ----------
    title
        Category -> what it is called.
    """
    because = finding.get("because")
    return _reason(because["key"], because["values"], words, title) if because else printable(finding.get("reason", ""))


def brief_reason(finding: Mapping[str, Any], words: Words, title: Callable[[str], str]) -> str:
    """Return the same in few words, for a line that asks what is to be decided; some reasons are short as they are.

    >>> values = {"kept": "P60D", "limit": "P14D", "category": "Video"}
    >>> brief_reason({"because": {"key": "kept-longer", "values": values}}, IN_ENGLISH, str)
    'kept for 60 days, the limit is 14 days'
    """
    key = f"ask.reason.{finding['because']['key']}" if finding.get("because") else ""
    if key not in table(words.language):
        return finding_reason(finding, words, title)
    return words(key, **_written(finding["because"]["values"], words, title))


def reason_text(reason: Reason, words: Words, title: Callable[[str], str]) -> str:
    """Return a reason in words."""
    return _reason(reason.key, dict(reason.values), words, title)


def _reason(key: str, values: Mapping[str, str], words: Words, title: Callable[[str], str]) -> str:
    return words(f"reason.{key}", **_written(values, words, title))


def _written(values: Mapping[str, str], words: Words, title: Callable[[str], str]) -> dict[str, str]:
    """The values of a reason as the language writes them."""
    writers = {
        "kept": words.duration,
        "backups": words.duration,
        "limit": words.duration,
        "until": words.date,
        "since": words.date,
        "ended": words.date,
        "category": title,
    }
    written = {place: writers.get(place, str)(printable(value)) for place, value in values.items()}
    if "recipients" in written:  # whom a decision covers: what the list of countries says, in English
        otherwise = words.of_value("adequacy.other", written["recipients"])
        written["recipients"] = words.of_value(f"adequacy.{written['country']}", otherwise)
    return written


def spaced(text: str, language: str) -> str:
    """Return a text, typed with plain spaces, with those of its language: in French, marks keep to their word.

    >>> spaced("Source : « oui » ; non ?", "fr").encode("ascii", "namereplace").count(b"NO-BREAK SPACE")
    5
    >>> spaced("Source : yes", "en")
    'Source : yes'
    """
    for mark, space in _FRENCH if language == "fr" else ():
        text = mark.sub(space, text)
    return text


def plain(text: str) -> str:
    """Return a text with plain spaces, for a picture: it breaks its lines itself, and shows other spaces escaped."""
    return text.replace(WIDE, " ").replace(NARROW, " ")
