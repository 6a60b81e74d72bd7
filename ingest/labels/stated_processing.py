"""Who is responsible, what data are processed for, on which legal basis: from label and fleet files (Article 30(1)).

In: values that know their line. Out: ``Processing``; and several of them put together, where a name outranks a glob
and a robot's file its model's (rule S7). Nothing of it changes a flow.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.legal_bases import transfer_of
from rosprivacy.analysis.model import NOWHERE, Place, Processing
from rosprivacy.analysis.non_ros import DEROGATION, EVERY, OCCASIONAL

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rosprivacy.analysis.model import ByCategory, NonRosFacts
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.yaml_values import Value

OF_ELEMENT = ("purpose", "legal_basis")
OF_SYSTEM = ("controller", "dpo", *OF_ELEMENT)
LONGEST = 200  # characters of a text
Rank = tuple[int, int]


def read_processing(
    reader: NameReader, entries: Iterable[tuple[str, int, Value]], place: Place, keys: tuple[str, ...]
) -> Processing:
    """Read what some keys of a map say; other keys are read elsewhere."""
    said = Processing(place=place)
    for key, line, value in entries:
        if key not in keys:
            continue
        if key == "purpose":
            said = said._replace(purposes=_by_category(reader, key, line, value, _purposes))
        elif key == "legal_basis":
            from rosprivacy.ingest.reading.legal_basis import read_bases  # noqa: PLC0415 - light start

            stated = _by_category(reader, key, line, value, read_bases)
            said = said._replace(bases=stated, place=Place(reader.file, line))
        elif key == "controller":
            said = said._replace(controller=text_of(reader, key, value))
        else:
            said = said._replace(dpo=text_of(reader, key, value))
    return said


def read_system(reader: NameReader, top: Value, place: Place) -> Processing:
    """Read what the top of a file says of the whole system, or of the robot or model that the file is of."""
    said = read_processing(reader, top.entries, place, OF_SYSTEM)
    value = top.get("legal_basis")
    if value is not None and any(map(transfer_of, _all(said.bases))):
        hint = "state it where the data go: {kind: external-system, transfer: standard-clauses}"
        reader.problem(value.line, "a basis of a transfer for a whole system", hint)
    return said


def with_transfer(reader: NameReader, value: Value, facts: NonRosFacts, bases: ByCategory) -> NonRosFacts:
    """Return the facts of an element with the basis of a transfer that ``legal_basis`` names there: one fact, once."""
    named = sorted(set(transfers(bases)))
    written, line = value.get("transfer"), facts.place.line
    if not named:
        return facts
    if any(category != EVERY and any(map(transfer_of, some)) for category, some in bases):
        hint = f"write transfer: {named[0]}"
        reader.problem(line, "a basis of a transfer for one kind of data; it is stated of the whole element", hint)
    elif facts.transfer == OCCASIONAL and named == [DEROGATION]:
        return facts
    elif len(named) > 1 or (written is not None and written.text != named[0]):
        also = f", and transfer says {shown(written.text)}" if written is not None else ""
        what = f"legal_basis names {' and '.join(named)}{also}"
        reader.problem(line, what, "state one basis of a transfer")
    return facts._replace(transfer=named[0])


def transfers(bases: ByCategory) -> Iterator[str]:
    """Yield the bases of a transfer among legal bases, as ``transfer`` calls them.

    >>> list(transfers((("", ("6(1)(f)", "46(2)(c)", "49(1)(a)")),)))
    ['standard-clauses', 'derogation']
    """
    yield from filter(None, map(transfer_of, _all(bases)))


def _all(said: ByCategory) -> Iterator[str]:
    return (one for _, some in said for one in some)


def _by_category(
    reader: NameReader, key: str, line: int, value: Value, read: Callable[[NameReader, Value], Iterable[str]]
) -> ByCategory:
    """What is stated of every kind of data, or of each by its name."""
    pairs = value.entries if value.kind == "map" else ((EVERY, line, value),)
    if value.kind == "empty" or not pairs or (value.kind == "list" and not value.items):
        reader.problem(line, f"{key} says nothing", "write it, or remove the key")
        return ()
    found: dict[str, tuple[str, ...]] = {}
    for written, at, one in pairs:
        category = reader.kind_of_data(written, at) if written else EVERY
        if one.kind == "list" and not one.items:
            reader.problem(at, f"{key} of {shown(written)} says nothing", "write it, or remove the line")
        some = tuple(dict.fromkeys(read(reader, one)))
        if some and (category or not written):
            found[category] = tuple(sorted({*found.get(category, ()), *some}))
    return tuple(sorted(found.items()))


def _purposes(reader: NameReader, value: Value) -> Iterator[str]:
    for item in value.items if value.kind == "list" else (value,):
        text = text_of(reader, "purpose", item)
        kind, colon, _ = text.partition(": ")
        if colon and reader.vocabulary.find(kind) is not None:
            reader.problem(item.line, f"purpose {shown(text)!r} begins with a kind of data", f"write {{{kind}: …}}")
        elif text:
            yield text


def text_of(reader: NameReader, key: str, value: Value) -> str:
    """Return a text of one line; what is none is a problem."""
    if value.kind == "text" and value.text.strip() and value.text.isprintable() and len(value.text) <= LONGEST:
        return value.text.strip()
    what = f"{key}: {shown(value.text)!r}" if value.text else f"{key}: {_a(value.kind)}"
    reader.problem(value.line, what, f"write a text of one line, at most {LONGEST} characters")
    return ""


def _a(kind: str) -> str:
    return "nothing" if kind in ("empty", "text") else f"a {kind}"


def united(
    said: Iterable[tuple[Rank, Processing]], differ: Callable[[str, Processing, Processing], object] | None = None
) -> Processing:
    """Put together what several statements say of one thing: of each fact those of the highest rank count.

    Parameters
    ----------
    differ
        Is told of two that name different controllers, or officers, at one rank.
    """
    ordered = sorted((pair for pair in said if pair[1]), key=lambda pair: pair[0], reverse=True)
    found = {what: _foremost(ordered, what) for what in ("controller", "dpo", "purposes", "bases")}
    for what in ("controller", "dpo"):
        for other in found[what][1:]:
            if differ and getattr(other, what) != getattr(found[what][0], what):
                differ(what, found[what][0], other)
    places = [one.place for one in (*found["bases"], *(one for _, one in ordered))]
    return Processing(
        next((one.controller for one in found["controller"]), ""),
        next((one.dpo for one in found["dpo"]), ""),
        _joined(one.purposes for one in found["purposes"]),
        _joined(one.bases for one in found["bases"]),
        next(iter(places), NOWHERE),
    )


def two_of_one(what: str, first: Processing, other: Processing, error: type[InputError]) -> InputError:
    """Return the error for two files of one rank that name different controllers, or officers."""
    said = f"{what} {shown(getattr(other, what))!r}, and {shown(getattr(first, what))!r} at {first.place}"
    return error(other.place.file, other.place.line, said, "name one; joint controllers stand in one text")


def over(own: Processing, general: Processing) -> Processing:
    """Return what is said of one robot, and where it says nothing, what is said of all."""
    return united([((1, 0), own), ((0, 0), general)])


def _foremost(ordered: list[tuple[Rank, Processing]], what: str) -> list[Processing]:
    """Of those that say something, those of the highest rank."""
    saying = [(rank, one) for rank, one in ordered if getattr(one, what)]
    return [one for rank, one in saying if rank == saying[0][0]]


def _joined(several: Iterable[ByCategory]) -> ByCategory:
    found: dict[str, set[str]] = {}
    for said in several:
        for category, some in said:
            found.setdefault(category, set()).update(some)
    return tuple(sorted((category, tuple(sorted(some))) for category, some in found.items()))
