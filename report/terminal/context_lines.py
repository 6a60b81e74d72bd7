"""What data may reveal where they are brought in, and law that is pointed at -> lines for a terminal; no verdict.

In: the JSON document and words. Out: lines with their style, one for each context, provision and kind of data.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import blanked
from rosprivacy.report.catalogs.words import spaced
from rosprivacy.report.looked_at import looked_at
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def context_lines(kind: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], words: Words) -> Iterator[Line]:
    """Yield what data of a kind may reveal, once for each context and provision, with the sources there."""
    of_source: dict[tuple[str, str, str], dict[str, None]] = {}
    for finding in findings:
        for said in finding.get("in_context", ()):
            key = said["context"], said["provision"], said["condition"]
            of_source.setdefault(key, {})[shown_name(finding["source"])] = None
    for row in kind.get("in_context", ()):
        sources = of_source.get((row["context"], row["provision"], row["condition"]), {})
        if sources:
            texts = {what: _text(row, what, words) for what in ("provision", "condition")}
            who = {"kind": kind["name"], "sources": ", ".join(sources), "context": row["context"]}
            sentence = f"tty.law.context.{row['verdict']}"
            yield f"   {words(sentence, **who, **texts)}", "magenta"


def pointer_lines(report: Mapping[str, Any], category: str, words: Words) -> Iterator[Line]:
    """Yield the provisions that a kind of data points at, in one line."""
    rows = [row for row in looked_at(report) if category in row["categories"]]
    if rows:
        yield f"   {words('tty.law.look', kind=category, names=_names(rows, words))}", "dim"


def further_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Yield the provisions that each context of the system points at; those of every system are in the report."""
    for context in report.get("contexts", ()):
        rows = [row for row in looked_at(report) if context["name"] in row["contexts"]]
        if rows:
            yield f"   {words('tty.law.look.context', context=context['name'], names=_names(rows, words))}", "dim"


def _names(rows: Iterable[Mapping[str, Any]], words: Words) -> str:
    return ", ".join(_text(row, "provision", words) for row in rows)


def _text(of: Mapping[str, Any], what: str, words: Words) -> str:
    said = of.get("translations", {}).get(words.language, {}).get(what) or of[what]
    return spaced(shown(blanked(said)), words.language)
