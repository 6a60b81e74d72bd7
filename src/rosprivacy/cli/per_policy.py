"""``analyze --per-policy``: each policy alone, one after the other, and what comes out together.

In: names of policies and their results. Out: text or JSON, and the worst verdict. Nothing is merged: what goes from one
policy's nodes to another's is no part of these answers, and the text says so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.formats import Style, written
from rosprivacy.report.naming import count_elements

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.result import Result

    Results = Sequence[tuple[str, Result]]

FORMAT = "rosprivacy.analyses/1"
WORST_FIRST = ("leak", "undetermined", "no-leak-found")  # verdicts
CODES_WORST_FIRST = (1, 4, 0)


def texts(results: Results, style: Style) -> str:
    """Return the reports one after the other, and a summary; of ``quiet`` the summary alone."""
    reports = (
        [] if style.quiet else [f"== {shown(file)}\n{written(result, 'text', style)}\n" for file, result in results]
    )
    worst = worst_of((str(result.analysis.verdict) for _, result in results), WORST_FIRST)
    what = "what goes from the nodes of one to those of another is not looked at"
    head = f"{worst}: the worst of {counted(len(results), 'policy', 'policies')}, each alone; {what}"
    return "".join([*reports, *(f"{line}\n" for line in (*(_row(*one) for one in results), head))])


def document(results: Results, *, short: bool) -> dict[str, Any]:
    """Return the documents of all policies in one, each ``rosprivacy.analysis/2`` if ``short``, else ``/1``."""
    from rosprivacy.documents import document_of
    from rosprivacy.report.document.analysis import short_document

    return {
        "format": FORMAT,
        "verdict": worst_of((str(result.analysis.verdict) for _, result in results), WORST_FIRST),
        "policies": [
            {"policy": file, "analysis": short_document(document_of(result)) if short else result.document()}
            for file, result in results
        ],
    }


def worst_of(values: Iterable[Any], worst_first: Sequence[Any]) -> Any:
    """Return the worst of some verdicts or exit codes."""
    return min(values, key=worst_first.index)


def _row(file: str, result: Result) -> str:
    analysis = result.analysis
    findings = counted(sum(finding.stands for finding in analysis.findings), "finding")
    open_elements = count_elements(question.element for question in analysis.open).elements
    return f"{analysis.verdict}: {shown(file)}: {findings}, {counted(open_elements, 'element')} to review"
