"""What stands on boxes: names from anybody's files, fit to be drawn, and below them what is said of an element.

In: names and kinds of data. Out: printable text of a bounded length, broken into lines, in the reader's language in a
report and in pictures.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

LONGEST_LINE = 28
MOST_LINES = 3
_PARTS = re.compile(r"/?[^/]*")


def broken(name: str, width: int = LONGEST_LINE) -> tuple[str, ...]:
    """Return a name as a few lines, broken before a ``/`` where there is one.

    >>> broken("/perception/object_recognition/tracking/objects")
    ('/perception', '/object_recognition/tracking', '/objects')
    """
    text = shortened(name, width * MOST_LINES)
    lines = [""]
    for part in _PARTS.findall(text):
        if len(lines[-1]) + len(part) <= width:
            lines[-1] += part
            continue
        lines.extend(_cut(part, width))
    full = [line for line in lines if line] or [""]
    if len(full) > MOST_LINES:
        full = [*full[: MOST_LINES - 2], "…", full[-1]]
    return tuple(full)


def _cut(part: str, width: int) -> Iterator[str]:
    """Cut a part of a name that is longer than a line, after a ``_`` where there is one."""
    while len(part) > width:
        at = part.rfind("_", width // 2, width) + 1 or width
        yield part[:at]
        part = part[at:]
    yield part


def listed(names: Iterable[str], limit: int = 3, longest: int = 60, words: Words = IN_ENGLISH) -> str:
    """Return some names, and how many more there are.

    >>> listed(["a", "b", "c", "d", "e"])
    'a, b, c and 2 more'
    """
    every = [shortened(name, longest) for name in names]
    more = words("terminal.more", n=len(every) - limit) if len(every) > limit else ""
    return ", ".join(every[:limit]) + more


def sentences(texts: Sequence[str]) -> str:
    """Join sentences."""
    return " ".join(text if text.endswith((".", "…")) else f"{text}." for text in texts)


def quoted(text: str) -> str:
    r"""Return a quoted string of DOT that shows text as it is: no escape sequence, no entity.

    >>> quoted('a"b' + chr(92) + "N&amp;")
    '"a\\"b\\\\N&amp;amp;"'
    """
    return '"' + printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("&", "&amp;") + '"'


LONGEST = 60
TEXTS = {
    "source": "source of {names}",
    "leak": "leak of {names}",
    "storage-limitation": "kept without an end, or too long: {names}",
    "third-country-transfer": "outside the EEA, no basis stated: {names}",
    "unprotected-channel": "can be read on the network: {names}",
    "makes": "makes {to} of {names}",
    "pseudonymises": "pseudonymises {names}",
    "cleans": "ends {names}",
    "unreviewed": "not reviewed: {names}",
    "hidden": "pseudonymised {names}",
    "more": "{names} and {n} more",
}


@dataclass(frozen=True, slots=True)
class Phrases:
    """The words of a language.

    Attributes
    ----------
    texts
        With the keys and places of ``TEXTS``.
    titles
        Category -> what it is called; its name where there is none.
    words
        Of the title and the notes of a picture.
    """

    texts: Mapping[str, str] = field(default_factory=lambda: TEXTS)
    titles: Mapping[str, str] = field(default_factory=dict)
    words: Words = IN_ENGLISH

    @classmethod
    def of_report(cls, words: Words, titles: Mapping[str, str]) -> Phrases:
        """Return the words of a report, in its language."""
        return cls({name: plain(words.places(f"phrase.{name}")) for name in TEXTS}, titles, words)

    def of(self, key: str, categories: Iterable[str], limit: int, **suffix: str) -> str:
        """Return what is said of some categories."""
        return self.texts[key].format(names=self.listed(categories, limit), **suffix)

    def listed(self, categories: Iterable[str], limit: int) -> str:
        """Return what some categories are called, and how many more there are.

        >>> Phrases().listed(["Video", "Voice", "Location"], 2)
        'Video, Voice and 1 more'
        """
        every = [self.title(category) for category in categories]
        names = ", ".join(every[:limit])
        return self.texts["more"].format(names=names, n=len(every) - limit) if len(every) > limit else names

    def title(self, category: str) -> str:
        """Return what a category is called."""
        return shortened(self.titles.get(category, category), LONGEST)
