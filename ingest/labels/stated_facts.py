"""What people state beside the way of data: processing and its basis, where a system works, the types of channels.

In: values that know their line, or properties of a database. Out: ``Processing`` (Article 30(1)), ``Surroundings`` and
``MessageType`` facts; and several of each put together, where a name outranks a glob and a robot's file its model's
(rule S7). What is not understood is a problem (rule S11). Nothing of it changes a flow, but that types limit (S15).
"""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.legal import transfer_of
from rosprivacy.analysis.model import (
    CONTEXTS,
    NOWHERE,
    OF_KIND,
    MessageType,
    Place,
    Processing,
    Surroundings,
    kind_of_type,
)
from rosprivacy.analysis.non_ros import DEROGATION, EVERY, OCCASIONAL
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, nearest
from rosprivacy.ingest.labels.countries import countries

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import ByCategory, FlowGraph, NonRosFacts
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.format_reader import FileReader
    from rosprivacy.ingest.reading.yaml_values import Value

OF_SYSTEM = ("controller", "dpo", "purpose", "legal_basis")  # at the top of a file
SURROUNDINGS = ("context", "country", "gdpr")  # there too
GROUNDS = ("established", "targeted")  # on which the GDPR applies outside the EEA, Article 3(1) and (2)
TRUE, FALSE = ("true", "yes", "on"), ("false", "no", "off")
LONGEST_TEXT = 200  # characters
LONGEST_TYPE = 500  # characters; what was observed is anybody's
Rank = tuple[int, int]


def read_processing(reader: NameReader, item: tuple[str, int, Value]) -> Mapping[str, Any]:
    """Return what one key of ``OF_SYSTEM`` states, by the fields of ``Processing``."""
    key, line, value = item
    if key == "purpose":
        return {"purposes": _by_category(reader, key, line, value, _purposes)}
    if key == "legal_basis":
        from rosprivacy.ingest.reading.legal_basis import read_bases  # noqa: PLC0415 - light start

        return {"bases": _by_category(reader, key, line, value, read_bases)}
    return {key: _text(reader, key, value)}


def processing_at(place: Place, items: Iterable[tuple[str, int, Value]], facts: Mapping[str, Any]) -> Processing:
    """Return what was read of some keys; its place is that of the legal basis, where one is stated."""
    line = next((line for key, line, _ in items if key == "legal_basis"), place.line)
    fields = {key: facts[key] for key in ("controller", "dpo", "purposes", "bases") if key in facts}
    return Processing(place=place._replace(line=line), **fields)


def read_system(reader: NameReader, top: Value) -> Processing:
    """Read what the top of a file says of the whole system, or of the robot or model that the file is of."""
    items = [item for item in top.entries if item[0] in OF_SYSTEM]
    facts: dict[str, Any] = {}
    for item in items:
        facts |= read_processing(reader, item)
    stated = processing_at(Place(reader.file, items[0][1]), items, facts)
    value = top.get("legal_basis")
    if value is not None and any(map(transfer_of, _all(stated.bases))):
        hint = "state it where the data go: {kind: external-system, transfer: standard-clauses}"
        reader.problem(value.line, "a basis of a transfer for a whole system", hint)
    return stated


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


def _all(stated: ByCategory) -> Iterator[str]:
    return (one for _, some in stated for one in some)


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
        text = _text(reader, "purpose", item)
        kind, colon, _ = text.partition(": ")
        if colon and reader.vocabulary.find(kind) is not None:
            reader.problem(item.line, f"purpose {shown(text)!r} begins with a kind of data", f"write {{{kind}: …}}")
        elif text:
            yield text


def _text(reader: NameReader, key: str, value: Value) -> str:
    """A text of one line; what is none is a problem."""
    if value.kind == "text" and value.text.strip() and value.text.isprintable() and len(value.text) <= LONGEST_TEXT:
        return value.text.strip()
    what = f"{key}: {shown(value.text)!r}" if value.text else f"{key}: {_a(value.kind)}"
    reader.problem(value.line, what, f"write a text of one line, at most {LONGEST_TEXT} characters")
    return ""


def _a(kind: str) -> str:
    return "nothing" if kind in ("empty", "text") else f"a {kind}"


def united(
    statements: Iterable[tuple[Rank, Processing]], differ: Callable[[str, Processing, Processing], object] | None = None
) -> Processing:
    """Put together what several statements say of one thing: of each fact those of the highest rank count.

    Parameters
    ----------
    differ
        Is told of two that name different controllers, or officers, at one rank.
    """
    ordered = sorted((pair for pair in statements if pair[1]), key=lambda pair: pair[0], reverse=True)
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


