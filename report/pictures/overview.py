"""Several findings -> one small picture: their shortest paths and nothing else, for the first page of a report.

In: an ``Analysis`` and findings of it. Out: a ``Picture``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.pictures.flow_lines import data_lines
from rosprivacy.report.pictures.picture import PRIVACY, Picture, sorted_boxes
from rosprivacy.report.pictures.privacy import Reached
from rosprivacy.report.pictures.views import core, in_words, pairs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.report.pictures.phrases import Phrases


def overview(analysis: Analysis, findings: Sequence[Finding], say: Phrases | None = None) -> Picture:
    """Return the shortest paths of findings.

    Complexity: O(flows + elements).
    """
    reached = Reached(analysis, {finding.category for finding in findings}, say)
    steps = {(step.source, step.target) for finding in findings for step in finding.steps}
    elements = analysis.graph.elements
    flows = [
        number
        for number, flow in enumerate(analysis.graph.flows)
        if (elements[flow.source], elements[flow.target]) in steps
    ]
    boxes = {box.key: box for box in reached.boxes(core(findings))}
    lines = data_lines(reached, boxes, flows, dict.fromkeys(flows, 1), pairs(findings))
    words = tuple(in_words(finding) for finding in findings)
    return Picture(PRIVACY, "", sorted_boxes(boxes.values()), lines.drawn_lines(), (), words, core(findings))


def drawable(findings: Sequence[Finding], limit: int) -> int:
    """Return how many findings, from the first on, have no more elements together than asked for; one at least."""
    count = min(len(findings), 1)
    while count < len(findings) and len(core(findings[: count + 1])) <= limit:
        count += 1
    return count
