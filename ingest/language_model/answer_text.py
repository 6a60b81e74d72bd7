"""What a server of a language model sent -> the answers in it, or why there are none.

The outer form is that of chat completions; if it is another one, the address is no such server, and that is an error.
What the model wrote into it is anybody's text: it is JSON of the form that was asked for, or it is dropped and told.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from rosprivacy.analysis.errors import ModelError
from rosprivacy.analysis.json_values import parsed

REFUSED, NO_JSON, CUT = "the model refused", "an answer is no JSON of the form asked for", "an answer is cut short"
BASE = "is --model-url the address that /chat/completions comes after?"


class Answered(NamedTuple):
    """The answers to one question.

    Attributes
    ----------
    unread
        Why nothing of it could be read; empty if it was.
    """

    answers: tuple[Any, ...]
    unread: str = ""


def answers_in(data: bytes, where: str) -> Answered:
    r"""Return the answers, of any form.

    Parameters
    ----------
    where
        Who sent it, for messages.

    Raises
    ------
    ModelError
        If it is no chat completion.

    Examples
    --------
    >>> text = b'{"choices": [{"message": {"content": "{\\"suggestions\\": [1]}"}}]}'
    >>> answers_in(text, "localhost"), answers_in(b'{"choices": [{"message": {"refusal": "no"}}]}', "localhost").unread
    (Answered(answers=(1,), unread=''), 'the model refused')
    """

    def fail(line: int, what: str, hint: str) -> ModelError:
        del line, hint  # of files
        return ModelError(f"{where}: the answer is no chat completion ({what}); {BASE}")

    outer = parsed(data, fail, "")
    try:
        choice = outer["choices"][0]
        message = choice["message"]
        content, refusal = message.get("content"), message.get("refusal")
        ended = choice.get("finish_reason")
    except (LookupError, TypeError, AttributeError):
        raise fail(0, "it has no choices with a message", "") from None
    if refusal or ended == "content_filter":
        return Answered((), REFUSED)
    if not isinstance(content, str):
        return Answered((), NO_JSON)
    return _read(content, CUT if ended == "length" else NO_JSON)


def _read(content: str, otherwise: str) -> Answered:
    try:
        inner = parsed(content.encode(), lambda _, what, hint: ModelError(f"{what}; {hint}"), "")
    except ModelError:
        return Answered((), otherwise)
    if not isinstance(inner, dict) or list(inner) != ["suggestions"] or not isinstance(inner["suggestions"], list):
        return Answered((), otherwise)
    return Answered(tuple(inner["suggestions"]))
