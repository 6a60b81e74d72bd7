"""The report as one HTML file that asks nobody for anything: all is in it.

In: an ``Outline`` and its ``Figures``. Out: HTML. Every value is escaped by jinja2; a Content Security Policy allows
the one style and the one script, each by its hash, so that no name from a policy can load or run anything. Pictures
hold nothing but shapes and text.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup, escape

from rosprivacy.report.page.figures import Figures, page_legend
from rosprivacy.report.page.outline import PARAGRAPHS
from rosprivacy.report.page.spaced_templates import TEMPLATES, CompiledTemplates, SpacedTemplates, alike
from rosprivacy.report.pictures.looks import INK

if TYPE_CHECKING:
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.outline import Outline


class _Escaped:
    """The words of a language as HTML: sentences and values are escaped, what is HTML already stays so."""

    def __init__(self, words: Words) -> None:
        self._words = words
        self.language = words.language
        self.number, self.count, self.row = words.number, words.count, words.row

    def __call__(self, key: str, **values: Any) -> Markup:
        return escape(self._words(key, **values))


def html(report: Outline, drawn: Figures | None = None) -> str:
    """Return the page.

    Parameters
    ----------
    drawn
        The pictures; the page says which are missing, and how to get them. None for a page that is to have none.

    Complexity: O(size of the outline and the pictures).
    """
    environment, css, js = environment_of(report.words.language)
    page = environment.get_template("report.html.j2").render(
        r=report,
        t=in_html(report.words),
        policy=f"default-src 'none'; style-src '{hashed(css)}'; script-src '{hashed(js)}'; img-src data:; "
        "base-uri 'none'; form-action 'none'",
        css=Markup(css),  # noqa: S704 - our own file
        js=Markup(js),  # noqa: S704 - our own file
        drawn=drawn,
        undrawn=sum(entry.detailed and entry.id not in drawn.of for entry in report.entries) if drawn else 0,
        ink=INK,
        looks=page_legend(report.words, drawn.looks) if drawn else [],
        paragraphs=PARAGRAPHS,
    )
    return page.strip() + "\n"


def in_html(words: Words) -> _Escaped:
    """Return the words of a language as HTML."""
    return _Escaped(words)


@cache
def environment_of(language: str) -> tuple[Environment, str, str]:
    """Return the templates of a language, the style, the script."""
    loader = SpacedTemplates(language)
    environment = Environment(
        loader=loader,
        bytecode_cache=CompiledTemplates(TEMPLATES, language),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["alike"] = alike
    css, js = (loader.get_source(environment, name)[0] for name in ("report.css", "report.js"))
    return environment, css, js


def hashed(text: str) -> str:
    """Return the name of a text in a Content Security Policy."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}"
