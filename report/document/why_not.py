"""Why data does not get from one element to another, as JSON ``rosprivacy.why-not/1``.

In: ``WhyNot`` facts. Out: plain dicts and lists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.document.element_entry import element_dict

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.whatif.why_not import WhyNot

FORMAT = "rosprivacy.why-not/1"


def document(answers: Iterable[WhyNot]) -> dict[str, Any]:
    """Return the answers as one JSON object."""
    return {
        "format": FORMAT,
        "answers": [
            {
                "category": answer.category,
                "source": element_dict(answer.source),
                "leak": element_dict(answer.leak),
                "finding": answer.finding.id if answer.finding else None,
                "path": [element_dict(element) for element in answer.path],
                "obstacles": [
                    {
                        "by": obstacle.by,
                        "element": element_dict(obstacle.element),
                        "to": element_dict(obstacle.to) if obstacle.to else None,
                        "category": obstacle.category,
                        "places": [{"file": place.file, "line": place.line} for place in obstacle.places],
                    }
                    for obstacle in answer.obstacles
                ],
                "reached": answer.reached,
            }
            for answer in answers
        ],
    }