def two_of_one(fact: str, first: Processing, other: Processing, error: type[InputError]) -> InputError:
    """Return the error for two files of one rank that name different controllers, or officers."""
    said = f"{fact} {shown(getattr(other, fact))!r}, and {shown(getattr(first, fact))!r} at {first.place}"
    return error(other.place.file, other.place.line, said, "name one; joint controllers stand in one text")


def over(own: Processing, general: Processing) -> Processing:
    """Return what is said of one robot, and where it says nothing, what is said of all."""
    return united([((1, 0), own), ((0, 0), general)])


def _foremost(ordered: list[tuple[Rank, Processing]], fact: str) -> list[Processing]:
    """Of those that say something, those of the highest rank."""
    saying = [(rank, one) for rank, one in ordered if getattr(one, fact)]
    return [one for rank, one in saying if rank == saying[0][0]]


def _joined(several: Iterable[ByCategory]) -> ByCategory:
    found: dict[str, set[str]] = {}
    for said in several:
        for category, some in said:
            found.setdefault(category, set()).update(some)
    return tuple(sorted((category, tuple(sorted(some))) for category, some in found.items()))


def read_context_names(reader: FileReader, value: Value) -> tuple[str, ...]:
    """Return the contexts of a list, or of one name; what is none of them is a problem, with the nearest names."""
    items = (value,) if value.kind == "text" else value.items
    if not items:
        reader.problem(value.line, "context names nothing", f"write some of {', '.join(CONTEXTS)}, or remove it")
    found = set()
    for item in items:
        if item.kind == "text" and item.text in CONTEXTS:
            found.add(item.text)
        else:
            what = f"unknown context {shown(item.text)!r}" if item.text else f"a {item.kind} where a context is named"
            reader.problem(item.line, what, _hint(item.text))
    return tuple(sorted(found))


def read_country_code(reader: FileReader, value: Value) -> str:
    """Return the country code that a value states; empty where it states none, which is a problem."""
    if value.text in countries().areas:  # YAML takes NO for 'no', so the text counts
        return value.text
    what = f"{written(value)} is not an ISO 3166-1 country code"
    reader.problem(value.line, what, countries().hint(value.text))
    return ""


def read_grounds(reader: FileReader, value: Value) -> dict[str, bool]:
    """Return which grounds for the GDPR (Article 3) a value affirms or denies."""
    found = {}
    for key, line, said in value.entries if value.kind == "map" else ():
        flag = flag_of(said)
        if key in GROUNDS and flag is not None:
            found[key] = flag
        else:
            what = f"{key}: {written(said)}" if key in GROUNDS else f"unknown key {shown(key)!r}"
            reader.problem(line, f"{what} in gdpr", "write established: true or false, targeted: true or false")
    if not value.entries:
        reader.problem(value.line, f"gdpr is {written(value)}", "write {established: false, targeted: false}")
    return found


def surroundings_of(properties: Mapping[str, Any], *, ros: bool) -> Surroundings:
    """Return what properties of an element in the database state.

    Parameters
    ----------
    ros
        Whether its country is that of its system; of an element outside ROS it is a fact of its own.

    Raises
    ------
    TypeError
        If they cannot be understood; the message says why.

    Examples
    --------
    >>> surroundings_of({"context": ["care"], "country": "DE"}, ros=True)
    Surroundings(contexts=('care',), country='DE', abroad=False, established=None, targeted=None)
    """
    contexts = properties.get("context") or []
    if not isinstance(contexts, list) or not all(isinstance(name, str) for name in contexts):
        raise TypeError("context is not a list of texts")
    for name in contexts:
        if name not in CONTEXTS:
            raise TypeError(f"unknown context {shown(name)!r}; {_hint(name)}")
    country = properties.get("country") or "" if ros else ""
    if country and country not in countries().areas:
        raise TypeError(f"country {shown(str(country))!r} is not an ISO 3166-1 code")
    grounds = [properties.get(f"gdpr_{ground}") for ground in GROUNDS]
    if not all(ground is None or isinstance(ground, bool) for ground in grounds):
        raise TypeError("gdpr_established or gdpr_targeted is not true or false")
    return Surroundings(tuple(sorted(set(contexts))), country, countries().is_abroad(country), *grounds)


