"""What was sent to a language model and what it answered, as a file that is evidence: written once, read to ask again.

The bytes of each question and answer stand in it with their SHA-256. It has no key.
"""

from __future__ import annotations

import hashlib
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.json_values import parsed
from rosprivacy.ingest.reading.bounded_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Callable

FORMAT = "rosprivacy.model-exchanges/1"
LARGEST = 256 * 2**20
AGAIN = "write it again with --record"


class Exchange(NamedTuple):
    """A question and what came back; no answer where the server gave none."""

    question: bytes
    answer: bytes | None


class Exchanges(NamedTuple):
    """What stands in a file.

    Attributes
    ----------
    url
        Where it was sent.
    masked
        Whether names were masked.
    date
        When, ``YYYY-MM-DD``.
    sha256
        Of the file, if it was read.
    """

    model: str
    url: str
    masked: bool
    date: str
    exchanges: tuple[Exchange, ...]
    sha256: str = ""


def as_document(said: Exchanges) -> dict[str, Any]:
    """Return what is written as JSON.

    >>> as_document(Exchanges("m", "http://localhost/v1", False, "2026-01-01", (Exchange(b"{}", None),)))["exchanges"]
    [{'question': '{}', 'question_sha256': '44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a', \
'answer': None, 'answer_sha256': None}]
    """
    return {
        "format": FORMAT,
        "model": said.model,
        "url": said.url,
        "masked": said.masked,
        "date": said.date,
        "exchanges": [_exchange(one) for one in said.exchanges],
    }


def _exchange(one: Exchange) -> dict[str, Any]:
    return {
        "question": one.question.decode("ascii"),
        "question_sha256": _digest(one.question),
        "answer": None if one.answer is None else one.answer.decode(),
        "answer_sha256": None if one.answer is None else _digest(one.answer),
    }


def read_exchanges(file: str) -> Exchanges:
    """Read a file that was recorded.

    Raises
    ------
    InputError
        If it is none, or a text in it is not the one of its SHA-256.
    """
    data = read_regular(file, LARGEST, partial(InputError, file))
    top = parsed(data, partial(InputError, file), AGAIN)
    if not isinstance(top, dict) or top.get("format") != FORMAT:
        raise InputError(file, 0, f"is no {FORMAT}", "name a file that --record wrote")
    try:
        exchanges = tuple(_read(one) for one in _of(top, "exchanges", list))
        texts = (_of(top, "model", str), _of(top, "url", str), _of(top, "masked", bool), _of(top, "date", str))
    except _OddError as odd:
        raise InputError(file, 0, str(odd), AGAIN) from None
    return Exchanges(*texts, exchanges, hashlib.sha256(data).hexdigest())


class _OddError(Exception):
    """What the file lacks."""


def _of(value: Any, key: str, type_: type) -> Any:
    if not isinstance(value, dict) or not isinstance(value.get(key), type_):
        raise _OddError(f"{shown(key)} is not there, or no {type_.__name__}")
    return value[key]


def _read(one: Any) -> Exchange:
    question = _of(one, "question", str).encode()
    answer = None if one.get("answer") is None else _of(one, "answer", str).encode()
    if one.get("question_sha256") != _digest(question) or (answer and one.get("answer_sha256") != _digest(answer)):
        raise _OddError("a question or an answer was changed: its SHA-256 is another one")
    return Exchange(question, answer)


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def replayed(file: str, there: Exchanges) -> Callable[[bytes], bytes]:
    """Return what answers a question as it was answered then.

    Examples
    --------
    >>> ask = replayed("f.json", Exchanges("m", "u", False, "2026-01-01", (Exchange(b"a", b"1"), Exchange(b"b", None))))
    >>> ask(b"a")
    b'1'
    >>> ask(b"b")
    Traceback (most recent call last):
        ...
    rosprivacy.analysis.errors.InputError: f.json: has no answer to what would be asked now; the input, the kinds or \
the program is another one, or the model was not reached then: ask again with --record
    """
    answers = {one.question: one.answer for one in there.exchanges}

    def answer(question: bytes) -> bytes:
        said = answers.get(question)
        if said is None:
            hint = "the input, the kinds or the program is another one, or the model was not reached then"
            what = "has no answer to what would be asked now"
            raise InputError(file, 0, what, f"{hint}: ask again with --record")
        return said

    return answer
