"""The answers of the person who assesses: what the page saved, read back for the next report.

In: a path. Out: ``Answers``. The page writes the file (``report.js``); people may change it by hand.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.json_values import misfits, parsed, validator
from rosprivacy.analysis.text import printable
from rosprivacy.report.compare.earlier import bytes_of

if TYPE_CHECKING:
    from collections.abc import Mapping

FORMAT = "rosprivacy.assessment/1"
HINT = "give what the button 'Save the answers' of a report wrote"
SCHEMA = {
    "type": "object",
    "required": ["format", "answers"],
    "properties": {
        "format": {"const": FORMAT},
        "answers": {"type": "object", "additionalProperties": {"type": "string"}},
    },
    "additionalProperties": False,
}


@dataclass(frozen=True, slots=True)
class Answers:
    """What a person answered.

    Attributes
    ----------
    texts
        Key of a field -> its text, lines kept; no empty ones.
    """

    texts: Mapping[str, str] = field(default_factory=dict)
    file: str = ""
    sha256: str = ""


def read_answers(file: str) -> Answers:
    """Read the answers of an earlier report.

    Raises
    ------
    InputError
        If the file cannot be read, or is no JSON.
    InputErrors
        With a line for each place that is not as the format says.
    """
    data = bytes_of(file, HINT)
    value = parsed(data, lambda *said: InputError(file, *said), HINT)
    wrong = misfits(validator(SCHEMA), value)
    if wrong:
        raise InputErrors(InputError(file, 0, text, HINT) for text in wrong)
    texts = {key: clean for key, text in sorted(value["answers"].items()) if (clean := _clean(text))}
    return Answers(texts, file, hashlib.sha256(data).hexdigest())


def _clean(text: str) -> str:
    """The lines, each fit to be shown."""
    return "\n".join(printable(line) for line in text.strip().splitlines())