def joined(several: Iterable[Surroundings]) -> Surroundings:
    """Put together what several say of one thing: every context holds; of a country and a ground, what is stated last.

    >>> both = joined([Surroundings(("care",), targeted=False), Surroundings(("school",), "FR")])
    >>> both.contexts, both.country, both.targeted
    (('care', 'school'), 'FR', False)
    """
    contexts: set[str] = set()
    found = Surroundings()
    for one in several:
        contexts.update(one.contexts)
        place = (one if one.country else found)[1:3]
        grounds = (getattr(found if getattr(one, of) is None else one, of) for of in GROUNDS)
        found = Surroundings((), *place, *grounds)
    return found._replace(contexts=tuple(sorted(contexts)))


def everywhere(graph: FlowGraph, own: Mapping[int, Surroundings], system: Surroundings) -> dict[int, Surroundings]:
    """Return the surroundings of each element that can bring data in: its own, with those of its system."""
    found: dict[int, Surroundings] = {}
    for vertex, element in enumerate(graph.elements) if own or system else ():
        if element.is_channel:
            continue
        of_system = system if element.is_node else Surroundings(system.contexts)  # its country is a fact of its own
        both = joined((of_system, own.get(vertex, Surroundings())))
        if both:
            found[vertex] = both
    return found


def flag_of(value: Value) -> bool | None:
    """Return whether a value is true or false; None where it is neither."""
    text = value.text.casefold() if value.kind == "number" else ""
    return True if text in TRUE else False if text in FALSE else None


def written(value: Value) -> str:
    """Return how a message names a value."""
    return repr(shown(value.text)) if value.text else f"a {value.kind}" if value.kind != "empty" else "nothing"


def _hint(text: str) -> str:
    return did_you_mean(nearest(text.casefold(), CONTEXTS, FEW, A_LITTLE), f"one of {', '.join(CONTEXTS)}")


def read_type_names(reader: FileReader, value: Value) -> tuple[MessageType, ...]:
    """Return the types that an entry states for channels; what is none is a problem."""
    if not value.items and value.kind in ("list", "empty"):
        reader.problem(value.line, "types names no type", "name one, such as [std_msgs/msg/Bool], or remove it")
    types = []
    for item in reader.list_of(value, "types", "write [std_msgs/msg/Bool]"):
        if item.kind == "text" and len(item.text) <= LONGEST_TYPE and kind_of_type(item.text):
            types.append(MessageType(item.text, Place(reader.file, item.line), stated=True))
        else:
            what = f"{shown(item.text or item.kind)!r} is not the name of a type"
            reader.problem(item.line, what, "write it in full, such as sensor_msgs/msg/Image")
    return tuple(types)


def check_types(reader: FileReader, types: Iterable[MessageType], kinds: Collection[str]) -> None:
    """Note the types that are for other kinds of channels than those of their section."""
    for one in types:
        if (kind := kind_of_type(one.name)) not in kinds:
            other = " or ".join(kinds)
            hint = f"move it, or name the type of a {other}"
            reader.problem(one.place.line, f"{one.name} is the type of a {kind}", hint)


def stated_at(graph: FlowGraph, entry: Entry, vertices: Iterable[int]) -> Iterator[tuple[int, MessageType]]:
    """Yield (vertex, type) for the elements that an entry covers: a type goes to its own kind of channel."""
    for vertex in vertices:
        for one in entry.types:
            if graph.elements[vertex].kind == kind_of_type(one.name):
                yield vertex, one


def of_no_channel(graph: FlowGraph, entry: Entry, vertices: Collection[int]) -> Iterator[InputError]:
    """Yield a problem for each type of an entry that is for none of the channels that it covers."""
    kinds = sorted({graph.elements[vertex].kind for vertex in vertices})
    for one in entry.types:
        if kinds and kind_of_type(one.name) not in kinds:
            what = f"{one.name} is the type of a {kind_of_type(one.name)}, and {shown(entry.name)!r} is a {kinds[0]}"
            hint = f"name the type of a {kinds[0]}: pkg/{OF_KIND[kinds[0]]}/Name"
            yield LabelError(one.place.file, one.place.line, what, hint)


def in_order(types: Mapping[int, Iterable[MessageType]]) -> dict[int, tuple[MessageType, ...]]:
    """Return the types of each element once and sorted (rule S14)."""
    order = attrgetter(
        "name",
        "hash",
        "robot",
        "place.file",
        "place.line",
        "writers",
        "readers",
        "first",
        "last",
        "definition",
        "fields",
    )
    return {vertex: tuple(sorted(set(some), key=order)) for vertex, some in sorted(types.items()) if some}
