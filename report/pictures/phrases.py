"""What stands on boxes below their names: in its language in a report and in pictures."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.text import shortened
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

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
