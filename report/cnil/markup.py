"""Text for readers that take it as HTML: escaped first, put together after. Names come from anybody's files.

In: any text. Out: ``Html``, which only the functions here make, so that a type checker finds what was not escaped.
"""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, NewType

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import one_line

if TYPE_CHECKING:
    from collections.abc import Iterable

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
    return shown(text).translate(_LOOK_ALIKES)


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
