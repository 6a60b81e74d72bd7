"""The report as Markdown, for wikis and pull requests: what the HTML page tells, without its pictures and search.

In: an ``Outline``. Out: CommonMark with tables. Every value that the template writes goes through ``escaped``, so that
no name can be a link, a heading or HTML.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from rosprivacy.report.catalogs.words import NARROW, WIDE
from rosprivacy.report.page.outline import PARAGRAPHS
from rosprivacy.report.page.spaced_templates import TEMPLATES, CompiledTemplates, SpacedTemplates, alike

if TYPE_CHECKING:
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.outline import Outline

_SPECIAL = re.compile(r"([\\`*_{}\[\]#+!|~$@]|(?<=:)//|(?<=www)\.)", re.IGNORECASE)
_HTML = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_BREAKS = re.compile(rf"[^\S{WIDE}{NARROW}]+")  # what is no space that keeps to its word
_LEADING = re.compile(r"^(\s*)(-|=)|^(\s*\d+)([.)])")  # of a number, the sign after it: before a digit no \ escapes


def markdown(report: Outline) -> str:
    """Return the text. Complexity: O(size of the outline)."""
    return rendered("report.md.j2", report.words, r=report, paragraphs=PARAGRAPHS)


def rendered(template: str, words: Words, **values: Any) -> str:
    """Return what a template makes of words and values, with one empty line between blocks."""
    text = _environment(words.language).get_template(template).render(t=words, **values)
    return re.sub(r"\n{3,}", "\n\n", text).strip() + "\n"


def escaped(value: Any) -> str:
    r"""Return a value as text that Markdown takes as it is, on one line.

    >>> print(escaped("<b>[x](y)|`"))
    &lt;b&gt;\[x\](y)\|\`
    >>> print(escaped("https://example.org"), escaped("- a"), escaped("@someone"))
    https:\//example.org \- a \@someone
    >>> print(escaped("2.079 channels"), escaped("1) a"))
    2\.079 channels 1\) a
    """
    if isinstance(value, Markup):
        return str(value)
    line = _BREAKS.sub(" ", str(value)).strip()
    line = _SPECIAL.sub(r"\\\1", "".join(_HTML.get(c, c) for c in line))
    return _LEADING.sub(r"\1\3\\\2\4", line)


def code(value: str) -> Markup:
    r"""Return a name as code: the fence is longer than any in the name, a bar is escaped as tables want it.

    >>> str(code("/a`b|c"))
    '``/a`b\\|c``'
    """
    line = " ".join(value.split()) or "–"
    fence = "`" * (max((len(run) for run in re.findall("`+", line)), default=0) + 1)
    space = " " if line.startswith("`") or line.endswith("`") else ""
    return Markup(f"{fence}{space}{line.replace('|', chr(92) + '|')}{space}{fence}")  # noqa: S704 - in a fence


@cache
def _environment(language: str) -> Environment:
    environment = Environment(
        loader=SpacedTemplates(language),
        bytecode_cache=CompiledTemplates(TEMPLATES, f"md-{language}"),
        autoescape=False,  # noqa: S701 - it is not HTML; ``finalize`` escapes every value for Markdown
        finalize=escaped,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["code"] = code
    environment.filters["alike"] = alike
    return environment
