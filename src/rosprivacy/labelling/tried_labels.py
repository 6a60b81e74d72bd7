"""Labels that are tried: what the answer would be if they were said, too. Nothing is written.

In: an answer, labels. Out: the answer with them.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.ingest.labels.label_file import parse_labels

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.suggesting.written import WrittenLabel
    from rosprivacy.result import Result


def with_more(result: Result, labels: Iterable[WrittenLabel], name: str) -> Result | None:
    """Return the answer with some labels more, as a file of that name; None if nobody can tell.

    Raises
    ------
    InputErrors
        If they contradict each other, or what is said.
    """
    if result.again is None:
        return None
    sections: dict[str, dict[str, dict[str, list[object]]]] = defaultdict(
        lambda: defaultdict(lambda: defaultdict(list))
    )
    for label in labels:
        for role, said in label.said.items():
            sections[label.section][label.name][role] += said
    text = json.dumps({"labels": 1, **sections})
    return result.again((*result.labels, parse_labels(text, result.vocabulary, name=name)))
