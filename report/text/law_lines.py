"""What the law says of the kinds of data that findings are about, as lines: once for each kind.

In: a JSON document of the contract and some of its findings. Out: lines, with texts of the ontology.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import blanked
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, spaced
from rosprivacy.report.finding_facts import in_order, looked_at, scope_sentences
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rosprivacy.report.text.line_parts import Line

NARROWER = "⊇ "  # how the ontology writes, in other languages than English: if the data are of one of these kinds


def law_lines(
    report: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], words: Words = IN_ENGLISH
) -> Iterator[Line]:
    """Return what a person has to look up about each kind of data that arrives somewhere, once for each kind."""
    ordered = in_order(findings, report)
    by_kind = {finding["category"]: finding for finding in ordered}
    findings_of = {kind: [finding for finding in ordered if finding["category"] == kind] for kind in by_kind}
    if not by_kind:
        return
    kinds = {category["name"]: category for category in report["categories"]}
    yield "", ""
    yield words("terminal.law.title"), "bold"
    for category, finding in by_kind.items():
        for legal in _law(finding, kinds, words):
            yield f"   {words('terminal.law.line', kind=category, **legal)}", "magenta"
        yield from _in_contexts(kinds.get(category, {}), findings_of[category], words)
        yield from _pointers(report, category, words)
        if finding["article9"] == "unknown":
            yield f"   {words('terminal.law.unknown', kind=category)}", "yellow"
        if finding["article9"] == "no":
            reason = _text(kinds[category], "reason", words) if category in kinds else ""
            yield f"   {words('terminal.law.no', kind=category, reason=reason)}", "dim"
    yield from _of_contexts(report, words)
    yield from ((f"   {sentence}", "yellow") for sentence in scope_sentences(report, words))


def _law(finding: Mapping[str, Any], kinds: Mapping[str, Mapping[str, Any]], words: Words) -> Iterator[dict[str, str]]:
    """The provisions of a finding, with the texts that the ontology has of them."""
    stated = kinds.get(finding["category"], {}).get("law", ())
    for legal in finding["law"]:
        alike = (
            other for other in stated if all(other[key] == legal[key] for key in ("provision", "verdict", "condition"))
        )
        texts = next(alike, {**legal, "translations": {}})
        condition = _text(texts, "condition", words).removeprefix(NARROWER)
        yield {
            "provision": _text(texts, "provision", words),
            "may": words(f"terminal.may.{legal['verdict']}"),
            "condition": words("terminal.law.condition", condition=condition) if condition else "",
        }


def _text(of: Mapping[str, Any], field: str, words: Words, fit: Callable[[str], str] = str) -> str:
    """A text of the ontology in the reader's language, in English if there is no translation."""
    text = of.get("translations", {}).get(words.language, {}).get(field) or of[field]
    return spaced(fit(blanked(text)), words.language)


def _in_contexts(kind: Mapping[str, Any], findings: Iterable[Mapping[str, Any]], words: Words) -> Iterator[Line]:
    """What data of a kind may reveal, once for each context and provision, with the sources there."""
    of_source: dict[tuple[str, str, str], dict[str, None]] = {}
    for finding in findings:
        for legal in finding.get("in_context", ()):
            at = legal["context"], legal["provision"], legal["condition"]
            of_source.setdefault(at, {})[shown_name(finding["source"])] = None
    for row in kind.get("in_context", ()):
        sources = of_source.get((row["context"], row["provision"], row["condition"]), {})
        if sources:
            texts = {what: _text(row, what, words, shown) for what in ("provision", "condition")}
            who = {"kind": kind["name"], "sources": ", ".join(sources), "context": row["context"]}
            sentence = f"terminal.law.context.{row['verdict']}"
            yield f"   {words(sentence, **who, **texts)}", "magenta"


def _pointers(report: Mapping[str, Any], category: str, words: Words) -> Iterator[Line]:
    """The provisions that a kind of data points at, in one line."""
    rows = [row for row in looked_at(report) if category in row["categories"]]
    if rows:
        yield f"   {words('terminal.law.look', kind=category, names=_names(rows, words))}", "dim"


def _of_contexts(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """The provisions that each context of the system points at; those of every system are in the report."""
    for context in report.get("contexts", ()):
        rows = [row for row in looked_at(report) if context["name"] in row["contexts"]]
        if rows:
            yield f"   {words('terminal.law.look.context', context=context['name'], names=_names(rows, words))}", "dim"


def _names(rows: Iterable[Mapping[str, Any]], words: Words) -> str:
    return ", ".join(_text(row, "provision", words, shown) for row in rows)
