"""What stands behind the keywords of label files -> statements and facts, with every problem (rules S7, S8, S9).

In: a value with its line. Out: what data does there, from a statement without categories; or facts that move no data,
by the field of ``Entry``, ``Processing``, ``NonRosFacts`` or ``Stated`` that takes them. Which keyword is read by which
of these stands in ``keywords.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.durations import ordered
from rosprivacy.analysis.durations import parse as parse_duration
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import BY_TYPE, CLEANS, NO_BASIS, TYPE_LINE, Method
from rosprivacy.analysis.non_ros import EVERY, RECIPIENTS, TRANSFERS
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.labels.entries import is_non_ros
from rosprivacy.ingest.labels.stated_facts import (
    flag_of,
    read_context_names,
    read_country_code,
    read_type_names,
    written,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.durations import Duration
    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.yaml_values import Value

    Item = tuple[str, int, Value]  # of a map: key, its line, value

LONGEST_GROUP = 100  # characters of a group of persons, or of the name of an author


def read_each_kind(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Say it of each kind of data by itself: ``leak`` and ``conduit``."""
    for name in reader.categories_of(value, blank.role):
        yield blank._replace(categories=(name,))


def read_all_kinds(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Say it of all of these kinds at once: ``sensitive`` and ``never``."""
    names = tuple(reader.categories_of(value, blank.role))
    if names:
        yield blank._replace(categories=names)


def read_only(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Read the kinds that a channel or a flow carries at most, or that its type says what these are."""
    if value.kind == "text" and value.text == BY_TYPE:
        yield blank._replace(role=TYPE_LINE)
    else:
        yield from read_all_kinds(reader, value, blank)


def read_source(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Read kinds of data, or a map from them to the channels that they go out through."""
    if value.kind != "map":
        yield from read_each_kind(reader, value, blank)
        return
    reader.not_empty(value, "source")
    for kind, line, channels in value.entries:
        name = reader.kind_of_data(kind, line)
        through = {reader.absolute_name(item) for item in reader.list_of(channels, f"source of {shown(kind)}")}
        if not through:
            reader.problem(line, f"source of {shown(kind)} names no channel", "name them: [/topic]")
        yield blank._replace(categories=(name,), through=tuple(sorted(through)))


def read_sanitizer(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Read kinds of data, or a map from them to methods (rule S8)."""
    unstated = blank._replace(method=Method.PSEUDONYMISE, stated=False)
    if value.kind != "map":
        yield from read_each_kind(reader, value, unstated)
        return
    reader.not_empty(value, "sanitizer")
    for kind, line, method in value.entries:
        name = reader.kind_of_data(kind, line)
        if method.kind == "empty":
            yield unstated._replace(categories=(name,))
        elif method.kind == "text" and method.text in CLEANS:
            yield blank._replace(categories=(name,), method=Method(method.text))
        else:
            what = f"sanitizer method {shown(method.text or method.kind)!r}"
            reader.problem(method.line, what, f"one of {', '.join(CLEANS)}")


def read_derives(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Read a list of derivations, each of one kind from another."""
    hint = "write {from: Video, to: FaceTemplate}"
    if value.kind == "empty":
        reader.problem(value.line, "derives takes a list, not nothing", "write [{from: Video, to: FaceTemplate}]")
    for item in reader.list_of(value, "derives"):
        if item.kind != "map":
            reader.problem(item.line, f"a derivation is a map, not a {item.kind}", hint)
            continue
        ends = {key: reader.category_of(end) for key, _, end in reader.entries_of(item, ("from", "to"))}
        if len(ends) < len(("from", "to")):
            reader.problem(item.line, "a derivation needs from and to", hint)
        elif all(ends.values()):
            yield blank._replace(role="derivation", categories=(ends["from"],), to=ends["to"])


def read_absent(reader: NameReader, value: Value, blank: Statement) -> Iterator[Statement]:
    """Read why a node that has a profile is not on the robot: nothing gets there, and nothing comes from it."""
    if value.kind != "text" or not value.text.strip():
        hint = "write why it is not there: {absent: a test tool}"
        reader.problem(blank.place.line, "absent without a reason", hint)
    else:
        yield blank._replace(role="sanitizer", method=Method.ABSENT, why=value.text.strip())


def read_subjects(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read the groups of persons that the data of a source are about, as a person calls them."""
    _, _, value = item
    if not value.items:
        reader.problem(value.line, "subjects names nobody", "write [residents, staff], or remove it")
    for group in value.items:
        if group.kind != "text" or not group.text.strip() or len(group.text) > LONGEST_GROUP:
            what = f"{shown(group.text) or f'a {group.kind}'!r} where a group of persons is named"
            reader.problem(group.line, what, f"write a word or two, at most {LONGEST_GROUP} characters")
    return {"subjects": tuple(sorted({group.text.strip() for group in value.items}))}


def read_contexts(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read where a source works."""
    return {"contexts": read_context_names(reader, item[2])}


def read_types(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read the message types of a channel."""
    return {"types": read_type_names(reader, item[2])}


def read_country(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read where an element outside ROS is."""
    code = read_country_code(reader, item[2])
    return countries().place(code) if code else {}


def read_text(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read a text, of ``recipient`` and ``transfer`` one of a list."""
    key, _, value = item
    allowed = {"recipient": RECIPIENTS, "transfer": (*TRANSFERS, NO_BASIS)}.get(key)
    usable = value.kind == "text" and value.text.strip() and value.text.isprintable()
    if usable and (not allowed or value.text in allowed):
        return {key: value.text}
    reader.problem(
        value.line, f"{key}: {written(value)}", f"one of {', '.join(allowed)}" if allowed else "write its name"
    )
    return {}


def read_retention(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read how long data is kept: all, or each kind."""
    _, line, value = item
    pairs = value.entries if value.kind == "map" else ((EVERY, line, value),)
    if not pairs:
        reader.problem(line, "retention names no category", "write {Video: P30D}, or P30D for every one")
    limits = []
    for kind, at, duration in pairs:
        category = reader.kind_of_data(kind, at) if kind else EVERY
        limit = read_duration(reader, at, duration)
        if limit and (category or not kind):
            limits.append((category, limit))
    return {"retention": ordered(limits)}


def read_backups(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read how much longer backups keep data; true where nobody knows."""
    _, line, value = item
    flag = flag_of(value)
    return {"backups": read_duration(reader, line, value, ", or true or false") if flag is None else flag}


def read_encrypted(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read whether data is encrypted at rest."""
    _, line, value = item
    if flag_of(value) is None:
        reader.problem(line, f"encrypted: {written(value)}", "write true or false")
    return {"encrypted": flag_of(value)}


def read_bag(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read the bags that a storage is."""
    bags = reader.bags_at(item[2])
    if not bags:
        return {}
    from rosprivacy.analysis.model.recording import recording_of  # noqa: PLC0415 - light start

    return {"bags": bags, "recording": recording_of(item[2].text, bags)}


def read_between(reader: NameReader, item: Item) -> Mapping[str, Any]:
    """Read the nodes or channels that a carrier joins."""
    _, line, value = item
    ends = tuple(reader.end(end) for end in value.items)
    if len(ends) < len(("one", "another")) or any(end.name and is_non_ros(end.name) for end in ends):
        reader.problem(line, "between names at least two nodes", "write [/one, /another]")
        return {}
    return {"between": ends}


def read_duration(reader: NameReader, line: int, value: Value, example: str = "") -> Duration | None:
    """Return a duration of ISO 8601; None, and a problem, if it is none."""
    try:
        return parse_duration(value.text)
    except ValueError as error:
        hint = f"write a duration of ISO 8601, such as P30D or P6M{example}"
        reader.problem(value.line if value.text else line, f"{written(value)} is {error}", hint)
        return None
