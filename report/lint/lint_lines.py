"""The document of broken rules -> lines for the terminal, one each, as compilers write them."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.contract.policies import LintDocument


def lint_lines(document: LintDocument) -> Iterator[str]:
    """Yield a line for each broken rule, then how often which rule is broken and what comes of it."""
    breaches = document["breaches"]
    for breach in breaches:
        place = f"{shown(breach['file'])}:{breach['line']}" if breach["line"] else shown(breach["file"])
        yield f"{place}: {breach['severity']} {breach['rule']}: {breach['message']}"
    if not breaches:
        yield f"no rule is broken in {counted(len(document['policies']), 'file')}"
        yield from _unseen(document)
        return
    yield ""
    times = Counter(breach["rule"] for breach in breaches)
    why = {breach["rule"]: breach["why"] for breach in breaches}
    for rule, count in times.items():
        yield f"{rule} ({count}): {why[rule]}"
    yield from _unseen(document)


def _unseen(document: LintDocument) -> Iterator[str]:
    for rule in document["not_looked_at"]:
        yield f"{rule} was not looked at: it needs labels; name them with -l"
