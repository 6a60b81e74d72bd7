"""Who is responsible, what data are processed for and on which basis, for the file of the CNIL's tool: 112, 211, 212.

In: what was stated. Out: ``Html``, empty where nobody stated anything: the tool counts an empty answer as work begun.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.processed import BASIS, PURPOSE
from rosprivacy.report.cnil.markup import Html, bullets, escaped, joined, paragraph, strong

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.report.cnil.inventory import Kind
    from rosprivacy.report.cnil.told import Told

    Rows = Iterable[Processed]


def responsible(rows: Rows, words: Told) -> Html:
    """Return the answer to 112: who is responsible, and the data-protection officers."""
    controllers = dict.fromkeys(one for row in rows for one in row.controllers)
    officers = dict.fromkeys(one for row in rows for one in row.officers)
    said = [words.pair(words("cnil.controller"), escaped(one)) for one in controllers]
    said += [words.pair(words("cnil.officer"), escaped(one)) for one in officers]
    return joined(bullets(said), paragraph(words("cnil.responsible.open"))) if said else Html("")


def purposes(rows: Rows, kinds: Iterable[Kind], words: Told) -> Html:
    """Return the answer to 211: what each kind of data is processed for, and where."""
    return _by_kind(rows, kinds, words, lambda row: _stated(row, row.purposes, PURPOSE, words, str))


def bases(rows: Rows, kinds: Iterable[Kind], words: Told) -> Html:
    """Return the answer to 212: on which basis each kind of data is processed, and where; no word that it fits."""
    said = _by_kind(rows, kinds, words, lambda row: _stated(row, row.bases, BASIS, words, words.words.basis))
    return joined(said, paragraph(words("cnil.bases.open"))) if said else said


def _by_kind(rows: Rows, kinds: Iterable[Kind], words: Told, statement: Callable[[Processed], Html]) -> Html:
    parts = []
    for kind in kinds:
        here = [(row, statement(row)) for row in rows if row.category == kind.category.name]
        lines = [words.pair(escaped(words.name(row.element)), text) for row, text in here if text]
        if lines:
            title = kind.category.text("title", words.words.language)
            parts += [paragraph(strong(escaped(title))), bullets(lines)]
    return joined(*parts)


def _stated(row: Processed, texts: Iterable[str], fact: str, words: Told, say: Callable[[str], str]) -> Html:
    """What is stated of one end, and whether more is to be completed; empty where nothing is."""
    stated = [escaped(say(one)) for one in texts]
    more = [words("record.open")] if stated and fact in row.missing else []
    return Html("; ".join([*stated, *more]))


def purposes_of(rows: Rows, category: str, words: Told) -> Iterator[Html]:
    """Yield what a kind of data is processed for, in one line for the answer to 121."""
    here = [row for row in rows if row.category == category]
    texts = dict.fromkeys(one for row in here for one in row.purposes)
    if texts:
        more = [words("record.open")] if any(PURPOSE in row.missing for row in here) else []
        yield words.line("cnil.purposes", Html("; ".join([*map(escaped, texts), *more])))
