"""The bytes of a message as it goes over the wire -> its fields, by a layout; nothing is believed of a length in it.

In: bytes. Out: values as those of YAML (``yaml_values.py``), so that one reader takes both.

Source: OMG DDSI-RTPS, clause 10 (plain CDR): a value of n bytes begins at a multiple of n.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from rosprivacy.ingest.reading.yaml_values import Value

if TYPE_CHECKING:
    from collections.abc import Mapping

    Layout = Mapping[str, tuple[tuple[str, str], ...]]  # type -> name and type of each field

ORDERS = {b"\0\0": ">", b"\0\1": "<"}
NUMBERS = {
    "bool": "?", "byte": "B", "uint8": "B", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float64": "d",
}  # fmt: skip
PADDING = 4


class Message:
    """A message that is read from its beginning on; every problem is a ``ValueError``."""

    def __init__(self, payload: bytes) -> None:
        order = ORDERS.get(payload[:2])
        if order is None:
            raise ValueError("an encoding that is not plain CDR")
        self._body, self._at = payload[4:], 0
        self._numbers = {name: struct.Struct(order + form) for name, form in NUMBERS.items()}

    def number(self, kind: str) -> float:
        """Return the next number."""
        form = self._numbers[kind]
        self._at += -self._at % form.size
        if self._at + form.size > len(self._body):
            raise ValueError("cut off")
        (value,) = form.unpack_from(self._body, self._at)
        self._at += form.size
        return float(value) if kind == "float64" else int(value)

    def text(self) -> str:
        """Return the next text."""
        length = int(self.number("uint32"))
        text = self._body[self._at : self._at + length]
        if length == 0 or len(text) < length or not text.endswith(b"\0"):
            raise ValueError("no text where one has to be")
        self._at += length
        return text[:-1].decode(errors="replace")

    def value(self, kind: str, layout: Layout) -> Value:
        """Return the next value of a type: ``uint8``, ``string``, a key of the layout, ``T[]`` or ``T[32]``.

        Numbers of a list without a fixed length are passed over: nothing that is read here stands in one.
        """
        if kind.endswith("]"):
            inner, _, fixed = kind[:-1].partition("[")
            number = int(fixed or self.number("uint32"))
            if number > len(self._body) - self._at:
                raise ValueError("a list that is longer than the message")
            if inner in NUMBERS and not fixed:
                return self._passed(inner, number)
            return Value(0, "list", items=tuple(self.value(inner, layout) for _ in range(number)))
        if kind == "string":
            return Value(0, "text", self.text())
        if kind in NUMBERS:
            return Value(0, "number", str(self.number(kind)))
        return Value(0, "map", entries=tuple((name, 0, self.value(one, layout)) for name, one in layout[kind]))

    def _passed(self, kind: str, number: int) -> Value:
        size = self._numbers[kind].size
        if number:
            self._at += -self._at % size + size * number
        if self._at > len(self._body):
            raise ValueError("cut off")
        return Value(0, "list")

    def ended(self, padding: int = PADDING) -> None:
        """Make sure that nothing is left but padding."""
        if len(self._body) - self._at >= padding:
            raise ValueError("more than the message has fields")
