"""What a person has said no to, in the label files that an answer rests on: it is not suggested again."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.yaml_values import MAX_BYTES
from rosprivacy.ingest.suggestions.refusals import refusals_in

if TYPE_CHECKING:
    from rosprivacy.result import Result


def refused_in(result: Result) -> frozenset[str]:
    """Return it as ``refusal_key`` has it; of a file that is gone by now, nothing.

    Of a fleet nothing: which file is whose is not known here, and a no of one robot is none of another's. What is
    suggested again harms nobody.

    Raises
    ------
    LabelError
        If a file cannot be read any more.
    """
    if result.fleet is not None:
        return frozenset()
    files = [one["file"] for one in result.assumptions.get("labels", ())]
    own = [file for file in files if not file.startswith(OURS) and Path(file).is_file()]
    texts = (read_utf8(file, MAX_BYTES, partial(LabelError, file))[0] for file in own)
    return frozenset().union(*map(refusals_in, texts))
