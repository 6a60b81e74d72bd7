"""Texts of which parts may be open: joined, formatted and cut as Python's own strings are.

A text is a name of ``scan_facts.py``: pieces, one after the other. Pieces that the code fixes are joined to one.
"""

from __future__ import annotations

import re
from itertools import product
from string import Formatter
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.scan_facts import LITERAL, Name, NamePiece, as_default, open_name, plain_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

MANY = 32  # values that something can have: beyond that it is open
LONG = 1000  # signs of a text: no name is longer
PERCENT = re.compile(r"%(?:\((\w+)\))?([-+ #0-9.]*)([sdifr%])")
Texts = tuple[Name, ...]


def literal(text: str) -> Name:
    """Return a text that the code fixes."""
    return (NamePiece(text),) if len(text) <= LONG else open_name("a very long text")


def joined(parts: Iterable[Name]) -> Name:
    """Return the texts one after the other; neighbours that are known alike are one piece.

    >>> [piece.text for piece in joined([literal("/a"), literal("/b"), open_name("why"), literal("c")])]
    ['/a/b', None, 'c']
    """
    pieces: list[NamePiece] = []
    for piece in (one for part in parts for one in part):
        last = pieces[-1] if pieces else None
        alike = last is not None and last.text is not None and not last.parameter
        if alike and piece.text is not None and not piece.parameter and last.basis == piece.basis:  # type: ignore[union-attr]
            pieces[-1] = last._replace(text=last.text + piece.text)  # type: ignore[operator,union-attr]
        elif piece.text != "" or piece.parameter or piece.basis != LITERAL:
            pieces.append(piece)
    whole = tuple(pieces) or literal("")
    short = len(whole) <= MANY and sum(len(one.text or "") for one in whole) <= LONG
    return whole if short else open_name("a very long text")


def every(parts: Sequence[Texts], join: Callable[[Iterable[Name]], Name] = joined) -> Texts:
    """Return each way to choose one of each part, joined; one open text where they are too many."""
    ways = 1
    for part in parts:
        ways *= len(part)
    if ways > MANY:
        return (open_name(f"more than {MANY} values"),)
    return tuple(dict.fromkeys(join(one) for one in product(*parts)))


def path_of(parts: Iterable[Name]) -> Name:
    """Return what ``os.path.join`` makes of some texts."""
    pieces: list[Name] = []
    for part in parts:
        first = part[0].text or ""
        if first.startswith("/"):
            pieces = []
        elif pieces and not (pieces[-1][-1].text or "").endswith("/"):
            pieces.append(literal("/"))
        pieces.append(part)
    return joined(pieces)


def formatted(template: str, places: Sequence[Texts], names: Mapping[str, Texts]) -> Texts:
    """Return what ``template.format(*places, **names)`` gives; names may hold ``a.b`` for what is looked into."""
    parts: list[Texts] = []
    count = 0
    try:
        for before, field, spec, _ in Formatter().parse(template):
            parts.append((literal(before),))
            if field is None:
                continue
            key = field
            if not field:
                key, count = str(count), count + 1
            chosen = places[int(key)] if key.isdigit() and int(key) < len(places) else names.get(key)
            parts.append(tuple(_spec(one, spec or "") for one in chosen) if chosen else (open_name(f"{{{key}}}"),))
    except (ValueError, IndexError):
        return (open_name("a text of format that cannot be read"),)
    return every(parts)


def _spec(text: Name, spec: str) -> Name:
    known = plain_text(text)
    if not spec or known is None:
        return text
    return literal_format(int(known) if known.lstrip("-").isdigit() and not spec.endswith("s") else known, spec)


def literal_format(value: object, spec: str) -> Name:
    """Return ``format(value, spec)``, where that is a short text."""
    if re.search(r"\d{4}", spec):
        return open_name("a very long text")
    try:
        return literal(format(value, spec))
    except (ValueError, TypeError):
        return open_name("a text of format that cannot be read")


def percent(template: str, places: Sequence[Texts], names: Mapping[str, Texts]) -> Texts:
    """Return what ``template % places`` or ``template % names`` gives."""
    parts: list[Texts] = []
    begin = count = 0
    for found in PERCENT.finditer(template):
        parts.append((literal(template[begin : found.start()]),))
        begin = found.end()
        if found[3] == "%":
            parts.append((literal("%"),))
            continue
        if found[1]:
            chosen = names.get(found[1])
        else:
            chosen = places[count] if count < len(places) else None
            count += 1
        spec = found[2] + ("d" if found[3] in "di" and found[2] else "")
        parts.append(tuple(_spec(one, spec) for one in chosen) if chosen else (open_name("what % puts in"),))
    parts.append((literal(template[begin:]),))
    return every(parts)


METHODS: Mapping[str, Callable[..., str]] = {
    "lower": str.lower, "upper": str.upper, "title": str.title, "capitalize": str.capitalize,
    "replace": str.replace, "strip": str.strip, "lstrip": str.lstrip, "rstrip": str.rstrip,
    "removeprefix": str.removeprefix, "removesuffix": str.removesuffix,
}  # fmt: skip
LEFT: Mapping[str, Callable[..., str]] = {"strip": str.lstrip, "lstrip": str.lstrip, "removeprefix": str.removeprefix}
RIGHT: Mapping[str, Callable[..., str]] = {"strip": str.rstrip, "rstrip": str.rstrip, "removesuffix": str.removesuffix}


def changed(method: str, text: Name, arguments: Sequence[str]) -> Name | None:
    """Return what a method of strings makes of a text; None if that is not known.

    A part that a parameter fills stays one where only the edges are cut.
    """
    if method not in METHODS or not text:
        return None
    try:
        if method in LEFT or method in RIGHT:
            pieces = [*text]
            for at, cut in ((0, LEFT.get(method)), (-1, RIGHT.get(method))):
                edge = pieces[at].text
                if cut and edge:
                    pieces[at] = pieces[at]._replace(text=cut(edge, *arguments))
            return joined([(one,) for one in pieces])
        whole = plain_text(text)
        if whole is None:
            return None
        after = METHODS[method](whole, *arguments)
        return text if after == whole else joined([literal(after) if _fixed(text) else as_default(literal(after))])
    except (TypeError, ValueError):
        return None


def _fixed(text: Name) -> bool:
    return all(one.basis == LITERAL for one in text)
