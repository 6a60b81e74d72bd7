"""An ``Answer`` -> the whole JSON document of the contract: the analysis, what was decided, what is told of a fleet,
what the enforced view adds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.document.analysis import analysis_document
from rosprivacy.report.document.doubts import with_sentence
from rosprivacy.report.document.message_types import with_types
from rosprivacy.report.document.processing import with_processing

if TYPE_CHECKING:
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument


def document(answer: Answer) -> AnalysisDocument:
    """Return the JSON document of an answer."""
    made = with_types(with_processing(analysis_document(answer), answer), answer)
    if answer.decided:
        from rosprivacy.report.document.decisions import with_decisions  # noqa: PLC0415 - light start

        made = with_decisions(made, answer.decided)
    if answer.fleet:
        from rosprivacy.report.document.fleet import fleet_document  # noqa: PLC0415 - light start

        made = fleet_document(made, answer.fleet, answer.fleet_counts(answer.fleet))
    if answer.enforced:
        from rosprivacy.report.document.enforced import enforced_document  # noqa: PLC0415 - light start

        made["enforced"] = enforced_document(answer.enforced)
    return with_sentence(made)
