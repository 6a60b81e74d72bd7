"""The report as one HTML file that asks nobody for anything: style, script and pictures are in it.

In: an ``Outline`` and pictures. Out: HTML. Every value is escaped by jinja2; a Content Security Policy allows the one
style, the one script (each by its hash) and pictures that are in the file, so that no name from a policy can load or
run anything. Pictures stand as images: nothing inside an image can run, whatever drew it.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from rosprivacy.report.outline import PARAGRAPHS, SIGNED

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.outline import Outline
    from rosprivacy.report.words import Words

PICTURES = 5 * 2**20  # bytes of all pictures together, so that the file stays one that can be mailed


class _Escaped:
    """The words of a language as HTML: sentences and values are escaped, what is HTML already stays so."""

    def __init__(self, words: Words) -> None:
        self._words = words
        self.language = words.language
        self.number, self.count, self.row = words.number, words.count, words.row

    def __call__(self, key: str, **values: Any) -> Markup:
        return escape(self._words(key, **values))


def html(report: Outline, pictures: Mapping[str, str] | None = None) -> str:
    """Return the page.

    Parameters
    ----------
    pictures
        Id of a finding -> SVG. When they become too many for a file that can be mailed, the rest is left out, and the
        page says so.

    Complexity: O(size of the outline).
    """
    environment, css, js = _environment()
    embedded = _embedded(report, pictures or {})
    page = environment.get_template("report.html.j2").render(
        r=report,
        t=_Escaped(report.words),
        policy=f"default-src 'none'; style-src '{_hash(css)}'; script-src '{_hash(js)}'; img-src data:; "
        "base-uri 'none'; form-action 'none'",
        css=Markup(css),  # noqa: S704 - our own file
        js=Markup(js),  # noqa: S704 - our own file
        pictures=embedded,
        left_out=any(way.id not in embedded for way in report.ways if way.id in (pictures or {})),
        paragraphs=PARAGRAPHS,
        signed=SIGNED,
    )
    return page.strip() + "\n"


@cache
def _environment() -> tuple[Environment, str, str]:
    """The templates, the style, the script."""
    loader = PackageLoader("rosprivacy.report")
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    css, js = (loader.get_source(environment, name)[0] for name in ("report.css", "report.js"))
    return environment, css, js


def _hash(text: str) -> str:
    """The name of a text in a Content Security Policy."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"


def _embedded(report: Outline, pictures: Mapping[str, str]) -> dict[str, str]:
    """The pictures as addresses that hold them, as many as fit, in the order of the entries."""
    found: dict[str, str] = {}
    room = PICTURES
    for way in report.ways:
        if way.id not in pictures:
            continue
        address = f"data:image/svg+xml;base64,{base64.b64encode(pictures[way.id].encode()).decode()}"
        room -= len(address)
        if room < 0:
            break
        found[way.id] = address
    return found
