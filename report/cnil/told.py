"""What answers are told with: the words of a language as HTML, names of elements and kinds of data, lines and lists.

In: words, elements, names of categories; any text. Out: ``Html``, escaped first, put together after, which only the
functions here make, so that a type checker finds what was not escaped; or plain text for the lists of the tool, which
it shows in one view as text and in another as HTML. Names come from anybody's files.
"""

from __future__ import annotations

import html
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, NewType

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import one_line
from rosprivacy.report.catalogs.words import plain, spaced

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.model import Category, Element
    from rosprivacy.report.catalogs.words import Words

Html = NewType("Html", str)
_LOOK_ALIKES = str.maketrans({"<": "‹", ">": "›", "&": "＆", '"': "”", "'": "’"})


def escaped(text: str) -> Html:
    r"""Return text as HTML: one line, nothing unprintable, nothing endless.

    >>> escaped("<b>" + chr(10) + "'")
    '&lt;b&gt;\\n&#x27;'
    """
    return Html(html.escape(shown(text)))


def prose(text: str) -> Html:
    """Return a longer text as HTML, in one line."""
    return Html(html.escape(one_line(text)))


def harmless(text: str) -> str:
    """Return text that says the same whether it is taken as HTML or not: what HTML reads is made a look-alike.

    >>> harmless("<b>")
    '‹b›'
    """
    return one_line(text).translate(_LOOK_ALIKES)


def joined(*parts: Html) -> Html:
    """Put pieces one after another."""
    return Html("".join(parts))


def strong(part: Html) -> Html:
    """Return a piece that stands out."""
    return Html(f"<strong>{part}</strong>")


def paragraph(*parts: Html) -> Html:
    """Return pieces as a paragraph."""
    return Html(f"<p>{''.join(parts)}</p>")


def bullets(parts: Iterable[Html]) -> Html:
    """Return pieces as a list; nothing where there are none."""
    items = "".join(f"<li>{part}</li>" for part in parts)
    return Html(f"<ul>{items}</ul>" if items else "")


NAMES = 30  # named in a row


@dataclass(frozen=True, slots=True)
class Told:
    """The words of a language for this file."""

    words: Words
    categories: Mapping[str, Category]

    def __call__(self, key: str, **values: Html | int) -> Html:
        """Return a sentence as HTML; the words hold nothing that HTML reads."""
        return Html(self.words(key, **values))

    def bare(self, key: str, **values: str | int) -> str:
        """Return a sentence that says the same whether it is taken as HTML or not."""
        said = {place: harmless(shown(value)) if isinstance(value, str) else value for place, value in values.items()}
        return harmless(plain(self.words(key, **said)))

    def count(self, number: int, noun: str) -> Html:
        """Return how many of a thing there are."""
        return Html(self.words.count(number, noun))

    def line(self, key: str, text: Html) -> Html:
        """Return one line of a list: what it is about, and what is said of it."""
        return self.pair(self(key), text)

    def pair(self, name: Html, text: Html) -> Html:
        """Return what something is, after its name."""
        return Html(self.words.pair(name, text))

    def lines(self, key: str, elements: Collection[Element]) -> list[Html]:
        """Return one line of names, none without them."""
        return [self.line(key, self.names(elements))] if elements else []

    def name(self, element: Element) -> str:
        """Return what an element is called, after its kind where it is no node."""
        kind = "" if element.is_node else f"{self.kind(element.kind)} "
        return f"{kind}{element.full_name}"

    def kind(self, kind: str) -> str:
        """Return what a kind of elements is called; English keeps the word of label files."""
        return kind if self.words.language == "en" else self.words.of_value(f"kind.{kind}", kind)

    def names(self, elements: Collection[Element]) -> Html:
        """Return elements in a row."""
        return self.names_shown([self.name(element) for element in elements]) if elements else self("none")

    def names_shown(self, names: Collection[str]) -> Html:
        """Return names in a row, and how many more there are than the most that are named."""
        return self.row([escaped(name) for name in islice(names, NAMES)], len(names))

    def row(self, parts: list[Html], number: int) -> Html:
        """Return pieces in a row, and how many it lacks."""
        row, more = ", ".join(parts), number - len(parts)
        return Html(f"{row} {self('more', n=more)}" if more > 0 else row)

    def rows(self, rows: list[Html], number: int) -> Html:
        """Return a list, and how many rows it lacks."""
        return bullets([*rows, self("more", n=number - len(rows))] if number > len(rows) else rows)

    def data(self, category: str, *, pseudonymised: bool = False) -> str:
        """Return what a kind of data is called; English keeps its name in label files."""
        known = self.categories.get(category)
        language = self.words.language
        title = known.text("title", language) if known and language != "en" else category
        return self.words("cnil.hidden", data=title) if pseudonymised else title

    def prose(self, text: str) -> Html:
        """Return a text of the ontology in the reader's language."""
        return Html(spaced(prose(text), self.words.language))
